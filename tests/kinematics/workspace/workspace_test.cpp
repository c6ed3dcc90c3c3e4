#include "kinematics/workspace/workspace.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/units.h"

namespace understudy::kinematics {
namespace {

/// Three slides that carry a head; the tool's tip hangs `head` below it along the tool's axis. All of its
/// workspace is known: the box of the slides' ranges, moved by the head.
class Gantry final : public Mechanism {
 public:
  std::array<AxisRange, 3> ranges{{{-0.030, 0.010}, {-0.020, 0.020}, {-0.020, 0.015}}};
  double head = 0;       ///< [m]
  double reach = 1;      ///< [m], beyond which there is no solution
  bool says_why = true;  ///< where there is none

  int axis_count() const override { return 3; }
  std::string axis_name(int axis) const override { return std::string(1, static_cast<char>('x' + axis)); }
  bool axis_is_angle(int) const override { return false; }
  AxisRange axis_range(int axis) const override { return ranges[static_cast<std::size_t>(axis)]; }
  Pose home() const override { return Pose::Identity(); }
  SolveStatus inverse(const Pose& X, std::span<const double>, std::span<double> axes) const override {
    if (X.translation().norm() > reach) return SolveStatus::unreachable;
    const Vec3 p = X.translation() + head * X.linear().col(2);
    for (int i = 0; i < 3; ++i) axes[static_cast<std::size_t>(i)] = p[i];
    return SolveStatus::ok;
  }
  SolveStatus forward(std::span<const double>, const Pose&, Pose&) const override { return SolveStatus::ok; }
  SolveStatus axis_rates(const Pose&, std::span<const double>,
                         Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 6>>) const override {
    return SolveStatus::ok;
  }
  double condition_number(const Pose& X, std::span<const double>) const override {
    return 1 + to_mm(std::abs(X.translation().x()));
  }
  void check(const Pose&, std::span<const double> axes, std::vector<LimitViolation>& found) const override {
    if (axes.empty() && says_why) found.push_back({LimitKind::unreachable, "tool pose", 0, 0, ""});
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const auto [lower, upper] = ranges[i];
      if (axes[i] < lower || axes[i] > upper)
        found.push_back({LimitKind::joint_limit, "axis " + axis_name(static_cast<int>(i)), axes[i],
                         axes[i] < lower ? lower : upper, "m"});
    }
  }
};

/// 20 x 20 x 20 points at -47.5, -42.5, ... 47.5 mm.
WorkspaceRequest cube_100mm() {
  WorkspaceRequest request;
  request.grid = {Vec3::Constant(-0.050), Vec3::Constant(0.050), 0.005};
  request.orientations = {Mat3::Identity()};
  request.spans = {{"axis x", 0.040}, {"axis y", 0.040}, {"axis z", 0.035}};
  return request;
}

const WorkspaceLimit& limit_of(const Workspace& w, const std::string& part, bool above) {
  for (const WorkspaceLimit& limit : w.limits)
    if (limit.part == part && limit.above == above) return limit;
  throw std::runtime_error("no limit of " + part);
}

/// Of the point with these indices; its middle is at 5 i - 47.5 mm.
std::string binding_part(const Workspace& w, int x, int y, int z) {
  const int binding = w.binding[w.index(x, y, z)];
  return binding == 0 ? "" : w.limits[static_cast<std::size_t>(binding - 1)].part;
}

TEST(WorkspaceGrid, CellsFitTheBoxAndPointsAreTheirMiddles) {
  const WorkspaceGrid grid{Vec3(0, 0, 0), Vec3(0.030, 0.025, 0), 0.010};
  EXPECT_EQ(grid.cells(), (std::array<int, 3>{3, 2, 1}));
  EXPECT_EQ(grid.size(), 6);
  // 1e-15 m: rounding.
  EXPECT_LT((grid.point(0, 0, 0) - Vec3(0.005, 0.0075, 0)).norm(), 1e-15);
  EXPECT_LT((grid.point(2, 1, 0) - Vec3(0.025, 0.0175, 0)).norm(), 1e-15);
}

TEST(Workspace, CountsTheBoxOfAGantryExactly) {
  const Workspace w = evaluate_workspace(Gantry(), cube_100mm());
  EXPECT_EQ(w.reachable, 8 * 8 * 7);
  EXPECT_EQ(limit_of(w, "axis x", true).broken, 8 * 400);
  EXPECT_EQ(limit_of(w, "axis x", false).broken, 4 * 400);
  EXPECT_EQ(limit_of(w, "axis z", true).broken, 7 * 400);
  // What opens without a limit: beyond it, within the ranges of the other two.
  EXPECT_EQ(limit_of(w, "axis x", true).alone, 8 * 8 * 7);
  EXPECT_EQ(limit_of(w, "axis x", false).alone, 4 * 8 * 7);
  EXPECT_EQ(limit_of(w, "axis y", true).alone, 8 * 6 * 7);
  EXPECT_EQ(limit_of(w, "axis z", false).alone, 8 * 8 * 6);
  std::int64_t binds = 0;
  for (const WorkspaceLimit& limit : w.limits) binds += limit.binds;
  EXPECT_EQ(binds + w.reachable, 8000) << "one binding limit at every point that fails";
}

TEST(Workspace, TheLargestExcessForItsRangeBinds) {
  const Workspace w = evaluate_workspace(Gantry(), cube_100mm());
  EXPECT_EQ(binding_part(w, 8, 9, 9), "");
  EXPECT_EQ(binding_part(w, 12, 15, 9), "axis y") << "x 2.5 of 40 mm, y 7.5 of 40 mm beyond";
  EXPECT_EQ(binding_part(w, 14, 14, 9), "axis x") << "x 12.5 of 40, y 2.5 of 40 mm beyond";
  // z at 47.5 is 32.5 of 35 mm beyond, x at 47.5 is 37.5 of 40 mm: 0.929 against 0.938.
  EXPECT_EQ(binding_part(w, 19, 9, 19), "axis x");
  // Without spans the excess counts as a share of the value: 32.5 of 47.5 against 37.5 of 47.5 mm at the same
  // point; at x = 12.5, z = 17.5 it is 2.5 of 12.5 against 2.5 of 17.5 mm.
  auto request = cube_100mm();
  request.spans.clear();
  EXPECT_EQ(binding_part(evaluate_workspace(Gantry(), request), 12, 9, 13), "axis x");
  EXPECT_EQ(binding_part(w, 12, 9, 13), "axis z") << "2.5 of 40 against 2.5 of 35 mm";
}

TEST(Workspace, TellsMarginsConditionAndTheUseOfAxes) {
  const Workspace w = evaluate_workspace(Gantry(), cube_100mm());
  const auto margin = reachable_quantiles(w, w.margin), condition = reachable_quantiles(w, w.condition);
  ASSERT_EQ(margin.size(), kWorkspaceQuantiles.size());
  // 1e-6: kept as float. The outermost points are 2.5 mm from an end of 40 mm, the middle ones 2.5 mm off it.
  EXPECT_NEAR(margin.front(), 0.125, 1e-6);
  EXPECT_NEAR(margin.back(), 0.875, 1e-6);
  EXPECT_NEAR(condition.front(), 3.5, 1e-6);
  EXPECT_NEAR(condition.back(), 28.5, 1e-5);
  ASSERT_EQ(w.axes.size(), 3u);
  EXPECT_NEAR(w.axes[0].lowest, -0.0275, 1e-15);
  EXPECT_NEAR(w.axes[0].highest, 0.0075, 1e-15);
  EXPECT_NEAR(w.axes[2].highest, 0.0125, 1e-15);
}

TEST(Workspace, EveryOrientationMustBePossible) {
  // Upright the head is 20 mm above the tip, tilted 20 mm beside it along x: z must stay within -40..-5 mm
  // and within -20..15 mm, x within -30..10 mm and -50..-10 mm.
  Gantry gantry;
  gantry.head = 0.020;
  auto request = cube_100mm();
  request.orientations.push_back(exp_rotation(from_deg(90) * Vec3::UnitY()));
  const Workspace w = evaluate_workspace(gantry, request);
  EXPECT_EQ(w.reachable, 4 * 8 * 3);
  EXPECT_TRUE(w.reaches(4, 9, 6)) << "x -27.5, z -17.5 mm";
  EXPECT_FALSE(w.reaches(8, 9, 6)) << "x -7.5 mm: the tilted head is beyond 10 mm";
}

TEST(Workspace, NoSolutionBindsBeforeEveryLimitAndKeepsItsReason) {
  Gantry gantry;
  gantry.reach = 0.010;
  for (const bool says_why : {true, false}) {
    gantry.says_why = says_why;
    const Workspace w = evaluate_workspace(gantry, cube_100mm());
    EXPECT_EQ(w.reachable, 32) << "8 points at 4.3 mm and 24 at 8.3 mm from the middle";
    ASSERT_EQ(w.limits.size(), 1u);
    EXPECT_EQ(w.limits[0].kind, LimitKind::unreachable);
    EXPECT_EQ(w.limits[0].part, says_why ? "tool pose" : "tool pose (unreachable)");
    EXPECT_EQ(w.limits[0].alone, 8000 - 32);
  }
}

TEST(Workspace, NothingReachableIsAnAnswer) {
  auto request = cube_100mm();
  request.grid = {Vec3::Constant(1), Vec3::Constant(1.1), 0.05};
  const Workspace w = evaluate_workspace(Gantry(), request);
  EXPECT_EQ(w.reachable, 0);
  EXPECT_TRUE(w.axes.empty());
  EXPECT_FALSE(largest_cube(w));
  EXPECT_FALSE(largest_box(w));
  EXPECT_TRUE(reachable_quantiles(w, w.margin).empty());
}

TEST(Workspace, DoesNotDependOnTheNumberOfThreads) {
  Gantry gantry;
  gantry.reach = 0.045;
  auto request = cube_100mm();
  const Workspace one = evaluate_workspace(gantry, request);
  for (const int threads : {2, 3, 7}) {
    request.threads = threads;
    const Workspace many = evaluate_workspace(gantry, request);
    EXPECT_EQ(one.binding, many.binding);
    EXPECT_EQ(one.margin, many.margin);
    EXPECT_EQ(one.condition, many.condition);
    ASSERT_EQ(one.limits.size(), many.limits.size());
    for (std::size_t i = 0; i < one.limits.size(); ++i) {
      EXPECT_EQ(one.limits[i].part, many.limits[i].part);
      EXPECT_EQ(one.limits[i].above, many.limits[i].above);
      EXPECT_EQ(one.limits[i].binds, many.limits[i].binds);
      EXPECT_EQ(one.limits[i].broken, many.limits[i].broken);
      EXPECT_EQ(one.limits[i].alone, many.limits[i].alone);
    }
  }
}

TEST(Workspace, EqualPartsShareAFamily) {
  EXPECT_EQ(limit_family("ball joint 3"), "ball joint");
  EXPECT_EQ(limit_family("base joint 12 (lateral)"), "base joint (lateral)");
  EXPECT_EQ(limit_family("struts 1 and 6"), "struts");
  EXPECT_EQ(limit_family("axis j1"), "axis j1");
}

TEST(WorkspaceBox, FindsCubeAndBoxOfTheGantry) {
  const Workspace w = evaluate_workspace(Gantry(), cube_100mm());
  const auto cube = largest_cube(w), box = largest_box(w);
  ASSERT_TRUE(cube && box);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(cube->last[i] - cube->first[i], 6);
  EXPECT_EQ(box->first, (std::array<int, 3>{4, 6, 6}));
  EXPECT_EQ(box->last, (std::array<int, 3>{11, 13, 12}));
}

struct Largest {
  int cube = 0, box = 0;  // points along an edge, points in all
};

/// By trying every box.
Largest try_all(const Workspace& w) {
  const auto n = w.grid.cells();
  const auto full = [&](int x0, int x1, int y0, int y1, int z0, int z1) {
    for (int z = z0; z <= z1; ++z)
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x)
          if (!w.reaches(x, y, z)) return false;
    return true;
  };
  Largest best;
  for (int x0 = 0; x0 < n[0]; ++x0)
    for (int y0 = 0; y0 < n[1]; ++y0)
      for (int z0 = 0; z0 < n[2]; ++z0)
        for (int x1 = x0; x1 < n[0]; ++x1)
          for (int y1 = y0; y1 < n[1]; ++y1)
            for (int z1 = z0; z1 < n[2] && full(x0, x1, y0, y1, z0, z1); ++z1) {
              best.box = std::max(best.box, (x1 - x0 + 1) * (y1 - y0 + 1) * (z1 - z0 + 1));
              if (x1 - x0 == y1 - y0 && y1 - y0 == z1 - z0) best.cube = std::max(best.cube, x1 - x0 + 1);
            }
  return best;
}

