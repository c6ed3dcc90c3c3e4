#include "toolpath/planners/surface_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "geometry/mesh.h"
#include "tests/geometry/test_solids.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/planners/section_curve.h"
#include "toolpath/planners/tilt_clip.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;
using geometry::Triangles;
using ::testing::HasSubstr;

constexpr double kBodyRadius = 15.5e-3;

SurfacePlan plan() {
  SurfacePlan p;
  p.gap = 0.13e-3;
  p.standoff = 2e-3;
  p.clearance = 5e-3;
  p.step = 0.5e-3;
  p.chord_tolerance = 1.5e-6;  // twice the sag of the bottle's facets, 0.6 um
  p.feed = 5e-3;
  p.approach_feed = 1e-3;
  p.bead_width = 0.5e-3;
  p.bead_height = 0.2e-3;
  p.filament_diameter = 1.75e-3;
  p.temperature = 483.15;
  p.fan = 0.5;
  p.tilt_max = 30 * kDegree;
  return p;
}

Mesh mesh_of(const Triangles& t) { return {t.vertices, t.triangles}; }

class BottleLine : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    bottle_ = geometry::read_stl(UNDERSTUDY_SOURCE_DIR "/models/parts/bottle.stl");
    const auto section = section_curve(*bottle_, Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ());
    curve_ = clip_by_tilt(*bottle_, section, -20 * kDegree, 20 * kDegree, Vec3::UnitY());
  }
  static void TearDownTestSuite() { bottle_.reset(); }

  // Closed form of the part: a cylinder along y at x = 0, z = 15.5 mm.
  static Vec3 true_normal(const Vec3& p) { return Vec3(p.x(), 0, p.z() - kBodyRadius).normalized(); }
  static double true_height(const Vec3& p) { return std::hypot(p.x(), p.z() - kBodyRadius) - kBodyRadius; }

  static std::shared_ptr<const Mesh> bottle_;
  static std::vector<Vec3> curve_;
};
std::shared_ptr<const Mesh> BottleLine::bottle_;
std::vector<Vec3> BottleLine::curve_;

TEST_F(BottleLine, SwingsFromMinusToPlusTwentyDegreesAlongTheTrueNormal) {
  const Program program = plan_surface(*bottle_, curve_, plan());
  std::vector<Step> path;
  for (const Step& s : program.steps)
    if (s.kind == StepKind::print || s.kind == StepKind::move) path.push_back(s);
  // Song 2015, 6.2.
  EXPECT_NEAR(to_deg(tilt_about(tool_axis(path.front().X_WT), Vec3::UnitY())), -20, 0.1);
  EXPECT_NEAR(to_deg(tilt_about(tool_axis(path.back().X_WT), Vec3::UnitY())), 20, 0.1);
  double last_tilt = -1;
  for (const Step& s : path) {
    const Vec3 tip = s.X_WT.translation();
    EXPECT_LT(to_deg(std::acos(std::min(1.0, tool_axis(s.X_WT).dot(true_normal(tip))))), 0.05);
    EXPECT_NEAR(true_height(tip), plan().gap, 2e-6);  // 0.6 um of it is the sag of the STL's facets
    EXPECT_NEAR(tip.y(), 0, 1e-9);
    EXPECT_GT(tilt_about(tool_axis(s.X_WT), Vec3::UnitY()), last_tilt);
    last_tilt = tilt_about(tool_axis(s.X_WT), Vec3::UnitY());
  }
}

TEST_F(BottleLine, KeepsTheGapBetweenItsPointsToo) {
  const Program program = plan_surface(*bottle_, curve_, plan());
  for (std::size_t i = 1; i < program.steps.size(); ++i) {
    if (program.steps[i].kind != StepKind::print) continue;
    for (const double t : {0.25, 0.5, 0.75}) {
      const Pose X_WT = interpolate(program.steps[i - 1].X_WT, program.steps[i].X_WT, t);
      EXPECT_NEAR(true_height(X_WT.translation()), plan().gap, 2e-6);
      EXPECT_LT(to_deg(std::acos(std::min(1.0, tool_axis(X_WT).dot(true_normal(X_WT.translation()))))), 0.05);
    }
  }
}

