#include "core/frames.h"

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "core/units.h"

namespace understudy {
namespace {

Vec3 random_vector(Random& random) { return normal_vec3(random); }

TEST(Frames, LogInvertsExpUpToHalfATurn) {
  Random random(1, "log-exp");
  for (int i = 0; i < 10000; ++i) {
    const Vec3 w = random_vector(random).normalized() * random.uniform(0, 3.1);
    // Half a turn loses digits: the rotation's derivative by the angle's sine vanishes there.
    EXPECT_LT((log_rotation(exp_rotation(w)) - w).norm(), 1e-9) << w.transpose();
  }
}

TEST(Frames, TinyRotationsKeepTheirDigits) {
  const Vec3 w(1e-9, -2e-9, 3e-9);
  EXPECT_LT((log_rotation(exp_rotation(w)) - w).norm(), 1e-24);
}

TEST(Frames, ShortestArcTurnsZOntoTheAxisWithoutSpin) {
  Random random(2, "arc");
  for (int i = 0; i < 10000; ++i) {
    const Vec3 axis = random_vector(random).normalized();
    const Quat q = shortest_arc_from_z(axis);
    EXPECT_LT((q * Vec3::UnitZ() - axis).norm(), 1e-13);  // near -z, 1 + z loses two digits
    EXPECT_NEAR(q.vec().dot(Vec3::UnitZ()), 0, 1e-14);
  }
  EXPECT_LT((shortest_arc_from_z(-Vec3::UnitZ()) * Vec3::UnitZ() + Vec3::UnitZ()).norm(), 1e-14);
}

TEST(Frames, InterpolationRunsAtConstantTurnRate) {
  const Pose a = make_pose(exp_rotation(Vec3(0.1, 0.2, -0.3)), Vec3(1, 2, 3));
  const Pose b = make_pose(exp_rotation(Vec3(-0.4, 0.5, 1.0)), Vec3(-1, 0, 5));
  const double whole = angle_between(a.linear(), b.linear());
  for (const double t : {0.0, 0.25, 0.5, 1.0}) {
    const Pose m = interpolate(a, b, t);
    EXPECT_NEAR(angle_between(a.linear(), m.linear()), t * whole, 1e-14);
    EXPECT_LT((m.translation() - (a.translation() + t * (b.translation() - a.translation()))).norm(), 1e-15);
  }
  EXPECT_LT(angle_between(interpolate(a, b, 1).linear(), b.linear()), 1e-14);
}

// Song 2015, eq 2: the scalar-first quaternion and its rotation matrix.
TEST(Frames, QuaternionIsScalarFirstAsInThePaper) {
  const double half = 0.5 * from_deg(30);
  const Pose X = make_pose(Quat(std::cos(half), 0, 0, std::sin(half)), Vec3::Zero());
  EXPECT_NEAR(X.linear()(0, 0), std::cos(from_deg(30)), 1e-15);
  EXPECT_NEAR(X.linear()(0, 1), -0.5, 1e-15);
  EXPECT_NEAR(X.linear()(1, 0), 0.5, 1e-15);
}

}  // namespace
}  // namespace understudy
