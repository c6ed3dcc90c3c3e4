// What slicers and other machines' post-processors write: tool numbers, G28 with axes, filament on G0, words
// without effect, extruders on A, axes that count the other way.
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Coordinates = RotaryWords::Coordinates;

constexpr double kRounding = 1e-15;  // [m] or [rad]: decimal text to doubles, lengths of 0.1 m

Mat3 turned(double b, double c) {
  return (Eigen::AngleAxisd(c, Vec3::UnitZ()) * Eigen::AngleAxisd(b, Vec3::UnitY())).toRotationMatrix();
}

/// Home at 50 mm; B runs 30 mm below the origin.
GcodeOptions five_axis() {
  const Vec3 pivot(0, 0, -0.030);
  GcodeOptions options;
  options.X_WT_home = make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, 0.05));
  RotaryWords rotary;
  rotary.tip_pose = [](const Vec3& p, double b, double c) -> Pose { return make_pose(turned(b, c), p); };
  rotary.slides_pose = [pivot](const Vec3& s, double b, double c) -> Pose {
    return make_pose(turned(b, c), Vec3(pivot + turned(b, c) * (s - pivot)));
  };
  rotary.slides = [pivot](const Vec3& p, double b, double c) -> Vec3 {
    return pivot + turned(b, c).transpose() * (p - pivot);
  };
  options.rotary = rotary;
  return options;
}

std::vector<Step> parse(const std::string& text, const GcodeOptions& options = {}) {
  return parse_gcode(text, "p.gcode", options).steps;
}
Vec3 tip_mm(const Step& step) { return step.X_WT.translation() * 1e3; }

std::string rejection(const std::string& text, const GcodeOptions& options = {}) {
  try {
    parse(text, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

// What Marlin takes them for, and PrusaSlicer, KISSlicer and Slic3r write.
TEST(GcodeDialect, AFanWithoutSpeedRunsAtFullSpeedAndADwellWithoutTimeWaitsForTheMoves) {
  const auto steps = parse("M106\nG4 ; wait\nM106 P2\nG0 X1\n");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].fan, 1);
  EXPECT_EQ(steps[1].kind, StepKind::dwell);
  EXPECT_EQ(steps[1].duration, 0);
}

// Skeinforge: (<rotation> (6.1e-17+1j) ).
TEST(GcodeDialect, ACommentEndsAtItsOwnParenthesis) {
  EXPECT_EQ(parse("(<rotation> (6.1e-17+1j) )\nM73 P95 (progress (95%): 3/9)\nG0 X1 (a) Y2 (b)\n").size(),
            1u);
  // Where the first is never closed, the next parenthesis ends it, as on controllers that nest none.
  EXPECT_NEAR(tip_mm(parse("G0 X1 (a (b) Y2\n")[0]).y(), 2, 1e-12);
}

// The first is in PrusaSlicer's profile of the MK3, the second in Bambu Studio's.
TEST(GcodeDialect, HowAFirmwareHomesIsItsOwnAffair) {
  EXPECT_EQ(parse("G0 X5\nG28 W ; without mesh\n").at(1).kind, StepKind::home);
  EXPECT_EQ(tip_mm(parse("G0 X5 Y6\nG28 Z P0 T300\n").at(1)), Vec3(5, 6, 0));
  EXPECT_THAT(rejection("G0 X5\nG28 I0\n"), HasSubstr("'I0' belongs to no command"));
}

// LinuxCNC's demonstrations, Fusion and other CAM systems begin so.
TEST(GcodeDialect, ModesShareALineWithWordsWithoutEffectAndChooseTheMotion) {
  const auto steps = parse("G00 G17 G40 G90 G94\nX5\nG40 G49 G80 M5\nG1 G64 X6 F60\n", five_axis());
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].kind, StepKind::travel);
  EXPECT_EQ(steps[1].kind, StepKind::move);
  EXPECT_THAT(rejection("G90\nG0\n"), HasSubstr("'G0' has neither motion"));
}

TEST(GcodeDialect, WhatAnUnknownCommandMakesOfItsLineIsNotKnownEither) {
  EXPECT_THAT(rejection("G0 X1\nM1999 some_text : 5\nM1999 : 2\nM98 P\"start.g\" Q=\nG0 X2\n"),
              HasSubstr("'M1999' (2 lines from line 2), 'M98' (1 line from line 4)"));
  EXPECT_EQ(parse("M1002 set_gcode_claim_speed_level : 5\nM18 A B\nM84 U V W\nG0 X1\n").size(), 1u);
  EXPECT_THAT(rejection("G0 X1 : 5\n"), HasSubstr("':' starts no word"));
}

