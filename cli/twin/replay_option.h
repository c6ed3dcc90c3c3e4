// `understudy rehearse --replay RECORD`: no program, but the commands that a machine got.
#pragma once

#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "cli/twin/rehearse_options.h"

namespace understudy::cli {

struct ReplayOptions {
  std::string record;                ///< empty: a program is rehearsed
  std::vector<double> agree_within;  ///< um and, for turns, arcmin; empty: the machine's play and steps
};

/// `options` must outlive `command`, which has those of a rehearsal already.
void add_replay_options(CLI::App& command, ReplayOptions& options);

/// The exit status. Throws InputError where `command` was given options that a replay has no use for.
int run_replay(const CLI::App& command, const RehearseOptions& rehearsal, const ReplayOptions& options);

}  // namespace understudy::cli
