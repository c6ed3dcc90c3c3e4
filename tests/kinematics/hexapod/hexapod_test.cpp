#include "kinematics/hexapod/hexapod.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/random_vector.h"
#include "tests/guard/cycle_guard.h"
#include "tests/kinematics/hexapod/g4.h"

namespace understudy::kinematics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
// Lengths of 0.2 m carry rounding of some 1e-17 m per operation.
constexpr double kRounding = 1e-15;

Pose random_pose(Random& random) {
  const Vec3 p(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), random.uniform(-0.02, 0.02));
  const Vec3 turn = uniform_vec3(random, 0.25);
  return make_pose(exp_rotation(turn), p);
}

StrutLengths lengths_at(const HexapodGeometry& g, const Pose& X) {
  StrutLengths lengths{};
  EXPECT_EQ(inverse(g, X, lengths), SolveStatus::ok);
  return lengths;
}

// docs/reference.md#machine-g4: 189.29 mm at home; the square root by hand is sqrt(181^2 + 80^2 + 29^2 - 2 80
// 29 cos 26 deg) mm.
TEST(HexapodKinematics, EveryStrutOfG4IsAsLongAtHomeAsTheLawOfCosinesSays) {
  const double expected =
      1e-3 * std::sqrt(181.0 * 181 + 80 * 80 + 29 * 29 - 2 * 80 * 29 * std::cos(from_deg(26)));
  EXPECT_NEAR(expected, 0.18929, 5e-6);  // the figure's last digit
  for (const double length : lengths_at(nominal_g4(), Pose::Identity()))
    EXPECT_NEAR(length, expected, kRounding);
}

TEST(HexapodKinematics, DeviationShortensEachStrutByPythagoras) {
  Random random(11, "deviation");
  for (int n = 0; n < 1000; ++n) {
    const Pose X = random_pose(random);
    const StrutLengths straight = lengths_at(nominal_g4(0), X), deviated = lengths_at(nominal_g4(0.015), X);
    for (std::size_t i = 0; i < kStruts; ++i)
      EXPECT_NEAR(std::hypot(deviated[i], 0.015), straight[i], kRounding);
  }
}

TEST(HexapodKinematics, PureZMotionMovesAllStrutsAlikeAndByTheClosedForm) {
  const double horizontal2 = 80 * 80 + 29 * 29 - 2 * 80 * 29 * std::cos(from_deg(26));  // [mm^2]
  for (double z = -0.04; z <= 0.02; z += 0.005) {
    const double drop = 181 - 1e3 * z;
    const double expected = 1e-3 * std::sqrt(drop * drop + horizontal2 - 15 * 15);
    for (const double length :
         lengths_at(nominal_g4(0.015), make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, z))))
      EXPECT_NEAR(length, expected, kRounding) << "z " << z;
  }
}

TEST(HexapodKinematics, TurningEverythingBy120DegreesPermutesTheStruts) {
  Random random(12, "symmetry");
  const Mat3 turn = exp_rotation({0, 0, from_deg(120)});
  for (int n = 0; n < 1000; ++n) {
    const Pose X = random_pose(random);
    const Pose X_turned = make_pose(Mat3(turn * X.linear() * turn.transpose()), turn * X.translation());
    const StrutLengths before = lengths_at(nominal_g4(0.015), X),
                       after = lengths_at(nominal_g4(0.015), X_turned);
    for (std::size_t i = 0; i < kStruts; ++i) EXPECT_NEAR(after[(i + 2) % kStruts], before[i], kRounding);
  }
}

TEST(HexapodKinematics, MirroringSwapsTheStrutsOfAPair) {
  Random random(13, "mirror");
  const Mat3 mirror = Vec3(1, -1, 1).asDiagonal();
  const std::array<std::size_t, kStruts> partner{1, 0, 5, 4, 3, 2};
  for (int n = 0; n < 1000; ++n) {
    const Pose X = random_pose(random);
    const Pose X_mirrored = make_pose(Mat3(mirror * X.linear() * mirror), mirror * X.translation());
    const StrutLengths before = lengths_at(nominal_g4(0.015), X),
                       after = lengths_at(nominal_g4(0.015), X_mirrored);
    for (std::size_t i = 0; i < kStruts; ++i) EXPECT_NEAR(after[partner[i]], before[i], kRounding);
  }
}

// Central differences with h = 1e-5: truncation h^2 l''' / 6 with l''' up to 1/(0.17 m)^2 is 6e-10, rounding
// 1e-17 / 1e-5 less than that; 1e-8 leaves room for the angular columns.
TEST(HexapodKinematics, JacobianIsTheDerivativeOfTheLengths) {
  Random random(14, "jacobian");
  const double h = 1e-5;
  for (const double deviation : {0.0, 0.015}) {
    const HexapodGeometry g = nominal_g4(deviation);
    for (int n = 0; n < 300; ++n) {
      const Pose X = random_pose(random);
      Mat6 J;
      ASSERT_EQ(jacobian(g, X, J), SolveStatus::ok);
      for (int column = 0; column < 6; ++column) {
        Twist twist = Twist::Zero();
        twist[column] = h;
        const auto moved = [&](double sign) {
          return lengths_at(g, make_pose(Mat3(exp_rotation(sign * twist.tail<3>()) * X.linear()),
                                         X.translation() + sign * twist.head<3>()));
        };
        const StrutLengths ahead = moved(1), behind = moved(-1);
        for (int i = 0; i < kStruts; ++i) {
          const auto k = static_cast<std::size_t>(i);
          EXPECT_NEAR(J(i, column), (ahead[k] - behind[k]) / (2 * h), 1e-8);
        }
      }
    }
  }
}

