// An external program that gets text on standard input and answers on standard output. Whatever it does
// (crash, hang, flood), the caller gets a reason within the time limit, and no process that it started is
// left.
#pragma once

#include <string>

#include "calibration/plugin/process_limits.h"
#include "core/progress.h"

namespace understudy::calibration {

struct ProcessRun {
  bool ok = false;      ///< ended by itself with status 0 within its limits
  std::string failure;  ///< one line that says why not; empty when ok
  std::string output;   ///< standard output
  std::string error_output;
  double seconds = 0;  ///< wall time
};

/// Runs `command` by /bin/sh in a box (box.h), in a session of its own, with the environment of
/// plugin_environment.h and no open files but its three streams. All that it started is killed when it ends,
/// whatever session or group that began, and when we die. Only throws Interrupted, when the user asked for
/// it, and MachineError, when no process can be started. `progress` is the share of the time limit.
ProcessRun run_process(const std::string& command, const std::string& input, const ProcessLimits& limits = {},
                       const Progress& progress = {});

}  // namespace understudy::calibration
