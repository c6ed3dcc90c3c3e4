// The four test paths of Yu 2023, section 4 (figure 6, table 2), see
// docs/reference.md#finishing-stage.
#include "tests/kinematics/chain/finishing_follower.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "core/units.h"
#include "kinematics/chain/finishing.h"
#include "tests/guard/cycle_guard.h"

namespace understudy::kinematics {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kStep = from_mm(0.025);
// Unpublished; L3 cancels in the errors (docs/reference.md#finishing-stage).
constexpr FinishingGeometry kStage{0.25, 0.08};

struct Path {
  std::vector<Pose> poses;         // X_ST: the end mill level, along the wall's normal
  std::vector<double> curvatures;  // [1/m], at the poses
};

Pose on_wall(const Vec2& p, double normal) {
  const Vec3 z_T(std::cos(normal), std::sin(normal), 0), x_T = Vec3::UnitZ();
  Mat3 R;
  R << x_T, z_T.cross(x_T), z_T;
  return make_pose(R, Vec3(p.x(), p.y(), 0));
}

// Along lines and arcs by arc length, from the middle of the right end, counterclockwise.
struct Piece {
  double length, curvature;
};
Path cross(double width, double radius) {
  const double end = width / 3 - 2 * radius, side = width / 3 - 2 * radius;
  std::vector<Piece> pieces;
  for (int arm = 0; arm < 4; ++arm) {
    const double quarter = kPi / 2 * radius;
    pieces.insert(pieces.end(), {{end / 2, 0},
                                 {quarter, 1 / radius},
                                 {side, 0},
                                 {quarter, -1 / radius},
                                 {side, 0},
                                 {quarter, 1 / radius},
                                 {end / 2, 0}});
  }
  double perimeter = 0;
  for (const Piece& piece : pieces) perimeter += piece.length;
  EXPECT_NEAR(perimeter, 4 * width - 24 * radius + 6 * kPi * radius, 1e-12);
  const int steps = static_cast<int>(std::lround(perimeter / kStep));
  Path path;
  Vec2 p(width / 2, 0);
  double normal = 0, done = 0;
  std::size_t k = 0;
  for (int n = 0; n <= steps; ++n) {
    const double s = n * perimeter / steps;
    const auto at = [&](double way, double& turned) -> Vec2 {
      const double c = pieces[k].curvature, heading = normal + kPi / 2;
      turned = normal + c * way;
      if (c == 0) return p + way * Vec2(std::cos(heading), std::sin(heading));
      return p + Vec2(std::sin(heading + c * way) - std::sin(heading),
                      std::cos(heading) - std::cos(heading + c * way)) /
                     c;
    };
    double turned = 0;
    while (k + 1 < pieces.size() && s - done > pieces[k].length) {
      p = at(pieces[k].length, turned);
      normal = turned;
      done += pieces[k++].length;
    }
    const Vec2 here = at(s - done, turned);
    path.poses.push_back(on_wall(here, turned));
    path.curvatures.push_back(pieces[k].curvature);
  }
  EXPECT_LE((path.poses.back().translation() - path.poses.front().translation()).norm(), 1e-12);
  return path;
}

// Equal arc lengths: s(t) by Simpson's rule on a fine grid, inverted by stepping with midpoint slopes.
Path ellipse(double a, double b) {
  const auto speed = [&](double t) { return std::hypot(a * std::sin(t), b * std::cos(t)); };
  constexpr int kGrid = 20'000;
  const double h = 2 * kPi / kGrid;
  double perimeter = 0;
  for (int n = 0; n < kGrid; ++n)
    perimeter += h / 6 * (speed(n * h) + 4 * speed((n + 0.5) * h) + speed((n + 1) * h));
  const int steps = static_cast<int>(std::lround(perimeter / kStep));
  const double ds = perimeter / steps;
  Path path;
  double t = 0;
  for (int n = 0; n <= steps; ++n) {
    path.poses.push_back(
        on_wall({a * std::cos(t), b * std::sin(t)}, std::atan2(a * std::sin(t), b * std::cos(t))));
    path.curvatures.push_back(a * b / std::pow(speed(t), 3));
    t += ds / speed(t + ds / 2 / speed(t));
  }
  EXPECT_NEAR(t - ds / speed(t), 2 * kPi, 1e-6);
  return path;
}

struct Error {
  double rms, peak;
};
Error error_of(const std::vector<double>& values) {
  double sum = 0, peak = 0;
  for (const double v : values) sum += v * v, peak = std::max(peak, std::abs(v));
  return {std::sqrt(sum / static_cast<double>(values.size())), peak};
}

struct Followed {
  Error distance, orientation;  // [m], [rad]
};
Followed follow(const Path& path, int corrections) {
  const Chain chain = finishing_chain(kStage);
  std::array<double, kFinishingAxes> start{};
  // Bed at zero; an elementary start, so that the first point has no error.
  EXPECT_EQ(finishing_at_bed_turn(kStage, path.poses[0], kPi, 0, start), SolveStatus::ok);
  FollowerOptions options;
  options.corrections = corrections;
  FinishingFollower follower(chain, start, options);
  std::vector<double> distance, orientation;
  for (std::size_t n = 1; n < path.poses.size(); ++n) {
    EXPECT_EQ(follower.step(path.poses[n]), SolveStatus::ok) << n;
    const Pose X = follower.pose();
    distance.push_back((X.translation() - path.poses[n].translation()).norm());
    orientation.push_back(tool_axis_angle(X, path.poses[n]));
  }
  return {error_of(distance), error_of(orientation)};
}

// The sine in the pose error leaves t - sin t of a step that turns by t: (curvature ds)^3 / 6.
Error closed_form(const Path& path) {
  std::vector<double> values;
  for (std::size_t n = 1; n < path.poses.size(); ++n) {
    const double middle = (path.curvatures[n] + path.curvatures[n - 1]) / 2;
    values.push_back(std::pow(std::abs(middle) * kStep, 3) / 6);
  }
  return error_of(values);
}

struct Row {
  const char* name;
  std::function<Path()> path;
  double rms, peak;              // [nrad], predicted in docs/reference.md#finishing-stage
  bool reproduced;               // by docs/reference.md#finishing-stage
  double paper_rms, paper_peak;  // [nrad], table 2
  double paper_distance;         // [nm], RMS
};
const std::vector<Row>& rows() {
  static const std::vector<Row> all{
      {"cross 90, r 10", [] { return cross(0.090, 0.010); }, 2.036, 2.604, true, 2.04, 2.62, 152.33},
      {"cross 150, r 15", [] { return cross(0.150, 0.015); }, 0.567, 0.772, true, 0.57, 0.77, 95.49},
      {"ellipse 50/35", [] { return ellipse(0.050, 0.035); }, 0.073, 0.177, true, 0.07, 0.17, 5.38},
      {"ellipse 75/45", [] { return ellipse(0.075, 0.045); }, 0.045, 0.132, false, 0.01, 0.03, 2.78}};
  return all;
}

TEST(FinishingFollower, OneCorrectionLeavesNothingOnTheFourPaths) {
  for (const Row& row : rows()) {
    const Followed followed = follow(row.path(), 1);
    EXPECT_LE(followed.distance.rms, 1e-12) << row.name;     // 1e-3 nm
    EXPECT_LE(followed.orientation.rms, 1e-15) << row.name;  // 1e-6 nrad
  }
}

// 2 %: the closed form and the reference round to 1 %, the controller's answer takes 0.35 % (kp period), and
// the points where lines meet arcs are counted one way or the other.
TEST(FinishingFollower, WithoutCorrectionThePapersOrientationRowsComeBack) {
  for (const Row& row : rows()) {
    const Path path = row.path();
    const Followed followed = follow(path, 0);
    const Error expected = closed_form(path);
    EXPECT_NEAR(followed.orientation.rms, expected.rms, 0.01 * expected.rms) << row.name;
    EXPECT_NEAR(followed.orientation.peak, expected.peak, 0.01 * expected.peak) << row.name;
    EXPECT_NEAR(followed.orientation.rms * 1e9, row.rms, 0.02 * row.rms) << row.name;
    EXPECT_NEAR(followed.orientation.peak * 1e9, row.peak, 0.02 * row.peak) << row.name;
    // Distance in magnitude only: lengths, units and start are unpublished
    // (docs/reference.md#finishing-stage).
    EXPECT_GT(followed.distance.rms * 1e9, row.paper_distance / 30) << row.name;
    EXPECT_LT(followed.distance.rms * 1e9, row.paper_distance * 30) << row.name;
    // The paper's own figures, to the digits it prints; its fourth row is a third of what its scheme gives
    // (docs/reference.md#finishing-stage), and must not pass unnoticed should that ever change.
    const bool as_printed = std::abs(followed.orientation.rms * 1e9 - row.paper_rms) <= 0.015 &&
                            std::abs(followed.orientation.peak * 1e9 - row.paper_peak) <= 0.03;
    EXPECT_EQ(as_printed, row.reproduced) << row.name;
  }
}

TEST(FinishingFollower, NullSpaceMotionMovesTheBedAndNotTheTool) {
  const Path path = ellipse(0.050, 0.035);
  std::array<double, kFinishingAxes> start{};
  ASSERT_EQ(finishing_at_bed_turn(kStage, path.poses[0], 0, 0, start), SolveStatus::ok);
  FollowerOptions options;
  options.null_space_motion[1] = 1e-4;
  FinishingFollower still(finishing_chain(kStage), start, {}),
      moving(finishing_chain(kStage), start, options);
  for (std::size_t n = 0; n < 500; ++n) {
    ASSERT_EQ(still.step(path.poses[n]), SolveStatus::ok);
    ASSERT_EQ(moving.step(path.poses[n]), SolveStatus::ok);
    EXPECT_LE((moving.pose().translation() - path.poses[n].translation()).norm(), 1e-12);
  }
  EXPECT_GT(std::abs(moving.axes()[1] - still.axes()[1]), 1e-3);
}

TEST(FinishingFollower, BadInputMovesNothing) {
  const Chain chain = finishing_chain(kStage);
  const std::array<double, kFinishingAxes> start{0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  FinishingFollower follower(chain, start, {});
  Pose X = forward(chain, start);
  X.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(follower.step(X), SolveStatus::bad_input);
  for (std::size_t i = 0; i < start.size(); ++i) EXPECT_EQ(follower.axes()[i], start[i]);
  FollowerOptions wild;
  wild.period = 1;  // kp period = 3.5: every error would come back larger
  FinishingFollower never(chain, start, wild);
  EXPECT_EQ(never.step(forward(chain, start)), SolveStatus::bad_input);
}

TEST(FinishingFollower, AStepAllocatesNothing) {
  const Chain chain = finishing_chain(kStage);
  const std::array<double, kFinishingAxes> start{};
  FinishingFollower follower(chain, start, {});
  const Pose X = forward(chain, start);
  const long before = allocations();
  int followed = 0;
  for (int n = 0; n < 100; ++n) followed += follower.step(X) == SolveStatus::ok;
  EXPECT_EQ(allocations() - before, 0);
  EXPECT_EQ(followed, 100);
}

}  // namespace
}  // namespace understudy::kinematics