TEST(GcodeDialect, TheOnlyExtruderMayBeCalledT0OrT1ButNotBoth) {
  const auto steps = parse("M104 S205 T1\nT1\nG0 X1\nM109 S205 T1\nM221 S100 T1\n");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_NEAR(steps[0].temperature, 478.15, 1e-12);
  EXPECT_TRUE(steps[2].wait);
  EXPECT_THAT(rejection("T0\nG0 X1\nM104 S200 T1\n"), StartsWith("p.gcode:3:11: 'T1' after T0"));
  EXPECT_THAT(rejection("M104 S200 T2"), HasSubstr("'T2': the machine has one extruder"));
  EXPECT_THAT(rejection("G0 X1 T0"), HasSubstr("'T0' belongs to no command"));
  EXPECT_THAT(rejection("T"), HasSubstr("'T': T needs a finite decimal number"));
}

TEST(GcodeDialect, G28WithEveryAxisIsHomeWhateverItsValuesAndFeed) {
  const auto steps = parse("G0 X5 B20 C400\nG28 X0 Y0 Z230 B0 C0 F5250\nG0 X1\n", five_axis());
  EXPECT_EQ(steps[1].kind, StepKind::home);
  EXPECT_LT((tip_mm(steps[1]) - Vec3(0, 0, 50)).norm(), 1e-12);
  EXPECT_EQ(steps[1].rotary->c, 0);
  EXPECT_LT((tip_mm(steps[2]) - Vec3(1, 0, 50)).norm(), 1e-12);
  EXPECT_EQ(parse("G0 X5\nG28 X Y Z\n")[1].kind, StepKind::home);
  // Its feed is no feed of G1.
  EXPECT_THAT(rejection("G28 X0 F100\nG1 X1"), HasSubstr("G1 without a feed"));
}

TEST(GcodeDialect, G28WithSomeAxesTakesTheseHomeAndEndsTheirShifts) {
  const auto steps = parse("G0 X5 Y6 Z7\nG92 X0 Y0\nG28 X\nG0 X1 Y1\n");
  EXPECT_EQ(steps[1].kind, StepKind::travel);
  EXPECT_LT((tip_mm(steps[1]) - Vec3(0, 6, 7)).norm(), 1e-12);
  EXPECT_LT((tip_mm(steps[2]) - Vec3(1, 7, 7)).norm(), 1e-12);
  // On a machine with turning axes it is slides that go home: at B 90 the tool lies along x, and the slide X
  // is the tip's distance below the pivot's height, -(z + 30 mm).
  const auto lying = parse("G0 X40 Z-10 B90\nG28 X\nG28 B\n", five_axis());
  EXPECT_LT((tip_mm(lying[1]) - Vec3(40, 0, -30)).norm(), 1e-12);
  EXPECT_LT((tip_mm(lying[2]) - Vec3(0, 0, 10)).norm(), 1e-12);
  EXPECT_EQ(lying[2].rotary->b, 0);
  EXPECT_THAT(rejection("G0 I0 J0 K1\nG28 X", five_axis()), HasSubstr("after an orientation by I J K"));
  EXPECT_THAT(rejection("G0 X1\nG28 B"), HasSubstr("no rotary axes"));
  EXPECT_THAT(rejection("G0 X1\nG28 E"), HasSubstr("needs a finite decimal number"));
}

TEST(GcodeDialect, FilamentOnG0RunsAtTheFeed) {
  const auto steps = parse("G92 E0\nG0 E-6.000 F5250\nG0 X10 E-5 F600\nG0 X0\n");
  EXPECT_EQ(steps[0].kind, StepKind::move);
  EXPECT_NEAR(steps[0].filament, -6e-3, kRounding);
  EXPECT_NEAR(steps[0].duration, 6 / 87.5, 1e-12);
  EXPECT_EQ(steps[1].kind, StepKind::print);
  EXPECT_NEAR(steps[1].feed, 10e-3, kRounding);
  EXPECT_EQ(steps[2].kind, StepKind::travel);
}

TEST(GcodeDialect, ExtruderOnATakesThePlaceOfE) {
  GcodeOptions options;
  options.extruder_letter = 'A';
  const auto steps = parse("M83\nG92 A0\nG1 X10 A0.5 F600\n", options);
  EXPECT_EQ(steps[0].kind, StepKind::print);
  EXPECT_NEAR(steps[0].filament, 0.5e-3, kRounding);
  EXPECT_THAT(rejection("G1 X10 E1 F600", options),
              StartsWith("p.gcode:1:8: 'E1': this program's extruder is on A"));
  options.extruder_letter = 'Q';
  EXPECT_THAT(rejection("G0 X1", options), HasSubstr("extruder on 'Q': one of E, A, B"));
}

