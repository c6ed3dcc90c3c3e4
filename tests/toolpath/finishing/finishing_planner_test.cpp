#include "toolpath/finishing/finishing_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "geometry/inflated.h"
#include "tests/geometry/test_solids.h"
#include "tests/told_progress.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;
using geometry::Triangles;
using ::testing::HasSubstr;

std::shared_ptr<const Mesh> mesh_of(const Triangles& t) {
  return std::make_shared<Mesh>(t.vertices, t.triangles);
}
std::shared_ptr<const Mesh> box_mm(const Vec3& lower, const Vec3& upper) {
  return mesh_of(geometry::box(from_mm(1) * lower, from_mm(1) * upper));
}

FinishingPlan plan_of() {
  FinishingPlan plan;
  plan.depth = from_mm(0.7);
  plan.mill_radius = from_mm(1.5);
  plan.rings = {{"nut", from_mm(9.5), from_mm(30), from_mm(50)}};
  plan.pitch = from_mm(2);
  plan.from = from_mm(12), plan.to = from_mm(18);
  plan.step = from_mm(0.5);
  plan.fit_reach = from_mm(0.25);
  plan.feed = from_mm(20), plan.approach_feed = from_mm(5);
  plan.clearance = from_mm(4);
  return plan;
}

const auto kTable = box_mm(Vec3(-90, -90, -10), Vec3(90, 90, 0));

FinishingProgram planned(const Mesh& part, const FinishingPlan& plan) {
  return plan_finishing(part, *geometry::inflated(part, plan.depth), *kTable, plan);
}

