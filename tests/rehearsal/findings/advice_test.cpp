#include "rehearsal/findings/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rehearsal/findings/flow_findings.h"

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

Finding too_low(double gap_mm) {
  return {"gap", Severity::error, 22, 6, gap_mm, 0.1, "mm", "the nozzle runs too low", 0, kTooLow};
}

Record on_a_machine(bool measures_gap, const char* gap_control) {
  Record record;
  record.machine_word = "models/mine/machine.yaml";
  record.measures_gap = measures_gap;
  record.gap_control = gap_control;
  record.gap_accepted_min_mm = 0.1;
  return record;
}

TEST(Advice, AMachineThatSeesIsToldToMeasureTheGapAndThenToFollowIt) {
  EXPECT_THAT(advice(too_low(0.082), on_a_machine(true, "off")), HasSubstr("`--gap-control start`"));
  EXPECT_THAT(advice(too_low(0.082), on_a_machine(true, "start")), HasSubstr("`--gap-control continuous`"));
  EXPECT_THAT(advice(too_low(0.082), on_a_machine(true, "continuous")), HasSubstr("`understudy calibrate "));
}

// 0.018 mm are missing: hundredths, rounded up, on top of where the program stands now.
TEST(Advice, AMachineThatDoesNotSeeIsToldHowMuchHigher) {
  Record record = on_a_machine(false, "off");
  EXPECT_THAT(advice(too_low(0.082), record), HasSubstr("`--place 0,0,0.02`"));
  record.place_mm = {5, -2, 0.5};
  EXPECT_THAT(advice(too_low(0.082), record), HasSubstr("`--place 5,-2,0.52`"));
}

TEST(Advice, CommandsNameTheMachineAsItWasAskedFor) {
  const Finding error{"accuracy", Severity::error, 0, 0, 0.74, 0.5, "mm", "", 0, kTip};
  const std::string text = advice(error, on_a_machine(true, "start"));
  EXPECT_THAT(text, HasSubstr("calibrate measured.csv --machine models/mine/machine.yaml "));
  EXPECT_THAT(text, HasSubstr("`--tip-tolerance 0.8`"));
}

TEST(Advice, CommandsQuoteWhatAShellWouldTakeApart) {
  Record record = on_a_machine(false, "off");
  record.machine_word = "my machine.yaml";
  record.program_word = "parts/two words.gcode";
  const Finding large{"placement", Severity::error, 6, 1, 5, 0.2, "mm", "", 0, ""};
  EXPECT_THAT(advice(large, record),
              HasSubstr("`understudy place 'parts/two words.gcode' --machine 'my machine.yaml' -o map.png`"));
}

TEST(Advice, ATipThatIsOffWhereAnAxisIsHeldIsNoReasonToCalibrate) {
  Record record = on_a_machine(false, "off");
  record.findings.push_back({"joint_limit", Severity::error, 8, 0, 265, 100, "mm", "", 0, ""});
  const Finding off{"accuracy", Severity::error, 10, 0, 241, 0.2, "mm", "", 0, kTip};
  EXPECT_THAT(advice(off, record), HasSubstr("bring the axes within their ranges first"));
  record.findings.front().severity = Severity::warning;
  EXPECT_THAT(advice(off, record), HasSubstr("understudy calibrate"));
}

TEST(Advice, ABeadOverNothingAsksForThePart) {
  Finding loose{"adhesion", Severity::error, 6, 1, 5, 0.2, "mm", "", 0, kNothingBelow};
  Record record = on_a_machine(true, "start");
  EXPECT_THAT(advice(loose, record), HasSubstr("`--fixture "));
  record.fixture_name = "bottle";
  EXPECT_THAT(advice(loose, record), Not(HasSubstr("--fixture")));
}

TEST(Advice, ABeadThatIsLiftedOffItsLayerIsMendedByMeasuringTheGapOrTheMachine) {
  const Finding lifted{"adhesion", Severity::error, 34, 6, 0.24, 0.2, "mm", "", 0, kLifted};
  EXPECT_THAT(advice(lifted, on_a_machine(true, "start")), HasSubstr("`--gap-control continuous`"));
  EXPECT_THAT(advice(lifted, on_a_machine(false, "off")), HasSubstr("understudy calibrate"));
  EXPECT_THAT(advice(lifted, on_a_machine(true, "continuous")), HasSubstr("curves of gap and tip error"));
}

// All of the print would rise with the nozzle, and its first layer off the table.
TEST(Advice, ANozzleThatMeetsABeadIsNotMendedByThePlace) {
  Finding contact{"collision", Severity::error, 9, 1, -0.3, 0, "mm", "", 0, "nozzle and bead"};
  Record record = on_a_machine(false, "off");
  EXPECT_THAT(advice(contact, record), HasSubstr("Z hop"));
  record.accuracy.emplace().tip_max_um = 350;
  EXPECT_THAT(advice(contact, record), HasSubstr("understudy calibrate")) << "the tip is off by more";
  contact.about = "nozzle and table";
  EXPECT_THAT(advice(contact, on_a_machine(false, "off")), HasSubstr("`--place 0,0,0.4`"));
}

// More filament would over-extrude: 0.926 is fed, 0.745 lies along half of the lines.
TEST(Advice, LagIsMendedBySpeedAndNotByMoreFilament) {
  const Finding lag = fill_findings(FillFigures{0.926, 0.745, 1, 9, 0, Vec3::Zero()}).at(0);
  const std::string text = advice(lag, on_a_machine(false, "off"));
  EXPECT_THAT(text, HasSubstr("`M220 S50`"));
  EXPECT_THAT(text, HasSubstr("process.extruder_lag_ms"));
  EXPECT_THAT(text, Not(HasSubstr("M221")));
}

TEST(Advice, EveryKindOfFindingHasSome) {
  for (const char* kind : {"strut_length", "joint_angle", "joint_limit", "axis_velocity", "axis_acceleration",
                           "singularity", "unreachable", "collision", "near_collision", "accuracy", "gap",
                           "adhesion", "sag", "flow", "program", "placement", "assumption", "unchecked"})
    EXPECT_THAT(advice({kind, Severity::error, 1, 0, 0, 0, "", ""}, Record()), Not(IsEmpty())) << kind;
}

}  // namespace
}  // namespace understudy::rehearsal