TEST_F(BottleLine, ComesInAndLeavesAlongTheNormalInTheOrderOfThePaper) {
  const Program program = plan_surface(*bottle_, curve_, plan());
  const auto& s = program.steps;
  ASSERT_GT(s.size(), 10u);
  const StepKind start[] = {StepKind::temperature, StepKind::fan, StepKind::travel, StepKind::travel,
                            StepKind::move};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(s[i].kind, start[i]) << i;
  for (std::size_t i = 5; i + 1 < s.size(); ++i) EXPECT_EQ(s[i].kind, StepKind::print) << i;
  EXPECT_EQ(s.back().kind, StepKind::travel);
  EXPECT_EQ(s[0].temperature, 483.15);
  EXPECT_TRUE(s[0].wait);
  EXPECT_EQ(s[1].fan, 0.5);

  const Vec3 S = s[4].X_WT.translation(), normal = true_normal(S);
  EXPECT_LT((s[3].X_WT.translation() - (S + 2e-3 * normal)).norm(), 2e-6);  // S', 2 mm out (0.05 deg of 2 mm)
  EXPECT_LT((s[2].X_WT.translation() - (S + 5e-3 * normal)).norm(), 5e-6);
  EXPECT_EQ(s[4].feed, 1e-3);
  EXPECT_EQ(s[4].filament, 0);
  for (std::size_t i = 2; i < 5; ++i) EXPECT_LT(angle_between(s[i].X_WT.linear(), s[4].X_WT.linear()), 1e-12);
  const Vec3 E = s[s.size() - 2].X_WT.translation();
  EXPECT_LT((s.back().X_WT.translation() - (E + 5e-3 * true_normal(E))).norm(), 5e-6);
}

TEST_F(BottleLine, FeedsTheVolumeOfTheBead) {
  const Program program = plan_surface(*bottle_, curve_, plan());
  double fed = 0;
  for (const Step& s : program.steps) {
    fed += s.filament;
    if (s.kind == StepKind::print) {
      EXPECT_EQ(s.feed, 5e-3);
      EXPECT_GT(s.filament, 0);
    }
  }
  // A stadium of 0.5 x 0.2 mm bent round 40 deg, its centre 0.1 mm above the body; chords cost 1e-4.
  const double area = 0.3 * 0.2 + std::numbers::pi * 0.01;
  const double length = (15.5 + 0.1) * 40 * kDegree;
  EXPECT_NEAR(fed * 1e3, area * length / (std::numbers::pi * 0.875 * 0.875), 1e-4 * 0.4);
  EXPECT_NEAR(bead_area(0.5e-3, 0.2e-3), area * 1e-6, 1e-18);
  EXPECT_NEAR(bead_area(0.4e-3, 0.4e-3), std::numbers::pi * 0.2 * 0.2 * 1e-6, 1e-18);
}

TEST_F(BottleLine, StepsAreEvenAndNoLongerThanAsked) {
  const Program program = plan_surface(*bottle_, curve_, plan());
  double shortest = 1, longest = 0;
  for (std::size_t i = 5; i + 1 < program.steps.size(); ++i) {
    const double length =
        (program.steps[i].X_WT.translation() - program.steps[i - 1].X_WT.translation()).norm();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  // 1.5 um of sag on 15.63 mm allows 0.433 mm: 0.5 mm steps are halved. 1.01 is the slack of a step.
  EXPECT_LT(longest, std::min(1.01 * plan().step, std::sqrt(8 * 15.63e-3 * 1.5e-6)));
  EXPECT_LT(longest / shortest, 1.02);  // the facets of the mesh do not show
}

TEST_F(BottleLine, SurvivesTheTripThroughGcode) {
  const Program planned = plan_surface(*bottle_, curve_, plan());
  const Program read = parse_gcode(write_gcode(planned, {}), "bottle.gcode", {});
  ASSERT_EQ(read.steps.size(), planned.steps.size());
  for (std::size_t i = 2; i < read.steps.size(); ++i) {
    EXPECT_EQ(read.steps[i].kind, planned.steps[i].kind);
    EXPECT_LT((read.steps[i].X_WT.translation() - planned.steps[i].X_WT.translation()).norm(), 1e-9);
    EXPECT_LT(angle_between(read.steps[i].X_WT.linear(), planned.steps[i].X_WT.linear()), 2.1e-9);
  }
}

TEST_F(BottleLine, ATiltBeyondTheMachineIsRefusedWithPlaceAndLimit) {
  SurfacePlan narrow = plan();
  narrow.tilt_max = 19.5 * kDegree;
  try {
    plan_surface(*bottle_, curve_, narrow);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("tilts the tool 20.000 deg, more than 19.500 deg"));
    EXPECT_THAT(error.what(), HasSubstr("(-5.301, 0.000, 30.065) mm"));  // 15.5 sin 20, 15.5 + 15.5 cos 20
  }
  narrow.tilt_max = 20 * kDegree;
  EXPECT_NO_THROW(plan_surface(*bottle_, curve_, narrow));
}

