#include <gtest/gtest.h>

#include <algorithm>

#include "core/random_vector.h"
#include "kinematics/hexapod/hexapod.h"
#include "tests/kinematics/hexapod/g4.h"

namespace understudy::kinematics {
namespace {

std::vector<LimitViolation> violations_at(const Pose& X, const HexapodLimits& limits) {
  const HexapodGeometry g = nominal_g4();
  std::vector<LimitViolation> violations;
  check(g, joints_at_home(g, Pose::Identity()), limits, X, violations);
  return violations;
}

// docs/reference.md#machine-g4, table: .55 .51 .32 .10. Cells of 2.5 mm: the reference's two digits and the
// grid's own error (0.002 between cells of 5 and 1.25 mm) make 0.007.
TEST(HexapodLimits, ReachableFractionOfTheCubeIsThatOfTheReference) {
  const HexapodGeometry g = nominal_g4();
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  const std::array<std::pair<double, double>, 4> expected{{{0, .55}, {10, .51}, {20, .32}, {30, .10}}};
  constexpr int kCells = 40;
  for (const auto& [tilt, fraction] : expected) {
    int inside = 0;
    for (int n = 0; n < kCells * kCells * kCells; ++n) {
      const int column = n % kCells, row = n / kCells % kCells, layer = n / kCells / kCells;
      const Vec3 cell(column, row, layer);
      const Vec3 p = ((cell.array() + 0.5) * 0.1 / kCells - 0.05).matrix();
      inside += within_limits(g, joints, limits_g4(), tilted(p, from_deg(tilt), 0));
    }
    EXPECT_NEAR(inside / double(kCells * kCells * kCells), fraction, 0.007) << "tilt " << tilt;
  }
}

// docs/reference.md#machine-g4 says 27 deg. That holds to its rounding towards the struts' planes of symmetry
// (26.5 to 29.1); an independent computation in between finds 25.7 deg at the least (azimuth 15 deg).
TEST(HexapodLimits, HomeTiltsInEveryAzimuth) {
  const HexapodGeometry g = nominal_g4();
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  const auto tilt_reached = [&](int azimuth) {
    double tilt = 0;
    while (within_limits(g, joints, limits_g4(), tilted(Vec3::Zero(), from_deg(tilt), from_deg(azimuth))))
      tilt += 0.02;
    return tilt;
  };
  for (const int azimuth : {0, 60, 120, 180, 240, 300})
    EXPECT_NEAR(tilt_reached(azimuth), 26.79, 0.03) << azimuth;
  double least = 90;
  for (int azimuth = 0; azimuth < 360; azimuth += 5) least = std::min(least, tilt_reached(azimuth));
  EXPECT_NEAR(least, 25.72, 0.03);
}

TEST(HexapodLimits, HomeBreaksNothingAndItsStudsArePerpendicular) {
  const HexapodGeometry g = nominal_g4();
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  EXPECT_TRUE(violations_at(Pose::Identity(), limits_g4()).empty());
  for (int i = 0; i < kStruts; ++i) {
    const StrutAngles angles = strut_angles(g, joints, Pose::Identity(), i);
    EXPECT_NEAR(angles.ball, from_deg(90), 1e-12);
    // Seen from above, the strut runs from the base joint (80, 0) to the ball joint at 26 deg on 29 mm.
    const double inward = 80 - 29 * std::cos(from_deg(26)), sideways = 29 * std::sin(from_deg(26));
    EXPECT_NEAR(angles.alpha, std::atan2(inward, 181), 1e-12);
    EXPECT_NEAR(std::abs(angles.beta), std::asin(sideways / 189.292355), 1e-8);  // length to 1e-6 mm
    EXPECT_EQ(angles.beta > 0, i % 2 == 0);  // towards the pair's middle, against and along e_t in turn
  }
}

// A strut that points straight outwards and level has alpha = -90 deg; straight down 0.
TEST(HexapodLimits, AlphaIsPositiveInward) {
  HexapodGeometry g = nominal_g4();
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  const auto alpha_for = [&](const Vec3& from_base_to_ball) {
    g.platform_joint[0] = g.base_joint[0] + from_base_to_ball;
    return strut_angles(g, joints, Pose::Identity(), 0).alpha;
  };
  const Vec3 e_r = joints.radial_axis[0];
  EXPECT_NEAR(alpha_for(Vec3(0, 0, -0.2)), 0, 1e-12);
  EXPECT_NEAR(alpha_for(0.2 * e_r), from_deg(-90), 1e-12);
  EXPECT_NEAR(alpha_for(-0.1 * e_r - Vec3(0, 0, 0.1)), from_deg(45), 1e-12);
}

TEST(HexapodLimits, JointsKeepTheDistancesOfTheReference) {
  const HexapodGeometry g = nominal_g4();
  const HexapodJoints joints = joints_at_home(g, Pose::Identity());
  double base = 1, struts = 1;
  Random random(21, "distances");
  for (int i = 0; i < kStruts; ++i) {
    for (int j = 0; j < i; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      base = std::min(base, (g.base_joint[a] - g.base_joint[b]).norm());
    }
  }
  for (int n = 0; n < 10'000; ++n) {
    const Vec3 p = uniform_vec3(random, 0.05);
    const Pose X = tilted(p, random.uniform(0, from_deg(25)), random.uniform(0, 2 * std::numbers::pi));
    if (!within_limits(g, joints, limits_g4(), X)) continue;
    for (int i = 0; i < kStruts; ++i)
      for (int j = 0; j < i; ++j) struts = std::min(struts, screw_distance(g, X, i, j));
  }
  EXPECT_GE(base, 0.045);
  EXPECT_NEAR(base, 2 * 0.080 * std::sin(from_deg(17)), 1e-12);  // chord over 34 degrees
  EXPECT_GE(struts, 0.0160);  // docs/reference.md#machine-g4: 16 mm at the closest
  EXPECT_LE(struts, 2 * 0.029 * std::sin(from_deg(17)));  // the ball joints of a pair
}

// Slow and obvious: the least over a fine lattice of points of both segments, which is never below the true
// distance and at most half a lattice step's diagonal above it.
TEST(HexapodLimits, ScrewDistanceIsTheLeastOverAllPairsOfPoints) {
  Random random(22, "segments");
  constexpr int kPoints = 200;
  for (int n = 0; n < 60; ++n) {
    HexapodGeometry g = nominal_g4();
    for (const std::size_t i : {0u, 1u}) {
      g.base_joint[i] = uniform_vec3(random, 1);
      g.platform_joint[i] = uniform_vec3(random, 1);
    }
    const auto point = [&](std::size_t i, int k) -> Vec3 {
      return g.base_joint[i] + k / double(kPoints) * (g.platform_joint[i] - g.base_joint[i]);
    };
    double least = 10, step = 0;
    for (int s = 0; s <= kPoints; ++s)
      for (int t = 0; t <= kPoints; ++t) least = std::min(least, (point(0, s) - point(1, t)).norm());
    for (const std::size_t i : {0u, 1u}) step += (point(i, 1) - point(i, 0)).norm();
    const double distance = screw_distance(g, Pose::Identity(), 0, 1);
    EXPECT_LE(distance, least + 1e-12);
    EXPECT_GE(distance, least - step / 2) << "segments " << n;
  }
}

TEST(HexapodLimits, EachLimitIsReportedWithItsPartValueAndLimit) {
  const auto high = violations_at(make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, -0.06)), limits_g4());
  ASSERT_EQ(high.size(), 6u);
  EXPECT_EQ(high[2].part, "strut 3");
  EXPECT_EQ(high[2].kind, LimitKind::strut_length);
  EXPECT_NEAR(high[2].value, 1e-3 * std::hypot(241, 55.41), 3e-6);  // the run is given to 0.01 mm
  EXPECT_DOUBLE_EQ(high[2].limit, 0.240);
  EXPECT_EQ(to_string(high[2]), "strut 3 is 247.3 mm, longer than 240.0 mm");

