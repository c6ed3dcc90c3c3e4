// Pose repeatability of the arm from the play of its joints (ISO 9283; docs/reference.md#robot-arm).
//
// Which side a joint is on: gravity decides where its torque is above friction; elsewhere (the vertical axis,
// the axes that carry little) the joint is where the approach left it, either side alike.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/random.h"
#include "core/units.h"
#include "sim/plant/quasistatic/quasistatic.h"

namespace understudy::sim {
namespace {

constexpr int kCycles = 30;  // ISO 9283, 7.2.2
constexpr int kAxes = 6;
constexpr double kArcMinute = kDegree / 60;  // [rad]
constexpr double kFriction = 0.02;  // [N m]: below what gravity asks of any axis but those named above

/// Where the standard's cube of 250 mm lies: its centre in B, and how far the nozzle leans forwards.
struct Placement {
  Vec3 centre{0.4, 0, 0.3};
  double lean = from_deg(45);
};

/// The five poses of the standard: centre and four corners of a diagonal plane of its cube, 0.4 edges from
/// the centre. Empty where the arm does not reach them all.
std::vector<PathSample> standard_poses(const kinematics::Mechanism& mechanism, const Placement& placement) {
  const double h = 0.4 * 0.25;
  std::vector<PathSample> poses;
  for (const Vec3& offset :
       {Vec3(0, 0, 0), Vec3(h, h, h), Vec3(-h, h, h), Vec3(-h, -h, -h), Vec3(h, -h, -h)}) {
    Pose X_BT = Pose::Identity();
    X_BT.translation() = placement.centre + offset;
    X_BT.linear() = exp_rotation(Vec3(0, -placement.lean, 0));
    PathSample sample;
    const std::span<double> axes = std::span(sample.position).first(kAxes);
    std::vector<kinematics::LimitViolation> violations;
    if (mechanism.inverse(X_BT, {}, axes) != kinematics::SolveStatus::ok) return {};
    mechanism.check(X_BT, axes, violations);
    if (!violations.empty()) return {};
    poses.push_back(sample);
  }
  return poses;
}

/// Mean distance from the centre of all that was attained, and three standard deviations. [m]
double repeatability(const std::vector<Vec3>& attained) {
  const double n = static_cast<double>(attained.size());
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : attained) centre += p / n;
  double mean = 0, squares = 0;
  for (const Vec3& p : attained) mean += (p - centre).norm() / n;
  for (const Vec3& p : attained) squares += std::pow((p - centre).norm() - mean, 2);
  return mean + 3 * std::sqrt(squares / (n - 1));
}

/// Mean over the poses and over repeated tests. `random_sides` false: every approach from the same side.
double test_arm(double play, bool random_sides, const Placement& placement = {}) {
  auto machine = machine::load_machine("arm");
  std::fill_n(machine.chain().friction.begin(), kAxes, kFriction);
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.axis_play.fill(play);
  QuasistaticSampler sampler(machine, built);
  Random random(3, "approaches");
  const auto poses = standard_poses(*machine.make_mechanism(), placement);
  if (poses.empty()) return 0;
  constexpr int kTests = 20;  // 30 approaches alone scatter by 8 %; the mean of 100 such does not
  double sum = 0;
  for (const PathSample& pose : poses) {
    for (int test = 0; test < kTests; ++test) {
      std::vector<Vec3> attained;
      for (int cycle = 0; cycle < kCycles; ++cycle) {
        for (int i = 0; i < kAxes; ++i)
          sampler.place_gap(i, random_sides && random.uniform() < 0.5 ? play / 2 : -play / 2);
        Pose X_WT;
        EXPECT_EQ(sampler.sample(pose, X_WT), kinematics::SolveStatus::ok);
        attained.push_back(X_WT.translation());
      }
      sum += repeatability(attained);
    }
  }
  return sum / (kTests * static_cast<double>(poses.size()));
}

TEST(ArmRepeatability, FollowsThePlay) {
  for (const double minutes : {0.1, 0.5, 1.0, 2.0})
    EXPECT_NEAR(test_arm(minutes * kArcMinute, true), 83e-6 * minutes, 8.3e-6 * minutes) << minutes;
}

TEST(ArmRepeatability, PublishedFigureNeedsAThirdOfAMinute) {
  EXPECT_NEAR(test_arm(0.36 * kArcMinute, true), 0.03e-3, 0.003e-3);
}

// docs/reference.md#robot-arm states neither poses nor sides: its 83 um per arcmin is at the lower end of
// what a cube gives that lies elsewhere. Prints what docs/quasistatic.md says.
TEST(SlowArmRepeatability, DependsOnWhereTheCubeLies) {
  std::vector<double> per_minute;
  for (const double x : {0.35, 0.4, 0.45, 0.5})
    for (const double z : {0.2, 0.3, 0.4})
      for (const double lean : {0.0, 45.0}) {
        const double figure = to_um(test_arm(kArcMinute, true, {Vec3(x, 0, z), from_deg(lean)}));
        if (figure > 0) per_minute.push_back(figure);
      }
  std::sort(per_minute.begin(), per_minute.end());
  ASSERT_GE(per_minute.size(), 8u);
  std::printf("%zu placements: %.0f to %.0f um per arcmin, median %.0f\n", per_minute.size(),
              per_minute.front(), per_minute.back(), per_minute[per_minute.size() / 2]);
  // The lever of an arm of 0.68 m reach: an arcmin of play on one axis is 200 um at its end.
  EXPECT_GT(per_minute.front(), 60);
  EXPECT_LT(per_minute.back(), 200);
}

TEST(ArmRepeatability, ApproachFromOneSideHidesThePlay) { EXPECT_LT(test_arm(2 * kArcMinute, false), 1e-9); }

}  // namespace
}  // namespace understudy::sim
