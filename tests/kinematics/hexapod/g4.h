// Machine G4 (docs/reference.md#machine-g4), for tests of the kinematics alone: B and T coincide with the
// cube's axes, the origin of B is the cube's centre, home is the tip there with the tool upright.
#pragma once

#include <cmath>

#include "core/units.h"
#include "kinematics/hexapod/hexapod.h"

namespace understudy::kinematics {

inline HexapodGeometry nominal_g4(double deviation = 0) {
  HexapodGeometry g;
  for (int k = 0; k < 3; ++k) {
    for (int s = -1; s <= 1; s += 2) {
      const std::size_t i = 2 * static_cast<std::size_t>(k) + (s > 0 ? 1 : 0);
      const double base = from_deg(120.0 * k + 43.0 * s), platform = from_deg(120.0 * k + 17.0 * s);
      g.base_joint[i] = {0.080 * std::cos(base), 0.080 * std::sin(base), 0.206};
      g.platform_joint[i] = {0.029 * std::cos(platform), 0.029 * std::sin(platform), 0.025};
    }
  }
  g.deviation = deviation;
  return g;
}

inline HexapodLimits limits_g4() {
  HexapodLimits l;
  l.strut_min = 0.170, l.strut_max = 0.240;
  l.base_alpha_min = from_deg(-30), l.base_alpha_max = from_deg(45), l.base_beta_max = from_deg(45);
  l.ball_min = from_deg(60), l.ball_max = from_deg(120);
  l.screw_distance_min = 0, l.condition_max = kSingularCondition;
  return l;
}

inline Pose tilted(const Vec3& p, double tilt, double azimuth) {
  return make_pose(exp_rotation(tilt * Vec3(std::cos(azimuth), std::sin(azimuth), 0)), p);
}

inline bool within_limits(const HexapodGeometry& g, const HexapodJoints& j, const HexapodLimits& l,
                          const Pose& X) {
  std::vector<LimitViolation> violations;
  check(g, j, l, X, violations);
  return violations.empty();
}

}  // namespace understudy::kinematics
