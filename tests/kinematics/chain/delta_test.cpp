// A linear delta against the closed forms of the firmwares that drive such printers.
#include "kinematics/chain/delta.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "core/random.h"
#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "tests/guard/cycle_guard.h"

namespace understudy::kinematics {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kRadius = 0.1344, kRod = 0.267;  // [m], of an Anycubic Kossel Linear Plus
constexpr double kAngles[] = {210, 330, 90};

ChainDescription described(double joint_height = 0, double lean_max_deg = 75) {
  ChainDescription d;
  d.kind = "delta";
  for (const double angle : kAngles)
    for (const double v : {kRadius, from_deg(angle), kRod, 0.0}) d.parameters.push_back(v);
  d.parameters.push_back(joint_height);
  d.parameters.push_back(from_deg(lean_max_deg));
  d.chain = find_chain_kind("delta")->chain(d.parameters);
  d.home.fill(0);
  for (int i = 0; i < 3; ++i) d.home[static_cast<std::size_t>(i)] = 0.1 + 0.2307 + joint_height;
  return d;
}

Pose at(double x_mm, double y_mm, double z_mm) {
  return make_pose(Quat::Identity(), from_mm(1) * Vec3(x_mm, y_mm, z_mm));
}

/// [m], within 100 mm of the middle.
Pose random_pose(Random& random) {
  const double r = 100 * std::sqrt(random.uniform(0, 1)), angle = random.uniform(0, 6.28);
  return at(r * std::cos(angle), r * std::sin(angle), random.uniform(0, 200));
}

struct Figure {
  std::array<double, 3> tip_mm, carriage_mm;
};
// What the expression of calc_stable_position in klippy/kinematics/delta.py (github.com/Klipper3d/klipper)
// gives in double precision for delta_radius 134.4, arm_length 267 and its default angles.
constexpr Figure kFigures[] = {
    {{0, 0, 0}, {230.706826947, 230.706826947, 230.706826947}},
    {{30, -40, 50}, {271.625835912, 301.167810151, 249.934089139}},
    {{-90, 60, 0.2}, {233.464927857, 112.051479345, 240.311723995}},
    {{0, -120, 0}, {234.421927302, 234.421927302, 81.053315787}},
};

TEST(Delta, CarriagesStandWhereTheFirmwareHasThem) {
  const auto mechanism = make_chain_mechanism(described());
  for (const Figure& figure : kFigures) {
    const Pose X = at(figure.tip_mm[0], figure.tip_mm[1], figure.tip_mm[2]);
    AxisVector axes{};
    ASSERT_EQ(mechanism->inverse(X, {}, axes), SolveStatus::ok);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(to_mm(axes[i]), figure.carriage_mm[i], 1e-8);
  }
}

// h_i = z + height - zero_i + sqrt(L_i^2 - |(x, y) - A_i|^2), with every parameter of its own.
TEST(Delta, FollowsEachParameterOfItsTowers) {
  const double radius[] = {0.133, 0.1355, 0.1341}, turn[] = {0.4, -0.3, 0.2}, rod[] = {0.2664, 0.2671, 0.268},
               zero[] = {0.0011, -0.0007, 0.0004}, height = 0.04;
  ChainDescription d = described();
  for (std::size_t i = 0; i < 3; ++i) {
    const double tower[] = {radius[i], from_deg(kAngles[i] + turn[i]), rod[i], zero[i]};
    std::copy(std::begin(tower), std::end(tower), d.parameters.begin() + 4 * static_cast<long>(i));
  }
  d.parameters[12] = height;
  d.chain = find_chain_kind("delta")->chain(d.parameters);
  const auto mechanism = make_chain_mechanism(d);
  Random random(75, "delta");
  for (int n = 0; n < 1000; ++n) {
    const Pose X = random_pose(random);
    AxisVector axes{};
    ASSERT_EQ(mechanism->inverse(X, {}, axes), SolveStatus::ok);
    for (std::size_t i = 0; i < 3; ++i) {
      const double angle = from_deg(kAngles[i] + turn[i]);
      const double dx = X.translation().x() - radius[i] * std::cos(angle),
                   dy = X.translation().y() - radius[i] * std::sin(angle);
      EXPECT_NEAR(axes[i],
                  X.translation().z() + height - zero[i] + std::sqrt(rod[i] * rod[i] - dx * dx - dy * dy),
                  1e-12);
    }
    Pose back;
    ASSERT_EQ(mechanism->forward(axes, X, back), SolveStatus::ok);
    EXPECT_LE((back.matrix() - X.matrix()).norm(), 1e-11) << n;
  }
}

TEST(Delta, RatesAreDifferencesOfTheInverse) {
  constexpr double h = 1e-5;  // [m]
  const auto mechanism = make_chain_mechanism(described(0.04));
  EXPECT_FALSE(mechanism->follows_spin());
  Random random(76, "delta");
  for (int n = 0; n < 300; ++n) {
    const Pose X = random_pose(random);
    AxisVector axes{};
    ASSERT_EQ(mechanism->inverse(X, {}, axes), SolveStatus::ok);
    Eigen::Matrix<double, Eigen::Dynamic, 6> rates(3, 6);
    // A twist that tilts is one that it cannot follow.
    ASSERT_EQ(mechanism->axis_rates(X, axes, rates), SolveStatus::singular);
    EXPECT_LE(rates.rightCols(3).norm(), 1e-12);
    for (int k = 0; k < 3; ++k) {
      const auto moved = [&](double by) {
        Pose there = X;
        there.translation()[k] += by;
        AxisVector found{};
        EXPECT_EQ(mechanism->inverse(there, axes, found), SolveStatus::ok);
        return found;
      };
      const AxisVector ahead = moved(h), behind = moved(-h);
      for (int i = 0; i < 3; ++i) {
        const auto s = static_cast<std::size_t>(i);
        EXPECT_NEAR(rates(i, k), (ahead[s] - behind[s]) / (2 * h), 1e-6);
      }
    }
  }
}

// Over the middle every carriage moves as z does, and by radius over height of the rod as the tip comes
// nearer: singular values sqrt(3) and sqrt(3/2) R / v.
TEST(Delta, ConditionIsThatOfTheTip) {
  const auto mechanism = make_chain_mechanism(described());
  AxisVector axes{};
  ASSERT_EQ(mechanism->inverse(at(0, 0, 50), {}, axes), SolveStatus::ok);
  const double v = std::sqrt(kRod * kRod - kRadius * kRadius);
  EXPECT_NEAR(mechanism->condition_number(at(0, 0, 50), axes), std::sqrt(2) * v / kRadius, 1e-9);
}

TEST(Delta, NeitherTiltsNorChoosesItsSpin) {
  const auto mechanism = make_chain_mechanism(described());
  const Vec3 p(0.03, -0.04, 0.05);
  AxisVector upright{}, turned{}, tilted{7, 8, 9};
  ASSERT_EQ(mechanism->inverse(make_pose(Quat::Identity(), p), {}, upright), SolveStatus::ok);
  const Quat spin(Eigen::AngleAxisd(1, Vec3::UnitZ())), tilt(Eigen::AngleAxisd(0.01, Vec3::UnitX()));
  ASSERT_EQ(mechanism->inverse(make_pose(spin, p), {}, turned), SolveStatus::ok);
  EXPECT_EQ(upright, turned);
  EXPECT_EQ(mechanism->inverse(make_pose(tilt, p), {}, tilted), SolveStatus::unreachable);
  EXPECT_EQ(tilted, (AxisVector{7, 8, 9}));
  EXPECT_TRUE(mechanism->rotary_words().empty());
}

std::vector<LimitViolation> limits(const Mechanism& mechanism, const Pose& X) {
  AxisVector axes{};
  std::vector<LimitViolation> violations;
  const bool solved = mechanism.inverse(X, {}, axes) == SolveStatus::ok;
  mechanism.check(X, solved ? std::span<const double>(axes) : std::span<const double>(), violations);
  return violations;
}

TEST(Delta, OutOfReachNamesTheRodWithWhatItWouldSpan) {
  const auto mechanism = make_chain_mechanism(described());
  // Tower c stands 134.4 mm behind: 140 mm in front of the middle its rod would have to span 274.4 mm.
  const auto violations = limits(*mechanism, at(0, -140, 10));
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_EQ(violations[0].kind, LimitKind::unreachable);
  EXPECT_EQ(to_string(violations[0]), "rod c spans 274.4 mm, more than 267.0 mm");
}

TEST(Delta, RodsThatLeanTooFarAreALimit) {
  const auto mechanism = make_chain_mechanism(described(0, 70));
  // A rod of 267 mm leans by 70 degrees where it spans 250.898 mm, 116.498 mm in front of the middle.
  EXPECT_TRUE(limits(*mechanism, at(0, -116.4, 10)).empty());
  const auto violations = limits(*mechanism, at(0, -118, 10));
  ASSERT_EQ(violations.size(), 1u);
  EXPECT_EQ(violations[0].kind, LimitKind::joint_angle);
  // asin(252.4 / 267)
  EXPECT_EQ(to_string(violations[0]), "rod c is at 71.0 deg, above 70.0 deg");
}

TEST(Delta, BadInputIsAStatus) {
  const auto mechanism = make_chain_mechanism(described());
  AxisVector axes{1, 2, 3};
  std::array<double, 2> few{};
  Pose X = at(0, 0, 10);
  EXPECT_EQ(mechanism->inverse(X, {}, few), SolveStatus::bad_input);
  EXPECT_EQ(mechanism->inverse(X, std::array<double, 3>{kNaN, 0, 0}, axes), SolveStatus::bad_input);
  X.translation().x() = kNaN;
  EXPECT_EQ(mechanism->inverse(X, {}, axes), SolveStatus::bad_input);
  EXPECT_EQ(axes, (AxisVector{1, 2, 3}));
  EXPECT_EQ(mechanism->forward(std::array<double, 3>{0, 0, 1}, X, X), SolveStatus::unreachable);
  EXPECT_EQ(mechanism->forward(std::array<double, 3>{kNaN, 0, 0}, X, X), SolveStatus::bad_input);
}

TEST(Delta, CallsNothingThatAControlCycleMayNot) {
  const auto mechanism = make_chain_mechanism(described());
  const Pose X = at(10, 20, 30);
  Pose back;
  AxisVector axes{};
  Eigen::Matrix<double, Eigen::Dynamic, 6> rates(3, 6);
  EXPECT_EQ(calls_of([&] {
              static_cast<void>(mechanism->inverse(X, {}, axes));
              static_cast<void>(mechanism->forward(axes, X, back));
              static_cast<void>(mechanism->axis_rates(X, axes, rates));
              static_cast<void>(mechanism->condition_number(X, axes));
            }),
            Calls{});
}

}  // namespace
}  // namespace understudy::kinematics
