// From a run of a campaign to the rehearsal that it is.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/file/file_cache.h"
#include "core/file/scratch_folder.h"
#include "regression/scenario.h"
#include "rehearsal/record.h"
#include "rehearsal/request/request.h"
#include "studies/campaign/campaign.h"
#include "studies/campaign/run_plan.h"
#include "studies/campaign/run_row.h"

namespace understudy::studies {

/// What this room cannot do by itself: planning, and telling a record as a file.
struct CampaignTools {
  /// Writes the program of a scenario that has a plan.
  std::function<void(const regression::Scenario&, const std::filesystem::path& output)> plan;
  /// Options of a planner, without dashes: "layer".
  std::function<std::vector<std::string>(const std::string& planner)> planner_options;
  /// Of a plan's words and the files that they name.
  std::function<std::string(const regression::Scenario&)> plan_sha256;
  std::function<std::string(const rehearsal::Record&)> summary_json;
};

/// Holds what runs share: machines, materials, scenarios and parts are read once, and programs are planned
/// once for all runs with the same words.
class RunInputs {
 public:
  /// The campaign must outlive it.
  RunInputs(const Campaign& campaign, CampaignTools tools);

  /// What the run rehearses. Throws InputError for values that do not go together.
  rehearsal::RehearsalRequest request(const CampaignRun& run);
  /// The name of a run's scenario.
  const std::string& scenario_name(std::size_t scenario) const { return names_[scenario]; }

  /// Reads everything that any parameter changes, at its first and its last value. Throws InputError at the
  /// parameter's place in the campaign's file: an unknown key, with the nearest known one; a value beyond its
  /// limits; and for two scenarios of one name.
  void check();

  /// Of the campaign and every file that its runs read.
  std::string inputs_sha256();

  /// Rehearses it. InputError and MachineError are ends of a run; Interrupted passes through.
  RunRow rehearse(const CampaignRun& run);
  /// "understudy campaign FILE --only 17 --out run-17".
  std::string command(std::uint64_t index) const;

 private:
  regression::Scenario scenario_of(const CampaignRun& run) const;
  void change(const CampaignParameter& parameter, const std::string& value,
              regression::Scenario& scenario) const;
  void check_point(const CampaignRun& run, const CampaignParameter& parameter);
  std::filesystem::path planned(const regression::Scenario& scenario);

  const Campaign& campaign_;
  CampaignTools tools_;
  FileCacheScope file_cache_;
  std::vector<std::string> names_;
  std::optional<ScratchFolder> scratch_;                  // from the first plan on
  std::map<std::string, std::filesystem::path> planned_;  // by what it is made from
  bool open_loop_ = false;                                // a figure without gap control is asked for
};

}  // namespace understudy::studies
