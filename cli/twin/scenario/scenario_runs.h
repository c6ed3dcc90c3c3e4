// `understudy scenario run`: many scenarios, one after the other or in processes of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/options/output_options.h"

namespace understudy::cli {

struct ScenarioRequest {
  std::vector<std::string> paths;
  std::string junit, folder, baseline;
  int threads = 0;
  int processes = 1;
  bool resume = false;
  bool pictures = true;  ///< in the reports below `folder`
  bool update_golden = false;
  OutputOptions output;
};

/// The folder of shipped scenarios, when none is named: here, or beside the models.
std::vector<std::filesystem::path> scenario_files(const std::vector<std::string>& named);

int run_scenarios(const ScenarioRequest& request);

/// What a process of its own does for the one scenario of `request.paths`: writes its outcome to `outcome`,
/// and its report below `request.folder`. It ends with the process that asked for it.
int run_for_outcome(const ScenarioRequest& request, const std::filesystem::path& outcome);

}  // namespace understudy::cli
