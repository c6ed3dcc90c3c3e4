// A campaign's runs as jobs of Slurm: an array of tasks that each hold many runs, and a job that merges what
// they wrote. Slurm queues, places and starts again; here is only what it is told, and what it says.
#pragma once

#include <CLI/App.hpp>

#include "cli/twin/campaign/campaign_call.h"

namespace understudy::cli {

void add_slurm_options(CLI::App& command, CampaignCall& call);

/// Throws InputError where Slurm's programs are missing, MachineError where its controller does not answer.
void check_slurm();

/// Submits what is missing, or finds the jobs of an earlier call in the queue, and watches them to their end.
/// Runs that died with a task are submitted again. With `detach` it returns once the jobs are in the queue.
/// An interrupt cancels them.
int run_on_slurm(const CampaignCall& call, OpenCampaign& open);

/// What a task does: every n-th run of the list that no earlier attempt of the task has written.
int run_slurm_task(const CampaignCall& call, OpenCampaign& open);

/// What the job behind the array does: merges, and writes the tables where that was the last look.
int run_slurm_merge(std::uint64_t rounds, OpenCampaign& open);

}  // namespace understudy::cli
