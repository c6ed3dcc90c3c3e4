// What is looked at before a machine moves: whether it is the one described, stands where the program begins,
// and answers.
#pragma once

#include <string>
#include <vector>

#include "control/print.h"

namespace understudy::control {

struct PreflightCheck {
  std::string name;  ///< axes, fault, position, limits, camera, outputs
  bool good = false;
  std::string text;  ///< one line: what was found, and what to do where it is not good
};

/// Drives that read more than this beside home are not homed, or were moved. [m] or [rad]
constexpr double kHomeTolerance = 0.2e-3;

/// All of them, whatever the first ones say. Nothing moves; outputs are switched off. `at_home`: the machine
/// is to stand there; else, anywhere within its limits.
std::vector<PreflightCheck> preflight(const toolpath::Program& program,
                                      const machine::MachineDescription& machine, machine::MachinePort& port,
                                      GapControl gap_control, bool at_home = true);

}  // namespace understudy::control
