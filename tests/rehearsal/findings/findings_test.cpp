// What the observers saw, as findings.
#include "rehearsal/findings/findings.h"

#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "rehearsal/findings/feature_findings.h"

namespace understudy::rehearsal {
namespace {

/// 0.6 mm that lie 0.22 mm over the part, held by what follows; a bead is 0.8 mm wide there.
sim::UnsupportedStretch high_start() {
  sim::UnsupportedStretch stretch;
  stretch.line = 11;
  stretch.length = from_mm(0.6);
  stretch.width = from_mm(0.8);
  stretch.volume = 1e-11;
  stretch.worst_gap = from_mm(0.22);
  stretch.highest_gap = from_mm(0.2);
  stretch.held_at_end = true;
  return stretch;
}

std::vector<Finding> findings_of_stretch(const sim::UnsupportedStretch& stretch) {
  TwinSetup setup;
  setup.machine = machine::load_machine("hexapod");
  TwinRun run;
  run.result.completed = true;
  run.loose = {stretch};
  return findings_of(run, setup, control::GapControl::off);
}

TEST(Findings, ALineThatBeginsTooHighIsAWarning) {
  const auto findings = findings_of_stretch(high_start());
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::warning);
  EXPECT_EQ(findings[0].gcode_line, 11);
  EXPECT_NEAR(findings[0].value, 0.22, 1e-12);
  EXPECT_NEAR(findings[0].limit, 0.2, 1e-12);
  EXPECT_THAT(findings[0].message, testing::HasSubstr("0.220 mm over the surface, above 0.200 mm"));
}

TEST(Findings, APlaceAtZeroHasNoSign) {
  sim::UnsupportedStretch stretch = high_start();
  stretch.place_W = Vec3(-1e-17, -0.004e-3, -12.344e-3);
  const auto findings = findings_of_stretch(stretch);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings[0].message, testing::HasSubstr("(0.00, 0.00, -12.34) mm"));
}

// Where findings are told, their lines stand beside them.
TEST(Findings, AContactOfManyLinesSaysWhichIsTheWorstAndNotAllOfThem) {
  TwinSetup setup;
  setup.machine = machine::load_machine("hexapod");
  TwinRun run;
  run.result.completed = true;
  for (const auto& [line, depth] : {std::pair{35, 0.01e-3}, {36, 0.07e-3}, {37, 0.02e-3}})
    run.collisions.push_back({"nozzle", "part", -depth, Vec3(5e-3, 0, 30e-3), 1.0 * line, line});
  const auto findings = findings_of(run, setup, control::GapControl::off);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].gcode_line, 35);
  EXPECT_EQ(findings[0].last_line, 37);
  EXPECT_EQ(findings[0].message, "nozzle touches part, 0.070 mm deep at (5.00, 0.00, 30.00) mm on line 36");
}

TEST(Findings, AGrooveOfThePrintIsNone) {
  sim::UnsupportedStretch groove = high_start();
  groove.held_at_start = groove.on_printed = true;
  EXPECT_TRUE(findings_of_stretch(groove).empty());
}

TEST(Findings, WhatNothingHoldsIsAnError) {
  sim::UnsupportedStretch loose = high_start();
  loose.held_at_end = false;
  const auto findings = findings_of_stretch(loose);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].severity, Severity::error);
}

/// The start of an infill line 3.6 mm above what is below, before it meets the next rib.
sim::UnsupportedStretch hanging_start(double length) {
  sim::UnsupportedStretch stretch = high_start();
  stretch.length = length;
  stretch.worst_gap = from_mm(3.6);
  stretch.width = from_mm(0.45);
  stretch.held_at_end = stretch.on_printed = true;
  return stretch;
}

TEST(Findings, TheShortEndOfALineOverAHollowIsAWarningAndALongOneAnError) {
  const auto brief = findings_of_stretch(hanging_start(from_mm(1.9)));
  ASSERT_EQ(brief.size(), 1u);
  EXPECT_EQ(brief[0].severity, Severity::warning);
  const auto longer = findings_of_stretch(hanging_start(from_mm(2.1)));
  ASSERT_EQ(longer.size(), 1u);
  EXPECT_EQ(longer[0].severity, Severity::error) << "more than five bores";
}

// On a part or the table the bead was to lie: what does not is lost.
TEST(Findings, TheEndOfALineThatLeavesAPartIsAnError) {
  for (const auto& [bores, severity] : {std::pair{0.9, Severity::warning}, {2.5, Severity::error}}) {
    sim::UnsupportedStretch stretch = hanging_start(bores * from_mm(0.4));
    stretch.on_printed = false;
    const auto findings = findings_of_stretch(stretch);
    ASSERT_EQ(findings.size(), 1u) << bores;
    EXPECT_EQ(findings[0].severity, severity) << bores;
  }
}

TEST(Findings, ABeadOfNoLengthIsNone) {
  sim::UnsupportedStretch drop = high_start();
  drop.held_at_end = false;
  drop.length = 0;
  EXPECT_TRUE(findings_of_stretch(drop).empty());
}

Finding finding_of_strand(const sim::AirStrand& strand) {
  TwinSetup setup;
  setup.machine = machine::load_machine("hexapod");
  TwinRun run;
  run.result.completed = true;
  run.strands = {strand};
  const auto findings = findings_of(run, setup, control::GapControl::off);
  return findings.empty() ? Finding{} : findings.front();
}

TEST(Findings, AStrandOverNothingFalls) {
  sim::AirStrand strand;
  strand.length = from_mm(30);
  strand.diameter = from_mm(0.4);
  strand.sag = sim::kGapReach;
  strand.lies = true;
  strand.small = false;
  const Finding fallen = finding_of_strand(strand);
  EXPECT_THAT(fallen.message, testing::HasSubstr("falls: nothing lies below it"));
  EXPECT_EQ(fallen.about, "");
  strand.length = from_mm(2);
  EXPECT_EQ(finding_of_strand(strand).about, kShortStrand);
}

}  // namespace
}  // namespace understudy::rehearsal