TEST(GcodeDialect, FlowScalesFilamentFromThereOn) {
  const auto steps = parse("M83\nG1 X1 E1 F60\nM221 S95\nX2 E1\nM221 S100\nX3 E1\n");
  EXPECT_NEAR(steps[0].filament, 1e-3, kRounding);
  EXPECT_NEAR(steps[1].filament, 0.95e-3, kRounding);
  EXPECT_NEAR(steps[2].filament, 1e-3, kRounding);
  const auto kept =
      parse("M83\nM221 S50\nM221\nM221 S; push\nM221 X0 Y0 Z0\nM221 R; pop\nT1000\nG1 X1 E2 F60\n");
  EXPECT_NEAR(kept.at(0).filament, 1e-3, kRounding) << "nothing but S sets it";
  EXPECT_THAT(rejection("M221 S0"), HasSubstr("outside 1 to 1000 %"));
}

TEST(GcodeDialect, AccelerationsHoldForMovesOfTheirKindFromThereOn) {
  const auto steps = parse(
      "M83\nG1 X1 E1 F600\nM204 S800\nX2 E1\nX3\nG0 X4\nM204 P500 T2000 R900\nG1 X5 E1\nX6 E-1\n"
      "G2 X8 I1 E1\nG0 X9\n");
  constexpr double kNone = std::numeric_limits<double>::infinity();
  EXPECT_EQ(steps.front().acceleration, kNone);
  const std::map<int, double> expected = {{4, 0.8}, {5, 0.8}, {6, 0.8}, {8, 0.5}, {9, 2}, {10, 0.5}, {11, 2}};
  for (const Step& step : steps)
    if (expected.contains(step.line)) {
      EXPECT_NEAR(step.acceleration, expected.at(step.line), kRounding) << step.line;
    }
  EXPECT_EQ(steps.back().line, 11);
  EXPECT_THAT(rejection("M204 P0"), StartsWith("p.gcode:1:6: 'P0': an acceleration is in mm/s^2, above 0"));
  EXPECT_THAT(rejection("M204 S-5"), HasSubstr("above 0"));
}

TEST(GcodeDialect, WhatSlicersWriteForAFirmwareIsReadAndWithoutEffect) {
  const std::string preamble =
      "M73 P0 R12\nM201 X9000 Y9000 Z500 E10000\nM203 X500 Y500 Z12 E120\nM204 P2000 R1500 T2000\n"
      "M205 X10.00 Y10.00 Z0.20 E2.50\nM862.3 P \"MK3S\"\nM862.1 P0.4\nM900 K0.05\nM140 S60\nM190 S60\n"
      "N7 M84 X Y E\nM17\nM18\n";
  const auto steps = parse(preamble + "G0 X1\n");
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].line, 14);
  EXPECT_THAT(rejection("M204 X5\n"), HasSubstr("'X5'"));
  EXPECT_THAT(rejection("M73 P1 G1 X1\n"), HasSubstr("'G1' is no parameter of 'M73'"));
  EXPECT_THAT(rejection("G1 X \"1\"\n"), HasSubstr("needs a finite decimal number"));
  EXPECT_THAT(rejection("M206 X1\n"), HasSubstr("unknown word 'M206'"));
  EXPECT_THAT(rejection("G0 X1\nM30\nM84\nG28\n"), StartsWith("p.gcode:4:1: a move after the end"));
}