TEST(SurfacePlanner, FollowsASphereFromAFewCoarsePoints) {
  // Three points of a great circle, their chords up to 0.7 mm inside.
  const double radius = 0.02;
  const Mesh ball = mesh_of(geometry::sphere(radius, 180, 360));
  std::vector<Vec3> curve;
  for (const double a : {-25.0, -3.0, 22.0})
    curve.push_back(radius * Vec3(std::sin(a * kDegree), 0, std::cos(a * kDegree)));
  const Program program = plan_surface(ball, curve, plan());
  for (const Step& s : program.steps) {
    if (s.kind != StepKind::print) continue;
    const Vec3 tip = s.X_WT.translation();
    EXPECT_NEAR(tip.norm(), radius + plan().gap, 2e-6 + radius * (1 - std::pow(std::cos(0.5 * kDegree), 2)));
    EXPECT_LT(std::acos(std::min(1.0, tool_axis(s.X_WT).dot(tip.normalized()))), 0.3 * kDegree);
  }
}

TEST(SurfacePlanner, KeepsTheCornersOfACharacterOnTheSlantedBox) {
  // Song 2015, 6.2: characters on a plane slanted by 15 deg.
  const auto box = geometry::read_stl(UNDERSTUDY_SOURCE_DIR "/models/parts/slanted_box.stl");
  const auto on_top = [](double x, double y) { return Vec3(x, y, 18e-3 - x * std::tan(15 * kDegree)); };
  const std::vector<Vec3> u = {on_top(-0.01, 0.01), on_top(0.01, 0.01), on_top(0.01, -0.01),
                               on_top(-0.01, -0.01)};
  const Program program = plan_surface(*box, u, plan());
  const Vec3 normal(std::sin(15 * kDegree), 0, std::cos(15 * kDegree));
  std::vector<double> miss(u.size(), 1);
  for (const Step& s : program.steps) {
    if (s.kind != StepKind::print && s.kind != StepKind::move) continue;
    EXPECT_LT((tool_axis(s.X_WT) - normal).norm(), 1e-6);  // single precision of the STL
    EXPECT_NEAR(normal.dot(s.X_WT.translation() - u[0]), plan().gap, 1e-8);
    for (std::size_t i = 0; i < u.size(); ++i)
      miss[i] = std::min(miss[i], (s.X_WT.translation() - plan().gap * normal - u[i]).norm());
  }
  for (const double m : miss) EXPECT_LT(m, 1e-8);
}