// Virtual work: equal forces on a symmetric platform push straight up without a moment.
TEST(HexapodKinematics, EqualStrutForcesAtHomePushAlongZOnly) {
  Mat6 J;
  ASSERT_EQ(jacobian(nominal_g4(), Pose::Identity(), J), SolveStatus::ok);
  const Twist wrench = J.transpose() * Twist::Ones();
  EXPECT_NEAR(wrench[2], -6 * 181.0 / 189.29235,
              1e-6);  // -6 cos of the strut's slope; lengths shrink upwards
  for (const int k : {0, 1, 3, 4, 5}) EXPECT_NEAR(wrench[k], 0, 1e-14);
}

TEST(HexapodKinematics, ConditionNumberAtHomeIsThatOfTheReferenceTable) {
  EXPECT_NEAR(condition_number(nominal_g4(), Pose::Identity()), 6.1,
              0.05);  // docs/reference.md#machine-g4, table: one decimal
}

TEST(HexapodKinematics, BadPosesAreNamedAndLeaveTheResultAlone) {
  StrutLengths lengths;
  lengths.fill(0.5);
  Mat6 J = Mat6::Constant(3);
  Pose X = Pose::Identity();
  X.translation().y() = kNaN;
  EXPECT_EQ(inverse(nominal_g4(), X, lengths), SolveStatus::bad_input);
  EXPECT_EQ(jacobian(nominal_g4(), X, J), SolveStatus::bad_input);
  X = Pose::Identity();
  X.linear()(1, 2) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(inverse(nominal_g4(), X, lengths), SolveStatus::bad_input);
  EXPECT_DOUBLE_EQ(lengths[0], 0.5);
  EXPECT_EQ(J, Mat6::Constant(3));
}

TEST(HexapodKinematics, StrutOfNoLengthIsUnreachable) {
  for (const double deviation : {0.0, 0.015}) {
    const HexapodGeometry g = nominal_g4(deviation);
    const Pose X = make_pose(Mat3(Mat3::Identity()), g.base_joint[2] - g.platform_joint[2]);
    StrutLengths lengths{};
    Mat6 J;
    EXPECT_EQ(inverse(g, X, lengths), SolveStatus::unreachable);
    EXPECT_EQ(jacobian(g, X, J), SolveStatus::unreachable);
    std::vector<LimitViolation> violations;
    check(g, joints_at_home(g, Pose::Identity()), limits_g4(), X, violations);
    const auto strut_3 = std::find_if(violations.begin(), violations.end(),
                                      [](const LimitViolation& v) { return v.part == "strut 3"; });
    ASSERT_NE(strut_3, violations.end());
    EXPECT_EQ(strut_3->kind, LimitKind::unreachable);
    EXPECT_EQ(strut_3->value, 0);
    EXPECT_EQ(strut_3->limit, deviation);
  }
}

TEST(HexapodKinematics, NothingOfTheControlCycleAllocates) {
  const HexapodGeometry g = nominal_g4(0.015);
  const auto mechanism = make_hexapod(g, joints_at_home(g, Pose::Identity()), limits_g4(), Pose::Identity());
  Random random(15, "allocation");
  double sink = 0;
  const long before = allocations();
  for (int n = 0; n < 200; ++n) {
    const Pose X = random_pose(random);
    StrutLengths lengths{};
    Mat6 J;
    sink += inverse(g, X, lengths) == SolveStatus::ok;
    sink += jacobian(g, X, J) == SolveStatus::ok;
    sink += forward(g, lengths, Pose::Identity()).residual + J(0, 0) + condition_number(g, X);
    AxisVector axes{};
    Eigen::Matrix<double, Eigen::Dynamic, 6, 0, kMaxAxes, 6> rates(kStruts, 6);
    Pose X_found = Pose::Identity();
    sink += mechanism->inverse(X, axes, axes) == SolveStatus::ok;
    sink += mechanism->axis_rates(X, axes, rates) == SolveStatus::ok;
    sink += mechanism->forward(axes, X, X_found) == SolveStatus::ok;
    sink += rates(5, 5) + X_found.translation().x();
  }
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_TRUE(std::isfinite(sink));
  const long counted = allocations();  // the counter does count, Eigen's own too
  std::vector<double> kept(static_cast<std::size_t>(counted) + 1);
  EXPECT_EQ(allocations() - counted, 1) << kept.size();
  const Eigen::VectorXd vector = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(kept.size()), sink);
  EXPECT_EQ(allocations() - counted, 2) << vector.size();
}

}  // namespace
}  // namespace understudy::kinematics