TEST(GcodeDialect, TheProgramsOriginIsShiftedAndG92SetsItsReadings) {
  GcodeOptions options;
  options.X_WT_home = make_pose(Quat(1, 0, 0, 0), Vec3(0, 0, 0.05));
  options.offset_W = Vec3(1e-3, 0, -40e-3);
  const auto steps = parse("G0 X10\nG0 Z42.75\nG92 Z0\nG0 Z1\nG28\nG0 Z41\nG91 G0 Z1\n", options);
  EXPECT_LT((tip_mm(steps[0]) - Vec3(11, 0, 50)).norm(), 1e-12);  // Z is home's, in W
  EXPECT_LT((tip_mm(steps[1]) - Vec3(11, 0, 2.75)).norm(), 1e-12);
  EXPECT_LT((tip_mm(steps[2]) - Vec3(11, 0, 3.75)).norm(), 1e-12);
  EXPECT_LT((tip_mm(steps[4]) - Vec3(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((tip_mm(steps[5]) - Vec3(0, 0, 2)).norm(), 1e-12);
}

TEST(GcodeDialect, AxesThatCountTheOtherWayRoundAreTurnedRound) {
  GcodeOptions options = five_axis();
  options.b_sign = options.c_sign = -1;
  const auto steps = parse("G0 B10 C30\nG91 G0 C5\nG92 C0\nG90 G0 C1\n", options);
  const double b = from_deg(-10);
  EXPECT_LT((steps[0].X_WT.linear() - turned(b, from_deg(-30))).norm(), kRounding);
  EXPECT_NEAR(steps[1].rotary->c, from_deg(-35), kRounding);
  EXPECT_NEAR(steps[2].rotary->c, from_deg(-36), kRounding);
  options.c_sign = 0;
  EXPECT_THAT(rejection("G0 X1", options), HasSubstr("sign of a rotary axis is 0"));
}

TEST(GcodeDialect, SlidesOfAxesThatCrossAtTheOriginAreTurnedAboutIt) {
  GcodeOptions options = five_axis();
  options.rotary->coordinates = Coordinates::crossing;
  options.offset_W = Vec3(0, 0, -40e-3);
  const auto steps = parse("G0 X10 Y-5 Z60 B30 C100\nG0 X11\nG28\nG0 X1\n", options);
  // docs/reference.md#five-axis-printer: p = Rz(C) Ry(B) (X, Y, Z), 40 mm lower.
  const Vec3 expected = turned(from_deg(30), from_deg(100)) * Vec3(11, -5, 60) - Vec3(0, 0, 40);
  EXPECT_LT((tip_mm(steps[1]) - expected).norm(), 1e-12);
  EXPECT_LT((tip_mm(steps[3]) - Vec3(1, 0, 50)).norm(), 1e-12);
  EXPECT_THAT(rejection("G0 X1\nG49", options), HasSubstr("axes that cross at its origin"));
}

TEST(GcodeDialect, StepsKnowTheTurnsThatTheProgramSaid) {
  const auto steps =
      parse("G0 X1\nG0 B10 C720\nG0 X2\nG4 S1\nG49\nG0 X3\nG43.4\nG0 I0 J0 K1\nG28\n", five_axis());
  ASSERT_EQ(steps.size(), 7u);
  EXPECT_EQ(steps[0].rotary->b, 0);  // home's
  for (const std::size_t k : {1u, 2u, 4u}) {
    ASSERT_TRUE(steps[k].rotary) << k;
    EXPECT_NEAR(steps[k].rotary->b, from_deg(10), kRounding) << k;
    EXPECT_NEAR(steps[k].rotary->c, 4 * std::numbers::pi, 1e-14) << k;
  }
  EXPECT_FALSE(steps[3].rotary);  // does not move
  EXPECT_FALSE(steps[5].rotary);  // a tool axis leaves them open
  ASSERT_TRUE(steps[6].rotary);
  EXPECT_EQ(steps[6].rotary->c, 0);
  EXPECT_FALSE(parse("G0 X1")[0].rotary);
}

// As Cura's end block has it, after M82. [mm] fed in all: 10, then 2 and 2 drawn back.
TEST(GcodeDialect, UnderG91ExtrusionCountsOnAsEveryAxisDoes) {
  const auto steps = parse("M82\nG1 X10 E10 F600\nG91\nG1 E-2 F2700\nG1 E-2 Z0.2\nG90\nG1 X20 E16\n");
  std::vector<double> fed;
  for (const Step& step : steps) fed.push_back(std::round(1e6 * step.filament) / 1e3);
  EXPECT_THAT(fed, ElementsAre(10, -2, -2, 10));
}

TEST(GcodeDialect, KisslicersFirmwareOfRelativeExtrusionNeedsNoM83) {
  const std::string lines = "G1 X10 E1 F600\nG1 X20 E1\n";
  EXPECT_NEAR(parse("; KISSlicer - FREE\n; firmware_type = 1\n" + lines)[1].filament, 1e-3, 1e-12);
  for (const std::string other : {"; KISSlicer - FREE\n; firmware_type = 2\n", "; firmware_type = 1\n"})
    EXPECT_EQ(parse(other + lines)[1].filament, 0) << other;
}

TEST(GcodeDialect, RepRapFirmwaresG10SetsTheTemperatureOfItsTool) {
  const auto steps = parse("G10 P0 S200 R150\nM116\nM566 X480 Y480 Z24 E600\nG10 P0 R120\nG1 X10 F600\n");
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].kind, StepKind::temperature);
  EXPECT_NEAR(steps[0].temperature, 200 + kCelsiusZero, 1e-9);
  EXPECT_THAT(rejection("G10 P0 S200 X5\nG1 X1 F60\n"), HasSubstr("'X5' belongs to no command"));
}

TEST(GcodeDialect, MachinekitsTemperatureIsItsP) {
  EXPECT_NEAR(parse("M104 P210\nG1 X1 F60\n")[0].temperature, 210 + kCelsiusZero, 1e-9);
}

}  // namespace
}  // namespace understudy::toolpath
