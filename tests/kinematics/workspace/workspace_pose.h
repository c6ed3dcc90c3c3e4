// Random poses that machine G4 reaches, and poses near them.
#pragma once

#include <numbers>

#include "core/random_vector.h"
#include "tests/kinematics/hexapod/g4.h"

namespace understudy::kinematics {

inline Vec3 direction(Random& random) { return normal_vec3(random).normalized(); }

/// Of the +-50 mm cube, tilted by up to `tilt_max` about any horizontal axis and turned by up to 15 deg about
/// the tool, breaking no limit of G4.
inline Pose workspace_pose(const HexapodGeometry& g, const HexapodJoints& joints, Random& random,
                           double tilt_max) {
  while (true) {
    const Vec3 p = uniform_vec3(random, 0.05);
    const Pose X_tilted = tilted(p, random.uniform(0, tilt_max), random.uniform(0, 2 * std::numbers::pi));
    const Mat3 turn = exp_rotation({0, 0, random.uniform(from_deg(-15), from_deg(15))});
    const Pose X = make_pose(Mat3(X_tilted.linear() * turn), p);
    if (within_limits(g, joints, limits_g4(), X)) return X;
  }
}

inline Pose nearby(const Pose& X, double distance, double angle, Random& random) {
  return make_pose(Mat3(exp_rotation(angle * direction(random)) * X.linear()),
                   X.translation() + distance * direction(random));
}

}  // namespace understudy::kinematics
