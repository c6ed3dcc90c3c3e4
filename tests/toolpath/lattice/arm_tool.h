// The arm's tool and plan, and a look into the tool that knows nothing of the planner, for lattice tests.
#pragma once

#include <algorithm>
#include <vector>

#include "core/frames.h"
#include "core/units.h"
#include "geometry/shape.h"
#include "toolpath/lattice/lattice_planner.h"

namespace understudy::toolpath::test {

constexpr double kDiameter = 0.48e-3;  // of a strut [m]

/// Nozzle, heater block, extruder.
inline std::vector<geometry::Shape> tool_bodies() {
  const auto above = [](double z) { return make_pose(Quat::Identity(), Vec3(0, 0, z)); };
  return {{"nozzle", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()},
          {"heater block", geometry::Box{Vec3(16e-3, 16e-3, 10e-3)}, above(17e-3)},
          {"extruder", geometry::Box{Vec3(44e-3, 44e-3, 70e-3)}, above(59e-3)}};
}

inline LatticePlan plan(double tilt_max) {
  LatticePlan p;
  p.limits.tool = tool_bodies();
  p.limits.strut_diameter = kDiameter;
  p.limits.nozzle_flat = 1e-3;
  p.limits.ground_gap = 0.13e-3;
  p.limits.margin = 0.1e-3;
  p.limits.joint = 0.5e-3 + kDiameter + 0.1e-3;
  p.limits.lift = 2e-3;
  p.limits.tilt_max = tilt_max;
  p.feed = 1e-3;
  p.approach_feed = 5e-3;
  p.approach = 2e-3;
  p.dwell = 3;
  p.filament_diameter = 1.75e-3;
  p.temperature = 483.15;
  p.fan = 1;
  return p;
}

/// How deep a point in the tool frame lies in the tool's bodies grown by `around` [m], negative outside:
/// cylinders and a cone about the tool's axis, the boxes turned any way about it.
inline double depth_in_tool(const Vec3& p_T, double around) {
  const double rho = p_T.head<2>().norm(), z = p_T.z();
  double deepest = -1;
  if (z >= -around && z <= 12e-3 + around)
    deepest = std::max(deepest, 0.5e-3 + 3e-3 * std::clamp(z / 12e-3, 0.0, 1.0) + around - rho);
  if (z >= 12e-3 - around && z <= 22e-3 + around) deepest = std::max(deepest, 8e-3 + around - rho);
  if (z >= 24e-3 - around && z <= 94e-3 + around) deepest = std::max(deepest, 22e-3 + around - rho);
  return deepest;
}

}  // namespace understudy::toolpath::test
