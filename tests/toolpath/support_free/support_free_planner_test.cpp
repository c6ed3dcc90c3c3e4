#include "toolpath/support_free/support_free_planner.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "models/parts/block_part.h"
#include "tests/told_progress.h"
#include "tests/toolpath/support_free/bent_parts_for_test.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using testing::HasSubstr;

SupportFreePlan coarse() {
  SupportFreePlan plan;
  plan.range = {0.4e-3, 0.15e-3, 0.65e-3, 20 * kDegree};
  plan.bead_width = 0.9e-3;
  plan.feed = 12e-3;
  plan.approach_feed = 3e-3;
  plan.clearance = 2e-3;
  plan.filament_diameter = 1.75e-3;
  plan.temperature = 478;
  return plan;
}

/// [m], after the first bead, without the last retreat.
double moved_without_filament(const Program& program) {
  double moved = 0;
  Vec3 tip = Vec3::Zero();
  bool printed = false;
  for (const Step& step : program.steps) {
    if (!moves(step)) continue;
    const Vec3 next = step.X_WT.translation();
    if (printed && step.kind == StepKind::move) moved += (next - tip).norm();
    printed = printed || step.kind == StepKind::print;
    tip = next;
  }
  return moved;
}

class SupportFree : public testing::TestWithParam<Bent> {};

/// A bead of the section's area is as much material as the part; Pappus: area times the axis' length.
TEST_P(SupportFree, LaysThePartInOnePathWithoutTravel) {
  const auto& [name, outline, pieces] = GetParam();
  const auto part = swept_part(outline, pieces);
  const SupportFreePlan plan = coarse();
  const auto result = plan_support_free(*part, find_structural_line(*part, 1e-3, 20e-6), plan);
  EXPECT_EQ(result.travels, 0);
  // From contour to lines, and from the last line up to the next layer's contour: two beads' width each.
  EXPECT_LT(moved_without_filament(result.program), result.layers * 4 * 0.9e-3);
  EXPECT_EQ(result.layers, std::lround(swept_length(pieces) / 0.4e-3));
  EXPECT_NEAR(result.volume / part->volume(), 1, 0.04);
  EXPECT_LT(result.lag_max, 0.1 * kDegree);
  const Vec3 end = swept_pose(pieces, swept_length(pieces)).linear().col(2);
  EXPECT_GT(result.tilt_max, turn_between(end, Vec3::UnitZ()) - 1 * kDegree);
  // Only the way to the first bead and away from the last are travels.
  std::size_t first = 0, last = 0;
  for (std::size_t i = 0; i < result.program.steps.size(); ++i)
    if (result.program.steps[i].filament > 0) last = i, first = first == 0 ? i : first;
  for (std::size_t i = first; i <= last; ++i) EXPECT_NE(result.program.steps[i].kind, StepKind::travel) << i;
}

/// Under every place that is printed there is the part, not farther away than the layer is high and a bead's
/// width beside the outline: nothing overhangs, however far the part does.
TEST_P(SupportFree, EveryBeadLiesOnTheLayerBelow) {
  const auto& [name, outline, pieces] = GetParam();
  const auto part = swept_part(outline, pieces);
  const SupportFreePlan plan = coarse();
  const auto result = plan_support_free(*part, find_structural_line(*part, 1e-3, 20e-6), plan);
  int looked_at = 0;
  for (const Step& step : result.program.steps) {
    if (step.filament <= 0) continue;
    const Vec3 tip = step.X_WT.translation(), axis = step.X_WT.linear().col(2);
    // The middle of the layer below.
    const Vec3 below = tip - 0.6e-3 * axis;
    if (below.z() < 0.4e-3) continue;
    ++looked_at;
    EXPECT_LT(part->signed_distance(below), 0.05e-3) << below.transpose();
  }
  EXPECT_GT(looked_at, 1000);
}

/// The same part in level layers overhangs: the check above can fail.
TEST(SupportFreeCheck, LevelLayersOverhang) {
  const auto pieces = one_bend();
  const auto part = swept_part(circle_mm(6), pieces);
  double farthest = 0;
  for (double z = 35e-3; z < 40e-3; z += 0.4e-3) {
    SectionFrame level;
    level.origin = swept_pose(pieces, 44e-3).translation();
    level.origin.z() = z;
    const auto section = section_at(*part, level);
    if (!section) continue;
    for (const Vec2& q : section->contours.front())
      farthest = std::max(farthest, part->signed_distance(level.out(q) - Vec3(0, 0, 0.6e-3)));
  }
  EXPECT_GT(farthest, 0.3e-3);
}

TEST_P(SupportFree, ContoursOfNeighbouringLayersBeginAtOppositeEnds) {
  const auto& [name, outline, pieces] = GetParam();
  const auto part = swept_part(outline, pieces);
  const auto result = plan_support_free(*part, find_structural_line(*part, 1e-3, 20e-6), coarse());
  // A layer begins where the tool's axis, or on straight pieces the height along it, changes without
  // filament.
  std::vector<Vec3> starts;
  for (std::size_t i = 1; i < result.program.steps.size(); ++i) {
    const Step &before = result.program.steps[i - 1], &step = result.program.steps[i];
    if (step.filament > 0 && before.filament <= 0) starts.push_back(before.X_WT.translation());
  }
  // Contour and filling: two strokes a layer.
  ASSERT_EQ(starts.size(), 2u * static_cast<std::size_t>(result.layers));
  for (std::size_t k = 2; k + 1 < starts.size(); k += 2)
    EXPECT_GT((starts[k] - starts[k - 2]).norm(), 8e-3) << k / 2;
}

