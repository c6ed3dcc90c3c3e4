#include "sim/plant/joint_constants.h"

#include <fmt/format.h>

#include <numbers>

#include "core/error.h"

namespace understudy::sim {

void check_timestep(const machine::MachineDescription& machine, double timestep) {
  if (!(timestep > 0 && std::isfinite(timestep)))
    throw InputError(fmt::format("timestep is {} s, not above 0", timestep));
  for (const machine::Drive& drive : machine.drives) {
    const double longest = 1 / (2 * std::numbers::pi * drive.resonance);
    if (drive.stiffness > 0 && timestep > longest)
      throw InputError(
          fmt::format("timestep is {} ms, too long for a drive that swings at {} Hz: at most {:.3f} ms",
                      1e3 * timestep, drive.resonance, 1e3 * longest));
  }
}

}  // namespace understudy::sim
