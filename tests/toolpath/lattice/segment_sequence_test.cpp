#include "toolpath/lattice/segment_sequence.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "models/parts/block_part.h"
#include "tests/told_progress.h"
#include "tests/toolpath/lattice/arm_tool.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/lattice/lattice_planner.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

using test::depth_in_tool;
using test::kDiameter;

constexpr double kStrut = 5e-3;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

LatticePlan plan() { return test::plan(90 * kDegree); }

SegmentLattice lattice_of(const Cubes& cubes, double turn_deg = 0) {
  SegmentLattice segments = segment_lattice(segment_part(*block_part(cubes, 5), kStrut));
  turn(segments, turn_deg * kDegree);
  place_lattice(segments.lattice, 1, Vec3(0, 0, 0.5 * kDiameter));
  return segments;
}

// Along the whole program, travel included: no point of a printed strut is in the tool but at the node that
// it works on, and no part of the tool below the table.
void expect_clear(const SegmentLattice& segments, const LatticeProgram& result) {
  const Lattice& lattice = segments.lattice;
  std::vector<int> built;
  std::size_t next = 0;
  const auto& steps = result.program.steps;
  for (std::size_t i = 3; i < steps.size(); ++i) {
    if (!moves(steps[i])) continue;
    for (int k = 0; k <= 10; ++k) {
      const Pose X_WT = interpolate(steps[i - 1].X_WT, steps[i].X_WT, k / 10.0), X_TW = X_WT.inverse();
      const Vec3 axis = X_WT.linear().col(2);
      const double level = std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
      ASSERT_GT(X_WT.translation().z() + 24e-3 * axis.z() - 22e-3 * level, 0) << "the extruder in the table";
      for (const int s : built) {
        const Vec3 a = lattice.nodes[at(lattice.struts[at(s)][0])].position;
        const Vec3 b = lattice.nodes[at(lattice.struts[at(s)][1])].position;
        for (int j = 0; j <= 16; ++j) {
          const Vec3 p_T = X_TW * Vec3(a + (b - a) * j / 16.0);
          if (p_T.norm() < 1.1e-3) continue;
          ASSERT_LT(depth_in_tool(p_T, 0.5 * kDiameter), 1e-5) << "step " << i << ", strut " << s;
        }
      }
    }
    if (steps[i].kind == StepKind::print) built.push_back(result.sequence.prints[next++].strut);
  }
  EXPECT_EQ(built.size(), lattice.struts.size());
}

TEST(SegmentSequence, FiveDirectionsArePrintedInThePapersOrderAndNothingIsRunInto) {
  const SegmentLattice segments = lattice_of(column_with_arms());
  const LatticeProgram result = plan_segments(segments, plan());
  ASSERT_EQ(result.sequence.prints.size(), 132u);
  std::size_t n = 0;
  for (const SegmentOrder& segment : segments.segments)
    for (std::size_t k = 0; k < segment.struts.size(); ++k, ++n) {
      const StrutPrint& print = result.sequence.prints[n];
      EXPECT_EQ(print.strut, segment.struts[k].strut);
      EXPECT_EQ((print.axis - axis_of(segment.direction)).norm(), 0);
    }
  expect_clear(segments, result);
}

// Ishak 2018: 1 mm/s, 75 mm/s between (a machine's own, G0), the volume of 0.48 mm. What G-code says is what
// was meant.
TEST(SegmentSequence, GcodeReadsBackToThePosesFeedsAndVolumes) {
  const LatticeProgram result = plan_segments(lattice_of(column_with_arms(), 45), plan());
  const Program read = parse_gcode(write_gcode(result.program, {}), "lattice.gcode", {});
  const auto moving = [](const Program& program) {
    std::vector<Step> steps;
    std::copy_if(program.steps.begin(), program.steps.end(), std::back_inserter(steps),
                 [](const Step& s) { return moves(s); });
    return steps;
  };
  const std::vector<Step> meant = moving(result.program), said = moving(read);
  ASSERT_EQ(meant.size(), said.size());
  constexpr double kFilamentArea = std::numbers::pi / 4 * 1.75e-3 * 1.75e-3;
  double drawn = 0, volume = 0;
  for (std::size_t i = 0; i < said.size(); ++i) {
    EXPECT_LT((meant[i].X_WT.translation() - said[i].X_WT.translation()).norm(), 1e-6) << i;
    EXPECT_LT(angle_between(meant[i].X_WT.linear(), said[i].X_WT.linear()), 1e-6) << i;
    EXPECT_EQ(meant[i].kind, said[i].kind) << i;
    if (said[i].kind != StepKind::print) continue;
    EXPECT_NEAR(said[i].feed, 1e-3, 1e-9);
    drawn += (said[i].X_WT.translation() - said[i - 1].X_WT.translation()).norm();
    volume += said[i].filament * kFilamentArea;
  }
  EXPECT_NEAR(volume / drawn / (std::numbers::pi / 4 * kDiameter * kDiameter), 1, 1e-5);
}

TEST(SegmentSequence, BetweenSegmentsTheToolIsUprightAboveAllThatIsPrinted) {
  const SegmentLattice segments = lattice_of(column_with_arms());
  const LatticeProgram result = plan_segments(segments, plan());
  int transitions = 0;
  const auto& prints = result.sequence.prints;
  for (std::size_t n = 0; n < prints.size(); ++n) {
    const bool first = n == 0 || (prints[n].axis - prints[n - 1].axis).norm() > 1e-9;
    EXPECT_EQ(prints[n].arrival.empty(), !first);
    if (!first) continue;
    ++transitions;
    const Pose& above = prints[n].arrival.front();
    EXPECT_NEAR(above.linear()(2, 2), 1, 1e-12);
    for (std::size_t k = 0; k < n; ++k)
      EXPECT_GT(above.translation().z(), std::max(prints[k].tip_from.z(), prints[k].tip_to.z()));
  }
  EXPECT_EQ(transitions, 5);
}