std::string refusal(const Mesh& part, const FinishingPlan& plan) {
  try {
    (void)planned(part, plan);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// A prism over a plus of 12 corners: 60 mm across, arms 20 mm wide, edges sharp.
std::shared_ptr<const Mesh> plus() {
  const std::vector<Vec2> outline = {{30, -10}, {30, 10},   {10, 10},   {10, 30},   {-10, 30}, {-10, 10},
                                     {-30, 10}, {-30, -10}, {-10, -10}, {-10, -30}, {10, -30}, {10, -10}};
  Triangles t;
  const int n = static_cast<int>(outline.size());
  for (const double z : {0.0, 20.0}) {
    for (const Vec2& p : outline) t.vertices.push_back(from_mm(1) * Vec3(p.x(), p.y(), z));
    t.vertices.push_back(from_mm(1) * Vec3(0, 0, z));
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n, top = n + 1;
    for (const auto& triangle : {std::array{i, j, top + j}, std::array{i, top + j, top + i},
                                 std::array{n, j, i}, std::array{top + n, top + i, top + j}})
      t.triangles.push_back(triangle);
  }
  return mesh_of(t);
}

/// Every cutting pose: the end mill's face is on the part, its axis the side's normal, and nothing of the
/// part is within the mill.
void expect_on_the_sides(const Mesh& part, const Program& program) {
  int cuts = 0;
  for (const Step& step : program.steps) {
    if (step.kind != StepKind::move) continue;
    ++cuts;
    const Vec3 n = step.X_WT.linear().col(2), p = step.X_WT.translation();
    EXPECT_NEAR(part.signed_distance(p), 0, 1e-9);
    EXPECT_NEAR(n.z(), 0, 1e-9);
    for (int k = 0; k < 16; ++k) {
      const double turn = k * 0.3927;
      const Vec3 rim = p + from_mm(1.5) * (std::cos(turn) * step.X_WT.linear().col(0) +
                                           std::sin(turn) * step.X_WT.linear().col(1));
      EXPECT_GE(part.signed_distance(rim), -1e-9) << p.transpose();
    }
  }
  EXPECT_GT(cuts, 100);
}

TEST(FinishingPlanner, GoesRoundABoxOnItsNormals) {
  const auto part = box_mm(Vec3(-20, -15, 0), Vec3(20, 15, 20));
  const auto result = planned(*part, plan_of());
  EXPECT_EQ(result.layers, 4);  // 12, 14, 16, 18
  EXPECT_EQ(result.left_out, 0);
  EXPECT_EQ(result.lift_max, 0);
  EXPECT_NEAR(to_mm(result.length), 4 * 140, 1e-6);
  expect_on_the_sides(*part, result.program);
}

TEST(FinishingPlanner, LeavesOutWhatAFlatFaceCannotReach) {
  const auto part = plus();
  FinishingPlan plan = plan_of();
  const auto result = planned(*part, plan);
  EXPECT_GT(result.left_out, 0);
  expect_on_the_sides(*part, result.program);
  // In each of four inner corners a radius of either side stays, but for one step.
  EXPECT_NEAR(to_mm(result.length), 4 * (240 - 8 * 1.5), 4 * 8 * 0.5);
}

TEST(FinishingPlanner, ReadsBackToTheSamePoses) {
  const auto part = mesh_of(geometry::cylinder(from_mm(15), from_mm(60), 90));
  const auto program = planned(*part, plan_of()).program;
  const Program read = parse_gcode(write_gcode(program, {}), "finishing.gcode", {});
  ASSERT_EQ(read.steps.size(), program.steps.size());
  for (std::size_t i = 0; i < read.steps.size(); ++i) {
    EXPECT_LE((read.steps[i].X_WT.translation() - program.steps[i].X_WT.translation()).norm(), 1e-6);
    EXPECT_LE(angle_between(read.steps[i].X_WT.linear(), program.steps[i].X_WT.linear()), 1e-6);
    EXPECT_NEAR(read.steps[i].feed, program.steps[i].feed, 1e-9);
    EXPECT_EQ(read.steps[i].filament, 0);
  }
}

TEST(FinishingPlanner, TravelStaysOutsideOfTheStock) {
  const auto part = plus();
  const auto stock = geometry::inflated(*part, from_mm(0.7));
  Pose before = Pose::Identity();
  bool first = true;
  for (const Step& step : planned(*part, plan_of()).program.steps) {
    if (step.kind == StepKind::travel && !first)
      for (int k = 1; k < 40; ++k) {
        const Pose X = interpolate(before, step.X_WT, k / 40.0);
        // On the way out of the part the mill leaves its own cut.
        for (const double along : {0.0, from_mm(10), from_mm(29)})
          EXPECT_GE(stock->signed_distance(X.translation() + along * X.linear().col(2)),
                    -from_mm(0.7) - 1e-9);
      }
    before = step.X_WT, first = false;
  }
}

TEST(FinishingPlanner, RefusesWhatCannotBeMilled) {
  const auto part = box_mm(Vec3(-20, -15, 0), Vec3(20, 15, 20));
  const auto with = [&](auto change) {
    FinishingPlan plan = plan_of();
    change(plan);
    return refusal(*part, plan);
  };
  EXPECT_THAT(with([](auto& p) { p.depth = from_mm(3.1); }),
              HasSubstr("more than the end mill's diameter of 3 mm"));
  EXPECT_THAT(with([](auto& p) { p.pitch = from_mm(3); }), HasSubstr("leave ribs"));
  EXPECT_THAT(with([](auto& p) { p.from = from_mm(19); }), HasSubstr("is above the highest"));
  EXPECT_THAT(with([](auto& p) { p.from = p.to = from_mm(25); }), HasSubstr("nothing to cut"));
  EXPECT_THAT(with([](auto& p) { p.from = from_mm(9); }), HasSubstr("the nut would reach"));
  EXPECT_THAT(with([](auto& p) { p.from = from_mm(9); }), HasSubstr("into the table"));
  EXPECT_THAT(with([](auto& p) { p.feed = 0; }), HasSubstr("feed is 0 mm/min"));
  // In the inner corner of the plus the nut comes upon the other arm.
  FinishingPlan plan = plan_of();
  plan.rings[0].from = from_mm(15);
  EXPECT_THAT(refusal(*plus(), plan), HasSubstr("into the part: it needs a longer end mill"));
}

TEST(FinishingPlanner, TellsEachLayer) {
  understudy::test::ToldProgress told;
  FinishingPlan plan = plan_of();
  plan.progress = told.teller();
  planned(*box_mm(Vec3(-20, -15, 0), Vec3(20, 15, 20)), plan);
  EXPECT_EQ(told.times(), 4u);  // 12, 14, 16, 18
  told.expect_even(0.2501);
}

}  // namespace
}  // namespace understudy::toolpath