std::string rejection(const Mesh& mesh, const std::vector<Vec3>& curve, const SurfacePlan& p) {
  try {
    plan_surface(mesh, curve, p);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SurfacePlanner, ASharpEdgeIsRefusedAndARoundOneIsFollowed) {
  const Mesh box = mesh_of(geometry::box(Vec3(-0.02, -0.02, 0), Vec3(0.02, 0.02, 0.01)));
  const std::vector<Vec3> over_the_edge = {Vec3(0.01, 0, 0.01), Vec3(0.02, 0, 0.01), Vec3(0.02, 0, 0.005)};
  SurfacePlan p = plan();
  p.tilt_max = 100 * kDegree;
  EXPECT_THAT(rejection(box, over_the_edge, p),
              HasSubstr("crosses a sharp edge at (20.000, 0.000, 10.000) mm: the normals of neighbours are "
                        "90.0 deg apart, more than 20 deg"));
  // Radius 1 mm is small for steps of 0.5 mm, yet smooth.
  Triangles t = geometry::cylinder(1e-3, 0.02, 360);
  for (Vec3& v : t.vertices) v = Vec3(v.x(), -v.z(), v.y());
  const std::vector<Vec3> round = {Vec3(-1e-3, 0, 0.2e-3), Vec3(0, 0, 1e-3), Vec3(1e-3, 0, 0.2e-3)};
  EXPECT_EQ(rejection(mesh_of(t), round, p), "accepted");
}

TEST(SurfacePlanner, ACurveOffThePartOrAcrossAHoleIsRefused) {
  const Mesh box = mesh_of(geometry::box(Vec3(-0.02, -0.02, 0), Vec3(0.02, 0.02, 0.01)));
  EXPECT_THAT(
      rejection(box, {Vec3(0, 0, 0.01), Vec3(0, 0, 0.0162)}, plan()),
      HasSubstr(
          "point 2 of the curve, (0.000, 0.000, 16.200) mm, is 6.200 mm from the part, more than 5 mm"));
  EXPECT_THAT(rejection(box, {Vec3(-0.024, 0, 0.01), Vec3(0.024, 0, 0.017), Vec3(0.01, 0, 0.014)}, plan()),
              HasSubstr("mm from the part"));
  EXPECT_THAT(rejection(box, {Vec3(0, 0, 0.01), Vec3(0, 0, 0.01)}, plan()), HasSubstr("1 points apart"));
  EXPECT_THAT(rejection(box, {Vec3(0, 0, 0.01)}, plan()), HasSubstr("needs 2"));
  EXPECT_THAT(rejection(box, {Vec3(0, 0, 0.01), Vec3(0, std::nan(""), 0.01)}, plan()),
              HasSubstr("point 2 of the curve is not finite"));
  Triangles two = geometry::box(Vec3(-0.02, -0.02, 0), Vec3(-0.002, 0.02, 0.01));
  const Triangles other = geometry::box(Vec3(0.002, -0.02, 0), Vec3(0.02, 0.02, 0.01));
  for (const auto& v : other.vertices) two.vertices.push_back(v);
  for (const auto& x : other.triangles) two.triangles.push_back({x[0] + 8, x[1] + 8, x[2] + 8});
  EXPECT_THAT(rejection(mesh_of(two), {Vec3(-0.01, 0, 0.0101), Vec3(0.01, 0, 0.0101)}, plan()),
              ::testing::AnyOf(HasSubstr("jumps by 4.000 mm"), HasSubstr("sharp edge")));
}

TEST(SurfacePlanner, EveryValueOfThePlanIsChecked) {
  const Mesh box = mesh_of(geometry::box(Vec3(-0.02, -0.02, 0), Vec3(0.02, 0.02, 0.01)));
  const std::vector<Vec3> line = {Vec3(0, 0, 0.01), Vec3(0.01, 0, 0.01)};
  ASSERT_EQ(rejection(box, line, plan()), "accepted");
  using Field = double SurfacePlan::*;
  const std::pair<Field, const char*> fields[] = {{&SurfacePlan::gap, "gap"},
                                                  {&SurfacePlan::standoff, "standoff"},
                                                  {&SurfacePlan::clearance, "clearance"},
                                                  {&SurfacePlan::step, "step"},
                                                  {&SurfacePlan::chord_tolerance, "chord tolerance"},
                                                  {&SurfacePlan::feed, "feed"},
                                                  {&SurfacePlan::approach_feed, "approach feed"},
                                                  {&SurfacePlan::bead_width, "bead width"},
                                                  {&SurfacePlan::bead_height, "bead height"},
                                                  {&SurfacePlan::filament_diameter, "filament diameter"},
                                                  {&SurfacePlan::tilt_max, "largest tilt"}};
  for (const auto& [field, name] : fields) {
    for (const double bad : {0.0, -1e-3, std::nan(""), std::numeric_limits<double>::infinity()}) {
      SurfacePlan p = plan();
      p.*field = bad;
      EXPECT_THAT(rejection(box, line, p), ::testing::StartsWith(std::string(name) + " is ")) << bad;
    }
  }
  SurfacePlan p = plan();
  p.clearance = 1e-3;
  EXPECT_THAT(rejection(box, line, p), HasSubstr("clearance is 1 mm, less than the standoff of 2 mm"));
  p = plan();
  p.bead_height = 0.6e-3;
  EXPECT_THAT(rejection(box, line, p), HasSubstr("bead width is 0.5 mm, less than its height of 0.6 mm"));
  p = plan();
  p.fan = 1.1;
  EXPECT_THAT(rejection(box, line, p), HasSubstr("fan is 1.1, outside 0 to 1"));
  p = plan();
  p.temperature = -1;
  EXPECT_THAT(rejection(box, line, p), HasSubstr("temperature is -1 K"));
}

}  // namespace
}  // namespace understudy::toolpath