TEST_P(SupportFree, WhatIsWrittenIsReadBack) {
  const auto& [name, outline, pieces] = GetParam();
  const auto part = swept_part(outline, pieces);
  const auto result = plan_support_free(*part, find_structural_line(*part, 1e-3, 20e-6), coarse());
  const Program back = parse_gcode(write_gcode(result.program, {}), "p.gcode", {});
  ASSERT_EQ(back.steps.size(), result.program.steps.size());
  for (std::size_t i = 0; i < back.steps.size(); ++i) {
    if (!moves(back.steps[i])) continue;
    const Pose &a = back.steps[i].X_WT, &b = result.program.steps[i].X_WT;
    EXPECT_LT((a.translation() - b.translation()).norm(), 1e-6);
    EXPECT_LT(angle_between(a.linear(), b.linear()), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Han, SupportFree, testing::ValuesIn(bent_parts()), name_of_part);

std::string refusal(const geometry::Mesh& part, const StructuralLine& line, const SupportFreePlan& plan) {
  try {
    plan_support_free(part, line, plan);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SupportFreeRefusals, NameValueAndLimit) {
  const auto part = swept_part(circle_mm(6), one_bend());
  const StructuralLine line = find_structural_line(*part, 1e-3, 20e-6);
  SupportFreePlan plan = coarse();
  plan.walls = 0;
  EXPECT_THAT(refusal(*part, line, plan), HasSubstr("number of walls"));
  plan = coarse();
  plan.bead_width = 0.3e-3;
  EXPECT_NE(refusal(*part, line, plan), "");
  plan = coarse();
  plan.bead_width = 13e-3;
  plan.range.layer = 0.4e-3;
  EXPECT_THAT(refusal(*part, line, plan), HasSubstr("no room for a bead of 13 mm"));
  const auto raised = swept_part(circle_mm(6), one_bend(), 0.5e-3, {0, 0, 2e-3});
  EXPECT_THAT(refusal(*raised, line, coarse()), HasSubstr("z = 2.000 mm, it must stand on the table"));
}

/// A stem, and two legs that lean apart.
std::shared_ptr<geometry::Mesh> forked_part() {
  // A prism along y: the outline of a Y in x and z [mm].
  const std::vector<Vec2> outline{{-4, 0}, {4, 0},    {4, 10},   {20, 30}, {12, 30},
                                  {0, 15}, {-12, 30}, {-20, 30}, {-4, 10}};
  const std::vector<std::array<int, 3>> faces{{0, 1, 2}, {0, 2, 8}, {2, 3, 4}, {2, 4, 5},
                                              {8, 5, 6}, {8, 6, 7}, {8, 2, 5}};
  const int n = static_cast<int>(outline.size());
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (const double y : {-4.0, 4.0})
    for (const Vec2& p : outline) vertices.push_back(1e-3 * Vec3(p.x(), y, p.y()));
  for (const auto& [a, b, c] : faces) {
    triangles.push_back({a, b, c});
    triangles.push_back({n + a, n + c, n + b});
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    triangles.push_back({i, n + i, n + j});
    triangles.push_back({i, n + j, j});
  }
  return std::make_shared<geometry::Mesh>(std::move(vertices), std::move(triangles));
}

TEST(SupportFreeRefusals, APartThatForks) {
  const auto part = forked_part();
  EXPECT_THAT(refusal(*part, find_structural_line(*part, 1e-3, 20e-6), coarse()),
              HasSubstr("the part has branches"));
}

/// A T of cubes of 5 mm: the middles of its sections lie on one line, but its bar follows none.
TEST(SupportFreeRefusals, APartThatGrowsOverItsOwnEdge) {
  Cubes cubes;
  add_block(cubes, {0, 0, 0}, {1, 1, 4});
  add_block(cubes, {-3, 0, 4}, {4, 1, 6});
  const auto part = block_part(cubes, 5);
  EXPECT_THAT(refusal(*part, find_structural_line(*part, 1e-3, 20e-6), coarse()),
              HasSubstr("stands 15.00 mm over the edge of the one below"));
}

/// A line up to the middle of the part only.
TEST(SupportFreeRefusals, PartsThatTheLayersDoNotHold) {
  const auto part = swept_part(circle_mm(6), one_bend());
  std::vector<Vec3> half;
  for (int i = 0; i <= 20; ++i) half.push_back(swept_pose(one_bend(), i * 1e-3).translation());
  EXPECT_THAT(refusal(*part, StructuralLine(half), coarse()),
              HasSubstr("% of the part's volume, less than 90 %"));
}

TEST_P(SupportFree, TellsHowFarEachStageIs) {
  const auto& [name, outline, pieces] = GetParam();
  const auto part = swept_part(outline, pieces);
  understudy::test::ToldProgress line_told, layers_told;
  const auto line = find_structural_line(*part, 1e-3, 20e-6, line_told.teller());
  EXPECT_EQ(line_told.stages(), (std::set<std::string>{"finding the part's line", "smoothing the line"}));
  SupportFreePlan plan = coarse();
  plan.progress = layers_told.teller();
  plan_support_free(*part, line, plan);
  EXPECT_EQ(layers_told.stages(), (std::set<std::string>{"cutting layers", "filling the layers"}));
  layers_told.expect_even(0.05);  // of a hundred layers, each twice
}

}  // namespace
}  // namespace understudy::toolpath
