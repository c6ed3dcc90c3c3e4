// How laser and microscope of a built machine really sit, which its controller does not know.
#pragma once

#include <cstdint>

#include "machine/description.h"

namespace understudy::sim {

/// Error of the drawing, drawn from the machine's tolerances of mounting; 0 where it states none. Equal seeds
/// give equal errors, whatever a calibration of the machine has found.
machine::MountingVector draw_mounting(const machine::MachineDescription& machine, std::uint64_t seed);

}  // namespace understudy::sim