  HexapodLimits close = limits_g4();
  close.screw_distance_min = 0.020;
  const auto near = violations_at(Pose::Identity(), close);
  ASSERT_EQ(near.size(), 3u);
  EXPECT_EQ(near[0].kind, LimitKind::screw_distance);
  EXPECT_EQ(near[0].part, "struts 1 and 2");
  EXPECT_NEAR(near[0].value, 0.01696, 1e-5);
  EXPECT_EQ(to_string(near[0]), "struts 1 and 2 are 17.0 mm apart, nearer than 20.0 mm");

  HexapodLimits stiff = limits_g4();
  stiff.condition_max = 5;
  const auto badly_conditioned = violations_at(Pose::Identity(), stiff);
  ASSERT_EQ(badly_conditioned.size(), 1u);
  EXPECT_EQ(to_string(badly_conditioned[0]), "platform has condition number 6.1, above 5.0");

  const auto joints = violations_at(tilted(Vec3::Zero(), from_deg(26), from_deg(20)), limits_g4());
  ASSERT_EQ(joints.size(), 1u);
  EXPECT_EQ(joints[0].kind, LimitKind::joint_angle);
  EXPECT_EQ(joints[0].part, "ball joint 3");
  EXPECT_LT(joints[0].value, joints[0].limit);
  EXPECT_NEAR(joints[0].limit, from_deg(60), 1e-12);

  Pose X = Pose::Identity();
  X.translation().z() = std::numeric_limits<double>::quiet_NaN();
  const auto not_finite = violations_at(X, limits_g4());
  ASSERT_EQ(not_finite.size(), 1u);
  EXPECT_EQ(to_string(not_finite[0]), "a pose that is not finite cannot be reached");
}

}  // namespace
}  // namespace understudy::kinematics
