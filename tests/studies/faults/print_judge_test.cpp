#include "studies/faults/print_judge.h"

#include <functional>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "studies/faults/faulted_prints.h"

namespace understudy::studies {
namespace {

using rehearsal::Record;
using rehearsal::TracePoint;

constexpr PrintTolerances kAllowed{0.2e-3, 2 * kDegree, 0.1e-3, 0.2e-3, 0.07e-3, 0.4e-3};
constexpr double kLength = 10e-3, kGap = 0.13e-3, kFilament = 0.5e-3;  // [m], of one bead
constexpr int kPoints = 1000;                                          // of a bead's trace

/// Down to the table, 10 mm along x on line 3, and the same again a layer higher on line 6.
toolpath::Program program(int layers, double height = kGap) {
  toolpath::Program program;
  for (int layer = 0; layer < layers; ++layer) {
    const double z = height * (layer + 1);
    toolpath::Step step;
    step.line = 3 * layer + 2;
    step.kind = toolpath::StepKind::move;
    step.X_WT = make_pose(Quat::Identity(), Vec3(0, 0, z));
    program.steps.push_back(step);
    step.line = 3 * layer + 3;
    step.kind = toolpath::StepKind::print;
    step.X_WT = make_pose(Quat::Identity(), Vec3(kLength, 0, z));
    step.filament = kFilament;
    program.steps.push_back(step);
  }
  return program;
}

/// The print as programmed, without a finding; `change` alters each point by how far along its bead it is.
Record record(int layers, const std::function<void(double along, TracePoint&)>& change = {},
              double height = kGap) {
  Record record;
  record.go = true;
  for (int layer = 0; layer < layers; ++layer)
    for (int i = 0; i <= kPoints; ++i) {
      const double along = static_cast<double>(i) / kPoints;
      TracePoint point;
      point.time = layer + along;
      point.line = 3 * layer + 3;
      point.extruding = i > 0;
      point.X_WT = make_pose(Quat::Identity(), Vec3(kLength * along, 0, height * (layer + 1)));
      point.gap = height;
      if (change) change(along, point);
      record.trace.push_back(point);
    }
  record.print.emplace();
  record.print->extruded_mm = record.print->printed_mm = record.print->deposited_mm =
      to_mm(kFilament) * layers;
  return record;
}

PrintTruth judged(const Record& run, int layers = 1) {
  return judge_print(IntendedPrint(program(layers), nullptr, kAllowed), run);
}
std::string flaws(const Record& run, int layers = 1) { return flaw_words(judged(run, layers).flaws); }

bool last_tenth(double along) { return along > 0.9; }

TEST(PrintJudge, APrintAsProgrammedIsGood) {
  EXPECT_EQ(flaws(record(1)), "");
  EXPECT_EQ(flaws(record(2), 2), "");
  EXPECT_NEAR(judged(record(1)).gap_min, kGap, 1e-12);
}

TEST(PrintJudge, AGoOnASpoiltTraceIsSilent) {
  const Record spoilt = record(1, [](double along, TracePoint& point) {
    if (last_tenth(along)) point.gap = 0.25e-3;
  });
  ASSERT_TRUE(spoilt.go);
  ASSERT_TRUE(spoilt.findings.empty());
  EXPECT_EQ(answer_of(spoilt.go, false, judged(spoilt)), PrintAnswer::silent);
  EXPECT_EQ(answer_of(spoilt.go, false, judged(record(1))), PrintAnswer::good_go);
}

TEST(PrintJudge, TheTipMayBeOffByTheToleranceOfTheMachine) {
  const auto moved = [](double by) {
    return record(1, [by](double along, TracePoint& point) {
      if (along > 0.5 && along < 0.51) point.X_WT.translation().y() += by;
    });
  };
  EXPECT_EQ(flaws(moved(0.19e-3)), "");
  EXPECT_EQ(flaws(moved(0.21e-3)), "tip") << "0.1 mm of path";
  EXPECT_NEAR(judged(moved(0.21e-3)).tip_max, 0.21e-3, 1e-9);
  const Record all = record(1, [](double, TracePoint& point) { point.X_WT.translation().y() += 0.3e-3; });
  EXPECT_EQ(flaws(all), "incomplete, tip") << "nothing lies where a bead is wanted";
}

TEST(PrintJudge, ANozzleIsRound) {
  const auto turned = [](const Vec3& by) {
    return record(1, [by](double along, TracePoint& point) {
      if (last_tenth(along)) point.X_WT.linear() = exp_rotation(by);
    });
  };
  EXPECT_EQ(flaws(turned(Vec3(0, 2.1 * kDegree, 0))), "orientation");
  EXPECT_EQ(flaws(turned(Vec3(0, 1.9 * kDegree, 0))), "");
  EXPECT_EQ(flaws(turned(Vec3(0, 0, 50 * kDegree))), "");
}

TEST(PrintJudge, ABeadMayBeOutsideOfTheBandForAShortWay) {
  // From the middle on for `way`; a step of the trace is 10 um.
  const auto off = [](double gap, double way) {
    return flaws(record(1, [=](double along, TracePoint& point) {
      if (along > 0.5 && along * kLength < 0.5 * kLength + way) point.gap = gap;
    }));
  };
  EXPECT_EQ(off(0.09e-3, 0.38e-3), "") << "a bore is 0.4 mm";
  EXPECT_EQ(off(0.09e-3, 0.43e-3), "too low");
  EXPECT_EQ(off(0.21e-3, 0.78e-3), "") << "a bore from either end";
  EXPECT_EQ(off(0.21e-3, 0.83e-3), "too high");
}

// A program's layers need not be as high as the gap that the machine aims at.
TEST(PrintJudge, ABeadMayBeAsFarAboveItsLayerAsAboveTheAim) {
  const auto raised = [](double layer, double gap) {
    const Record run = record(
        2,
        [gap](double along, TracePoint& p) {
          if (last_tenth(along)) p.gap = gap;
        },
        layer);
    return flaw_words(judge_print(IntendedPrint(program(2, layer), nullptr, kAllowed), run).flaws);
  };
  EXPECT_EQ(raised(0.2e-3, 0.26e-3), "");
  EXPECT_EQ(raised(0.2e-3, 0.28e-3), "too high");
  EXPECT_EQ(raised(0.11e-3, 0.19e-3), "") << "within what the file states";
  EXPECT_EQ(raised(0.11e-3, 0.21e-3), "too high");
}

TEST(PrintJudge, OnBeadsANozzleMayComeNearButABeadMayNotHang) {
  const auto second = [](double gap) {
    return record(2, [gap](double along, TracePoint& point) {
      if (point.line == 6 && last_tenth(along)) point.gap = gap;
    });
  };
  EXPECT_EQ(flaws(second(0.08e-3), 2), "") << "it is pressed into what lies there";
  EXPECT_EQ(flaws(second(0.21e-3), 2), "too high");
}

TEST(PrintJudge, WhatIsProgrammedIntoTheAirMayHang) {
  toolpath::Program bridge = program(2);
  for (toolpath::Step& step : bridge.steps)
    if (step.line > 3) step.X_WT.translation().z() += 1e-3;
  const IntendedPrint intended(bridge, nullptr, kAllowed);
  const auto run = [](int from_line) {
    return record(2, [from_line](double, TracePoint& point) {
      if (point.line == 6) point.X_WT.translation().z() += 1e-3;
      if (point.line >= from_line) point.gap = 1e-3;
    });
  };
  EXPECT_EQ(flaw_words(judge_print(intended, run(6)).flaws), "");
  EXPECT_EQ(flaw_words(judge_print(intended, run(3)).flaws), "too high") << "the first lies on the table";
}

TEST(PrintJudge, WhatIsNotLaidIsMissed) {
  Record ended = record(1);
  ended.trace.resize(kPoints / 2);
  EXPECT_EQ(flaws(ended), "incomplete");
  EXPECT_NEAR(judged(ended).missing, kLength / 2 - kAllowed.tip, 0.11e-3) << "by whole places";
  const Record stands = record(1, [](double along, TracePoint& point) {
    if (along > 0.5) point.X_WT.translation().x() = kLength / 2;
  });
  EXPECT_EQ(flaws(stands), "incomplete") << "the filament flows, the tip stands";
  // Beside its neighbour's path, but within the tolerance of its own.
  EXPECT_EQ(flaws(record(1, [](double, TracePoint& point) { point.X_WT.translation().y() += 0.19e-3; })), "");
  Record starved = record(1);
  starved.print->extruded_mm *= 0.9;
  EXPECT_EQ(flaws(starved), "incomplete");
  Record loose = record(1);
  loose.print->deposited_mm *= 0.9;
  EXPECT_EQ(flaws(loose), "loose");
  EXPECT_EQ(flaws({}), "incomplete") << "nothing was simulated";
}

/// One line of the program through these points on the table; the trace goes along it with `gap` of what was
/// gone.
struct Path {
  std::vector<Vec3> points;
  std::function<double(double way, const Vec3& tip)> gap;
};

PrintTruth judged(const Path& path) {
  toolpath::Program program;
  Record run;
  double way = 0;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    toolpath::Step step;
    step.line = static_cast<int>(i) + 1;
    step.kind = i == 0 ? toolpath::StepKind::move : toolpath::StepKind::print;
    step.X_WT = make_pose(Quat::Identity(), path.points[i]);
    step.filament = i == 0 ? 0 : kFilament;
    program.steps.push_back(step);
    if (i == 0) continue;
    const Vec3 from = path.points[i - 1], to = path.points[i];
    for (int k = 1; k <= kPoints; ++k) {
      TracePoint point;
      point.line = step.line;
      point.extruding = true;
      point.X_WT = make_pose(Quat::Identity(), from + static_cast<double>(k) / kPoints * (to - from));
      point.gap = path.gap(way + (point.X_WT.translation() - from).norm(), point.X_WT.translation());
      run.trace.push_back(point);
    }
    way += (to - from).norm();
  }
  run.print.emplace();
  run.scene.emplace();
  run.scene->printed = std::make_shared<sim::Workpiece>(nullptr);
  run.print->extruded_mm = run.print->printed_mm = run.print->deposited_mm =
      to_mm(kFilament) * static_cast<double>(path.points.size() - 1);
  return judge_print(IntendedPrint(program, nullptr, kAllowed), run);
}

TEST(PrintJudge, ANozzleIsNotTooLowOverABeadThatItEndsOn) {
  // Over the last 0.5 mm the gap is that to the bead that the outline began with.
  const auto square = [](double height) {
    return Path{
        {{0, 0, height}, {4e-3, 0, height}, {4e-3, 4e-3, height}, {0, 4e-3, height}, {0, -0.3e-3, height}},
        [=](double way, const Vec3&) { return way > 15.8e-3 ? 0 : height; }};
  };
  EXPECT_EQ(flaw_words(judged(square(kGap)).flaws), "");
}

TEST(PrintJudge, ANozzleIsTooLowNearTheTableWhateverLiesThere) {
  Record low = record(1, [](double along, TracePoint& point) {
    if (along < 0.5 || along > 0.55) return;
    point.X_WT.translation().z() = 0.09e-3;
    point.gap = 0;
  });
  low.scene.emplace();
  low.scene->printed = std::make_shared<sim::Workpiece>(nullptr);
  EXPECT_EQ(flaws(low), "too low") << "0.5 mm";
}

TEST(PrintJudge, ALineThatRisesFromTheTableLiesOnNothing) {
  const Path rises{{{0, 0, kGap}, {10e-3, 0, kGap + 2.9e-3}},
                   [](double, const Vec3& tip) { return tip.z(); }};
  EXPECT_EQ(flaw_words(judged(rises).flaws), "") << "its own bead, 16 degrees lower, is nothing below it";
}

TEST(PrintJudge, ATouchSpoils) {
  Record early = record(1);
  early.trace.front().gap = -1e-6;
  EXPECT_EQ(flaws(early), "touched") << "on the way down";
  Record pressed = record(1);
  pressed.trace[500].gap = -1e-6;
  EXPECT_EQ(flaws(pressed), "") << "where it crosses a bead of its own";
  pressed.trace[500].gap = -60e-6;
  EXPECT_EQ(flaws(pressed), "touched");
  Record strut = record(1);
  strut.collision.emplace();
  strut.collision->min_clearance_mm = -0.1;
  EXPECT_EQ(flaws(strut), "touched");
  strut.collision->min_clearance_mm = 0.1;
  EXPECT_EQ(flaws(strut), "");
}

TEST(PrintJudge, TolerancesAreThoseOfTheMachineFile) {
  const PrintTolerances hexapod = tolerances_of("hexapod");  // models/hexapod/machine.yaml
  EXPECT_DOUBLE_EQ(hexapod.tip, 0.5e-3);
  EXPECT_DOUBLE_EQ(hexapod.orientation, 2 * kDegree);
  EXPECT_DOUBLE_EQ(hexapod.gap_min, 0.1e-3);
  EXPECT_DOUBLE_EQ(hexapod.gap_max, 0.2e-3);
  EXPECT_DOUBLE_EQ(hexapod.gap_above, 0.07e-3);
}

}  // namespace
}  // namespace understudy::studies
