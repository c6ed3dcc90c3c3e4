#include "sim/as_built/as_built.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"

namespace understudy::sim {
namespace {

Vec3 normal_vector(Random& random, double sigma) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return sigma * Vec3(x, y, z);
}

void add_errors(const machine::ToleranceSet& tolerance, AsBuilt& built) {
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    Random random(built.seed, fmt::format("as-built/{}/strut {}", built.source, i + 1));
    built.hexapod.base_joint[s] += normal_vector(random, tolerance.joint_position);
    built.hexapod.platform_joint[s] += normal_vector(random, tolerance.joint_position);
    built.hexapod.length_offset[s] += tolerance.length_offset * random.normal();
  }
}

}  // namespace

AsBuilt make_as_built(const machine::MachineDescription& machine, const std::string& set,
                      std::uint64_t seed) {
  AsBuilt built;
  built.source = set;
  built.seed = seed;
  built.hexapod = machine.hexapod;
  built.nut_play.fill(machine.play.screw_nut);
  built.ball_play.fill(machine.play.ball_joint);
  if (set == "sampled") {
    add_errors(machine.tolerances.after_calibration, built);
  } else if (set == "manufactured") {
    add_errors(machine.tolerances.manufactured, built);
  } else if (set != "nominal") {
    throw InputError(fmt::format("as-built \"{}\" is not one of nominal, sampled, manufactured", set));
  }
  return built;
}

}  // namespace understudy::sim
