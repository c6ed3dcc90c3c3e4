#include "kinematics/mechanism.h"

#include <gtest/gtest.h>

#include "tests/kinematics/hexapod/g4.h"

namespace understudy::kinematics {
namespace {

TEST(Mechanism, ViolationsSpeakTheUnitsOfReports) {
  EXPECT_EQ(to_string(LimitViolation{LimitKind::strut_length, "strut 3", 0.2417, 0.240, "m"}),
            "strut 3 is 241.7 mm, longer than 240.0 mm");
  EXPECT_EQ(to_string(LimitViolation{LimitKind::strut_length, "strut 1", 0.1691, 0.170, "m"}),
            "strut 1 is 169.1 mm, shorter than 170.0 mm");
  EXPECT_EQ(to_string(LimitViolation{LimitKind::joint_angle, "ball joint 2", from_deg(121.25), from_deg(120),
                                     "rad"}),
            "ball joint 2 is at 121.2 deg, above 120.0 deg");
  EXPECT_EQ(to_string(LimitViolation{LimitKind::axis_velocity, "strut 6", 0.0155, 0.010, "m/s"}),
            "strut 6 moves at 15.5 mm/s, faster than 10.0 mm/s");
  EXPECT_EQ(to_string(LimitViolation{LimitKind::unreachable, "strut 2", 0.012, 0.015, "m"}),
            "strut 2 spans 12.0 mm, less than 15.0 mm");
}

TEST(Mechanism, ViolationByAHairShowsTheDigitsThatDiffer) {
  EXPECT_EQ(to_string(LimitViolation{LimitKind::strut_length, "strut 4", 0.2400004, 0.240, "m"}),
            "strut 4 is 240.0004 mm, longer than 240.0000 mm");
}

TEST(Mechanism, HexapodBehindTheInterfaceIsTheSameHexapod) {
  const HexapodGeometry g = nominal_g4(0.015);
  const Pose X_home = make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, -0.01));
  const auto mechanism = make_hexapod(g, joints_at_home(g, X_home), limits_g4(), X_home);
  ASSERT_EQ(mechanism->axis_count(), 6);
  EXPECT_EQ(mechanism->axis_name(0), "l1");
  EXPECT_EQ(mechanism->axis_name(5), "l6");
  EXPECT_FALSE(mechanism->axis_is_angle(2));
  EXPECT_TRUE(mechanism->home().isApprox(X_home));

  const Pose X = tilted({0.01, -0.02, 0.005}, from_deg(12), 0.7);
  AxisVector axes{};
  ASSERT_EQ(mechanism->inverse(X, {}, axes), SolveStatus::ok);
  StrutLengths lengths{};
  ASSERT_EQ(inverse(g, X, lengths), SolveStatus::ok);
  for (std::size_t i = 0; i < kStruts; ++i) EXPECT_EQ(axes[i], lengths[i]);
  EXPECT_EQ(axes[6], 0);

  Pose X_found = Pose::Identity();
  ASSERT_EQ(mechanism->forward(axes, X_home, X_found), SolveStatus::ok);
  EXPECT_LE((X_found.translation() - X.translation()).norm(), 1e-10);

  Eigen::Matrix<double, Eigen::Dynamic, 6> rates(6, 6);
  Mat6 J;
  ASSERT_EQ(mechanism->axis_rates(X, axes, rates), SolveStatus::ok);
  ASSERT_EQ(jacobian(g, X, J), SolveStatus::ok);
  EXPECT_EQ(Mat6(rates), J);
  EXPECT_EQ(mechanism->condition_number(X, axes), condition_number(g, X));
}

TEST(Mechanism, TooFewAxesAreBadInput) {
  const HexapodGeometry g = nominal_g4();
  const auto mechanism = make_hexapod(g, joints_at_home(g, Pose::Identity()), limits_g4(), Pose::Identity());
  std::array<double, 5> axes{};
  Pose X = Pose::Identity();
  Eigen::Matrix<double, Eigen::Dynamic, 6> rates(5, 6);
  EXPECT_EQ(mechanism->inverse(X, {}, axes), SolveStatus::bad_input);
  EXPECT_EQ(mechanism->forward(axes, X, X), SolveStatus::bad_input);
  EXPECT_EQ(mechanism->axis_rates(X, axes, rates), SolveStatus::bad_input);
}

}  // namespace
}  // namespace understudy::kinematics
