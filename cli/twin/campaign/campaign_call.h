// What `understudy campaign` is asked for, and what all its processes share.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/output_options.h"
#include "cli/twin/campaign/campaign_folder.h"
#include "studies/campaign/campaign.h"
#include "studies/campaign/run_inputs.h"
#include "studies/campaign/run_plan.h"

namespace understudy::cli {

struct CampaignCall {
  std::string file, folder;
  int workers = 0;
  bool resume = false;
  std::optional<std::uint64_t> only;  ///< one run as a rehearsal
  OutputOptions told;
  // Slurm.
  bool slurm = false, detach = false;
  int tasks = 0;                    ///< of an array; 0: four for each processor
  std::vector<std::string> sbatch;  ///< words for sbatch: "--partition=long"
  // What the program starts itself with.
  std::string worker;                  ///< name of the part that this worker writes
  std::string task, todo;              ///< "3/16", and the file with the runs of all tasks
  std::optional<std::uint64_t> merge;  ///< rounds whose runs are merged
};

/// A campaign that has been read, with what all its processes need.
struct OpenCampaign {
  explicit OpenCampaign(const CampaignCall& call);
  OpenCampaign(const OpenCampaign&) = delete;
  OpenCampaign& operator=(const OpenCampaign&) = delete;

  studies::Campaign campaign;
  studies::RunPlan plan;
  studies::RunInputs inputs;
  CampaignFolder folder;
  studies::RowSource rows;  ///< of the folder
};

/// Writes the tables of so many rounds.
void write_result(const OpenCampaign& open, std::uint64_t rounds);
/// The same, and prints them as `told` asks for.
void tell_result(const OpenCampaign& open, std::uint64_t rounds, const OutputOptions& told);

/// Of one run, rather too much than too little [bytes].
double memory_of_a_run(OpenCampaign& open);

}  // namespace understudy::cli