TEST(SegmentSequence, TravelGoesAcrossAtTheHeightOfTheFartherEnd) {
  StrutPrint last, next;
  last.axis = next.axis = Vec3::UnitY();
  last.tip_to = Vec3(0, 1, 5);
  last.out_to = 2;
  next.tip_from = Vec3(4, 6, 5);
  next.out_from = 1;
  const auto expect = [](const std::vector<Pose>& way, const std::vector<Vec3>& tips) {
    ASSERT_EQ(way.size(), tips.size());
    for (std::size_t i = 0; i < tips.size(); ++i)
      EXPECT_NEAR((way[i].translation() - tips[i]).norm(), 0, 1e-12) << i;
  };
  expect(level_travel(last, next), {{0, 3, 5}, {0, 7, 5}, {4, 7, 5}, {4, 7, 5}});
  next.tip_from.y() = 0;
  expect(level_travel(last, next), {{0, 3, 5}, {0, 3, 5}, {4, 3, 5}, {4, 1, 5}});
}

TEST(SegmentSequence, RefusesWhatTheToolRunsIntoAndSaysWhere) {
  const auto refusal = [](const Cubes& cubes, const LatticePlan& with) -> std::string {
    try {
      plan_segments(lattice_of(cubes), with);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  // An arm 15 mm above the table: the extruder, on its side, is 22 mm x sqrt(2) thick below its axis.
  Cubes low;
  add_block(low, {0, 0, 0}, {1, 1, 4});
  add_block(low, {1, 0, 3}, {2, 1, 4});
  EXPECT_THAT(refusal(low, plan()),
              HasSubstr("segment X+ begins 15.240 mm above the table; a tool along X+ needs 31.2"));
  // A nozzle 4 mm high below a wide block: struts beside the one that rises are in the block.
  LatticePlan stubby = plan();
  stubby.limits.tool[0].form = geometry::Frustum{0.5e-3, 1.5e-3, 4e-3};
  stubby.limits.tool[1].X_FS = make_pose(Quat::Identity(), Vec3(0, 0, 9e-3));
  EXPECT_THAT(refusal(column_with_arms(), stubby), HasSubstr("segment Z+, strut from"));
  EXPECT_THAT(refusal(column_with_arms(), stubby), HasSubstr("mm, the limit is 0.100 mm"));
  // Travel 0.01 mm above what stands, of which 0.1 mm are to be kept.
  LatticePlan close = plan();
  close.limits.lift = 0.01e-3;
  EXPECT_THAT(refusal(column_with_arms(), close), HasSubstr("on the way to it the tool comes to 0.0"));
  // A machine that cannot lie its tool down.
  LatticePlan upright = plan();
  upright.limits.way = [](const std::vector<Pose>& way, bool) {
    return std::any_of(way.begin(), way.end(), [](const Pose& p) { return p.linear()(2, 2) < 0.5; })
               ? std::string("the wrist does not bend")
               : std::string();
  };
  EXPECT_THAT(refusal(column_with_arms(), upright), HasSubstr("segment Y-, strut from"));
  EXPECT_THAT(refusal(column_with_arms(), upright), HasSubstr("the wrist does not bend"));
  // One that follows every piece of the way but not the whole: it is asked for the program, and the strut is
  // found.
  LatticePlan tired = plan();
  tired.limits.way = [](const std::vector<Pose>& way, bool) {
    return way.size() > 100 ? std::string("tired") : std::string();
  };
  EXPECT_THAT(refusal(column_with_arms(), tired), HasSubstr("segment Z+, strut from"));
  EXPECT_THAT(refusal(column_with_arms(), tired), HasSubstr(": tired;"));
}

// Bases of 1 to 3 cubes a side with an arm of random size on up to four sides, high enough for the tool.
TEST(SegmentSequence, RandomBlocksAreRunIntoNowhere) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](int low, int high) {
      return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
    };
    const int nx = pick(1, 3), ny = pick(1, 2), nz = pick(8, 9);
    Cubes cubes;
    add_block(cubes, {0, 0, 0}, {nx, ny, nz});
    for (int side = 0; side < 4; ++side) {
      if (pick(0, 3) == 0) continue;
      const int out = pick(1, 2), z = pick(7, nz - 1), z1 = pick(z + 1, nz);
      const int across = side < 2 ? nx : ny, a = pick(0, across - 1), b = pick(a + 1, across);
      if (side == 0) add_block(cubes, {a, -out, z}, {b, 0, z1});
      if (side == 1) add_block(cubes, {a, ny, z}, {b, ny + out, z1});
      if (side == 2) add_block(cubes, {-out, a, z}, {0, b, z1});
      if (side == 3) add_block(cubes, {nx, a, z}, {nx + out, b, z1});
    }
    SCOPED_TRACE(seed);
    const SegmentLattice segments = lattice_of(cubes);
    expect_clear(segments, plan_segments(segments, plan()));
  }
}

TEST(SegmentSequence, TellsEachStrut) {
  const SegmentLattice segments = lattice_of({{0, 0, 0}, {0, 0, 1}});
  understudy::test::ToldProgress told;
  LatticePlan told_plan = plan();
  told_plan.limits.progress = told.teller();
  plan_segments(segments, told_plan);
  EXPECT_EQ(told.times(), segments.lattice.struts.size());
  told.expect_even(1.01 / static_cast<double>(segments.lattice.struts.size()));
}

}  // namespace
}  // namespace understudy::toolpath
