// An external program that gets text on standard input and answers on standard output. Whatever it does
// (crash, hang, flood), the caller gets a reason within the time limit, and no process that it started is
// left.
#pragma once

#include <cstddef>
#include <string>

namespace understudy::calibration {

struct ProcessLimits {
  double time = 10;                      ///< [s], from start to end of the program
  std::size_t output = 1024 * 1024;      ///< [bytes] of standard output
  std::size_t error_output = 64 * 1024;  ///< [bytes] of standard error
};

struct ProcessRun {
  bool ok = false;      ///< ended by itself with status 0 within its limits
  std::string failure;  ///< one line that says why not; empty when ok
  std::string output;   ///< standard output
  std::string error_output;
  double seconds = 0;  ///< wall time
};

/// Runs `command` by /bin/sh in a box (box.h). All that it started is killed when it ends, whatever session
/// or group that began, and when we die. Only throws Interrupted, when the user asked for it, and
/// MachineError, when no process can be started.
ProcessRun run_process(const std::string& command, const std::string& input,
                       const ProcessLimits& limits = {});

/// The first line of `text` that says something, printable and cut to `length` characters.
std::string brief(const std::string& text, std::size_t length = 120);

}  // namespace understudy::calibration
