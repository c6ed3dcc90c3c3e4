// The words of `--gap-control` and of scenarios.
#pragma once

#include <string>

#include "control/print.h"

namespace understudy::control {

/// Empty: `start` on a machine that sees, else `off`. Throws InputError for a word that is none, and for
/// control without a microscope.
GapControl gap_control_of(const std::string& word, const machine::MachineDescription& machine);

}  // namespace understudy::control