TEST(WorkspaceBox, AgreesWithTryingEveryBoxOfRandomSets) {
  Random random(3, "workspace sets");
  for (int trial = 0; trial < 60; ++trial) {
    Workspace w;
    w.grid = {Vec3::Zero(), Vec3(6, 5, 7), 1};
    w.binding.resize(6 * 5 * 7);
    const double share = random.uniform(0.02, 0.5);
    for (auto& binding : w.binding) binding = random.uniform(0, 1) < share;
    const Largest expected = try_all(w);
    const auto cube = largest_cube(w), box = largest_box(w);
    ASSERT_TRUE(cube && box);
    int points = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(cube->last[i] - cube->first[i] + 1, expected.cube) << "trial " << trial;
      points *= box->last[i] - box->first[i] + 1;
    }
    EXPECT_EQ(points, expected.box) << "trial " << trial;
    for (int z = box->first[2]; z <= box->last[2]; ++z)
      for (int y = box->first[1]; y <= box->last[1]; ++y)
        for (int x = box->first[0]; x <= box->last[0]; ++x) EXPECT_TRUE(w.reaches(x, y, z));
    for (int z = cube->first[2]; z <= cube->last[2]; ++z)
      for (int y = cube->first[1]; y <= cube->last[1]; ++y)
        for (int x = cube->first[0]; x <= cube->last[0]; ++x) EXPECT_TRUE(w.reaches(x, y, z));
  }
}

}  // namespace
}  // namespace understudy::kinematics
