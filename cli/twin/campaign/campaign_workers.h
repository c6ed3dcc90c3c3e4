// Processes of this program that rehearse the runs of a campaign on this machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/twin/campaign/campaign_folder.h"
#include "core/progress.h"
#include "studies/campaign/run_inputs.h"

namespace understudy::cli {

/// Rehearses `runs`, each once, and leaves their rows in parts of the folder. A worker that is killed is
/// replaced, and its run done again. A run of which a worker dies by itself (a segmentation fault) twice is
/// kept as crashed. Throws MachineError where a run was killed too often, or where a worker ends with an
/// error, which it has told on standard error; Interrupted.
class LocalWorkers {
 public:
  LocalWorkers(std::vector<std::string> words, CampaignFolder& folder, int count)
      : words_(std::move(words)), folder_(folder), count_(count) {}

  void run(const std::vector<std::uint64_t>& runs, const studies::RunPlan& plan,
           const studies::RunInputs& inputs, const Progress& progress);

 private:
  std::vector<std::string> words_;  ///< of a worker, but for the name of its part
  CampaignFolder& folder_;
  int count_;
};

/// What such a process does: a line with a number on standard input is a run, "done NUMBER" on standard
/// output its answer, once its row is on the disk.
int run_campaign_worker(const CampaignFolder& folder, const std::string& part, const studies::RunPlan& plan,
                        studies::RunInputs& inputs);

}  // namespace understudy::cli
