// A printer whose filament has a section of 1 mm2: E is the volume in mm3.
#pragma once

#include <cmath>
#include <numbers>

#include "machine/description.h"

namespace understudy::rehearsal {

inline machine::MachineDescription printer() {
  machine::MachineDescription machine;
  machine.tool.filament_diameter = std::sqrt(4 / std::numbers::pi) * 1e-3;
  machine.tool.flat_diameter = 1e-3;
  machine.tool.nozzle_diameter = 0.4e-3;
  machine.gap = {0.1e-3, 0.2e-3, 0.13e-3, 2e-3};
  return machine;
}

}  // namespace understudy::rehearsal
