#include "sim/sensors/built_mounting.h"

#include "core/random.h"
#include "machine/optics_mounting.h"

namespace understudy::sim {

machine::MountingVector draw_mounting(const machine::MachineDescription& machine, std::uint64_t seed) {
  machine::MountingVector error = machine::MountingVector::Zero();
  if (!machine.tolerances.mounting) return error;
  const machine::MountingVector sigmas = machine::mounting_sigmas(*machine.tolerances.mounting);
  Random random(seed, "mounting of laser and microscope");
  for (int i = 0; i < machine::kMountingFreedoms; ++i) error[i] = sigmas[i] * random.normal();
  return error;
}

}  // namespace understudy::sim
