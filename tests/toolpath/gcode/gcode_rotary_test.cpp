// B and C of a table that tilts and turns (Han 2024; docs/reference.md#five-axis-printer): p = Rz(C) Ry(B)
// (X, Y, Z) without tool-centre-point coordinates, R = Rz(C) Ry(B) with and without.
#include <cmath>
#include <cstdio>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Coordinates = RotaryWords::Coordinates;

// A text in mm or degrees becomes metres and back in doubles; positions of some 100 mm.
constexpr double kRounding = 1e-12;  // mm, or of a rotation matrix

/// Rz(C) Ry(B), written out; degrees.
Mat3 turned(double b_deg, double c_deg) {
  const double b = from_deg(b_deg), c = from_deg(c_deg);
  Mat3 R;
  R << std::cos(c) * std::cos(b), -std::sin(c), std::cos(c) * std::sin(b),  //
      std::sin(c) * std::cos(b), std::cos(c), std::sin(c) * std::sin(b),    //
      -std::sin(b), 0, std::cos(b);
  return R;
}

/// Both axes run through the origin, unless B's runs `b_below` [m] under it.
GcodeOptions five_axis(Coordinates coordinates, double b_below = 0) {
  GcodeOptions options;
  options.X_WT_home = make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, 0.05));
  const Vec3 centre(0, 0, -b_below);
  RotaryWords rotary;
  rotary.coordinates = coordinates;
  rotary.tip_pose = [](const Vec3& p, double b, double c) -> Pose {
    return make_pose(turned(to_deg(b), to_deg(c)), p);
  };
  rotary.slides_pose = [centre](const Vec3& slides, double b, double c) -> Pose {
    const Mat3 R = turned(to_deg(b), to_deg(c));
    return make_pose(R, Vec3(centre + R * (slides - centre)));
  };
  rotary.slides = [centre](const Vec3& p, double b, double c) -> Vec3 {
    return centre + turned(to_deg(b), to_deg(c)).transpose() * (p - centre);
  };
  options.rotary = rotary;
  return options;
}

std::vector<Step> in_tip(const std::string& text) {
  return parse_gcode(text, "p.gcode", five_axis(Coordinates::tip)).steps;
}
std::vector<Step> in_machine(const std::string& text, double b_below = 0) {
  return parse_gcode(text, "p.gcode", five_axis(Coordinates::machine, b_below)).steps;
}

void expect_pose(const Step& step, const Vec3& p_mm, double b_deg, double c_deg) {
  EXPECT_LT((1e3 * step.X_WT.translation() - p_mm).norm(), kRounding)
      << "line " << step.line << ": " << 1e3 * step.X_WT.translation().transpose();
  EXPECT_LT((step.X_WT.linear() - turned(b_deg, c_deg)).norm(), kRounding) << "line " << step.line;
}

/// Rz(C) Ry(B) (X, Y, Z)
Vec3 carried(double b_deg, double c_deg, const Vec3& slides_mm) { return turned(b_deg, c_deg) * slides_mm; }

TEST(GcodeRotary, TipCoordinatesLeaveXyzInTheWorkAndTurnTheTool) {
  const auto steps = in_tip("G0 X10 Y5 Z20 B30 C90\n");
  expect_pose(steps[0], Vec3(10, 5, 20), 30, 90);
  // At C 90 the table's tilt leans the tool to +y.
  EXPECT_LT((tool_axis(steps[0].X_WT) - Vec3(0, 0.5, std::sqrt(0.75))).norm(), kRounding);
}

TEST(GcodeRotary, MachineCoordinatesAreTheSlidesThatTheTableCarries) {
  const auto steps = in_machine("G0 X10 Y0 Z20 B90 C0\nG0 C90\n");
  // Ry(90): x to -z, z to x. Then Rz(90): x to y.
  EXPECT_LT((1e3 * steps[0].X_WT.translation() - Vec3(20, 0, -10)).norm(), kRounding);
  EXPECT_LT((1e3 * steps[1].X_WT.translation() - Vec3(0, 20, -10)).norm(), kRounding);
  expect_pose(steps[1], carried(90, 90, Vec3(10, 0, 20)), 90, 90);
}

TEST(GcodeRotary, WordsAreModal) {
  const auto tip = in_tip("G0 X1 B30\nX2\nC40\nB-10 Z7\nG1 Y3 E1 F60\n");
  expect_pose(tip[0], Vec3(1, 0, 50), 30, 0);
  expect_pose(tip[1], Vec3(2, 0, 50), 30, 0);
  expect_pose(tip[2], Vec3(2, 0, 50), 30, 40);
  expect_pose(tip[3], Vec3(2, 0, 7), -10, 40);
  expect_pose(tip[4], Vec3(2, 3, 7), -10, 40);
  // In machine coordinates what stays is the reading, not the tip.
  const auto slides = in_machine("G0 X10 Y2 Z5 B30\nC40\nX11\n");
  expect_pose(slides[1], carried(30, 40, Vec3(10, 2, 5)), 30, 40);
  expect_pose(slides[2], carried(30, 40, Vec3(11, 2, 5)), 30, 40);
}

TEST(GcodeRotary, RelativeWordsAddUp) {
  const auto tip = in_tip("G91 G0 B10 C20\nX1 B10 C-50\nG90 B5\n");
  expect_pose(tip[0], Vec3(0, 0, 50), 10, 20);
  expect_pose(tip[1], Vec3(1, 0, 50), 20, -30);
  expect_pose(tip[2], Vec3(1, 0, 50), 5, -30);
  const auto slides = in_machine("G91 G0 X3 B10\nX2 Z-40 C20\nB10\n");
  expect_pose(slides[1], carried(10, 20, Vec3(5, 0, 10)), 10, 20);
  expect_pose(slides[2], carried(20, 20, Vec3(5, 0, 10)), 20, 20);
}

TEST(GcodeRotary, TurnsOfCMayRunOn) {
  const auto steps = in_tip("G0 B30 C350\nC370\nC3610\nG91 C355\n");
  expect_pose(steps[1], Vec3(0, 0, 50), 30, 10);
  expect_pose(steps[2], Vec3(0, 0, 50), 30, 10);
  expect_pose(steps[3], Vec3(0, 0, 50), 30, 5);
}

TEST(GcodeRotary, InchesLeaveDegreesAlone) {
  const auto steps = in_tip("G20 G0 X1 B30 C10\nG92 C0\nC10\n");
  expect_pose(steps[0], Vec3(25.4, 0, 50), 30, 10);
  expect_pose(steps[1], Vec3(25.4, 0, 50), 30, 20);
}

TEST(GcodeRotary, G92RenamesTheReadingOfBAndCUntilG28) {
  const auto steps = in_tip("G0 B30 C40\nG92 B0 C100\nB5 C110\nG91 C1\nG90 C100\nG28\nG0 C10\n");
  expect_pose(steps[1], Vec3(0, 0, 50), 35, 50);
  expect_pose(steps[2], Vec3(0, 0, 50), 35, 51);
  expect_pose(steps[3], Vec3(0, 0, 50), 35, 40);
  expect_pose(steps[5], Vec3(0, 0, 50), 0, 10);
}

TEST(GcodeRotary, G92RenamesSlidesInMachineCoordinates) {
  const auto steps = in_machine("G0 X10 Z20 B30\nG92 X0 Z0\nG0 X1\nC90\n");
  expect_pose(steps[1], carried(30, 0, Vec3(11, 0, 20)), 30, 0);
  expect_pose(steps[2], carried(30, 90, Vec3(11, 0, 20)), 30, 90);
}

TEST(GcodeRotary, G28TakesBothAxesHomeWithTheRest) {
  for (const auto& steps : {in_tip("G0 X4 B30 C40\nG28\nG0 X1\nB10\n"), in_machine("G0 B30\nG28\nG0 X1\n")}) {
    EXPECT_EQ(steps[1].kind, StepKind::home);
    expect_pose(steps[1], Vec3(0, 0, 50), 0, 0);
    expect_pose(steps[2], Vec3(1, 0, 50), 0, 0);
  }
  GcodeOptions options = five_axis(Coordinates::machine);
  options.rotary->b_home = from_deg(20);
  options.X_WT_home = options.rotary->slides_pose(Vec3(0, 0, 0.05), from_deg(20), 0);
  const auto steps = parse_gcode("G28\nG0 C90\nG91 B10\n", "p.gcode", options).steps;
  expect_pose(steps[1], carried(20, 90, Vec3(0, 0, 50)), 20, 90);
  expect_pose(steps[2], carried(30, 90, Vec3(0, 0, 50)), 30, 90);
}

TEST(GcodeRotary, G49AndG43Point4SwitchCoordinatesWhereTheToolStands) {
  const auto steps = in_tip("G0 X10 Y0 Z20 B90\nG49\nX12\nC90\nG43.4 G0 Z5\nC0\n");
  // Tip at (10, 0, 20), B 90: slides X = -20, Z = 10.
  expect_pose(steps[1], carried(90, 0, Vec3(12, 0, 10)), 90, 0);
  expect_pose(steps[2], carried(90, 90, Vec3(12, 0, 10)), 90, 90);
  // The tip at Rz(90) Ry(90) (12, 0, 10) = (0, 10, -12); then only z changes.
  expect_pose(steps[3], Vec3(0, 10, 5), 90, 90);
  expect_pose(steps[4], Vec3(0, 10, 5), 90, 0);
  // Said again, it changes nothing.
  expect_pose(in_tip("G43.4 G0 X1 B10\n")[0], Vec3(1, 0, 50), 10, 0);
}

TEST(GcodeRotary, BothCoordinatesReachTheSamePosesWhereverTheAxesRun) {
  // B's axis 30 mm under the table: slides of the tip (10, 5, 20) by hand, about (0, 0, -30).
  const Mat3 R = turned(25, -70);
  const Vec3 centre(0, 0, -30), tip(10, 5, 20);
  const Vec3 slides = centre + R.transpose() * (tip - centre);
  char line[160];
  std::snprintf(line, sizeof line, "G0 X%.12f Y%.12f Z%.12f B25 C-70\n", slides.x(), slides.y(), slides.z());
  const Pose by_slides = in_machine(line, 30e-3)[0].X_WT;
  const Pose by_tip = in_tip("G0 X10 Y5 Z20 B25 C-70\n")[0].X_WT;
  // Twelve decimals of a millimetre.
  EXPECT_LT(1e3 * (by_slides.translation() - by_tip.translation()).norm(), 1e-11);
  EXPECT_LT((by_slides.linear() - by_tip.linear()).norm(), kRounding);
}

TEST(GcodeRotary, ToolAxisWordsAndRotaryWordsMayTakeTurns) {
  const auto steps = in_tip("G0 B30\nX1 I0.6 J0 K0.8\nX2\nB10 C20\nX3\nW1 I0 J0 K0\nG28\nG0 B5\n");
  EXPECT_LT((tool_axis(steps[2].X_WT) - Vec3(0.6, 0, 0.8)).norm(), kRounding);
  expect_pose(steps[4], Vec3(3, 0, 50), 10, 20);
  expect_pose(steps[7], Vec3(0, 0, 50), 5, 0);
}

TEST(GcodeRotary, FilamentFedWhileTheTipRestsHasADurationInBothCoordinates) {
  // 1 mm at 1 mm/s. X0 Z50 at home is where the tip stands; so is any line of E alone.
  EXPECT_DOUBLE_EQ(in_machine("G1 X0 Y0 Z50 E1 F60\n", 30e-3)[0].duration, 1);
  const auto steps = in_machine("G49\nG0 X3 B33 C77\nG43.4\nG49\nG1 Z50 E1 F60\nE2\nX4 E3\n", 30e-3);
  EXPECT_DOUBLE_EQ(steps[1].duration, 1);
  EXPECT_EQ(steps[1].X_WT.translation(), steps[0].X_WT.translation());
  EXPECT_DOUBLE_EQ(steps[2].duration, 1);
  EXPECT_EQ(steps[3].duration, 0);
  EXPECT_DOUBLE_EQ(steps[3].feed, 1e-3);
}

struct Bad {
  const char* text;
  const char* place;
  const char* message;
};

class BadRotaryWord : public ::testing::TestWithParam<Bad> {};

TEST_P(BadRotaryWord, IsOneLineWithPlaceAndWord) {
  try {
    in_tip(GetParam().text);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith(std::string("p.gcode") + GetParam().place + ": "));
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Words, BadRotaryWord,
    ::testing::Values(
        Bad{"G0 X1 A5", ":1:7", "'A5': the rotary axes of this machine are B and C"},
        Bad{"G0 X1\nX2 B10 I0 J0 K1", ":2:4", "'B10' cannot share a line with 'I0'"},
        Bad{"G0 W1 I0 J0 K0 C3", ":1:16", "'C3' cannot share a line with 'W1'"},
        Bad{"G0 X1\nG49 G0 I0 J0 K1", ":2:8", "'I0': tool axis words need tool-centre-point coordinates"},
        Bad{"G0 I0 J0 K1\nB10", ":2:1", "'B10' after an orientation by I J K: B and C are not known"},
        Bad{"G0 I0 J0 K1\nG91 B10 C10", ":2:5", "'B10' after an orientation by I J K"},
        Bad{"G0 I0 J0 K1\nG92 C0", ":2:5", "'C0' after an orientation by I J K"},
        Bad{"G0 I0 J0 K1\nG49", ":2:1", "'G49' after an orientation by I J K"},
        Bad{"G0 X1\nG92 X0\nG49", ":3:1", "'G49' while X Y Z are shifted by G92"},
        Bad{"G43.4 G49 G0 X1", ":1:7", "'G49' cannot share a line with 'G43.4'"},
        Bad{"G0 B1 B2", ":1:7", "second B"}, Bad{"B1", ":1:1", "'B1' before any G0 or G1"},
        Bad{"G28\nG28 W1", ":2:5", "'W1' belongs to no command"},
        Bad{"G0 C360001", ":1:4", "'C360001' turns 1000 times, more than 1000 in one move"},
        Bad{"G91 G0 C-720000", ":1:8", "turns 2000 times"},
        Bad{"G0 C36000001", ":1:4", "'C36000001' leads to 36000001 deg, beyond 36000000 deg"},
        Bad{"G43 G0 X1", ":1:1", "unknown word 'G43'"}, Bad{"G92", ":1:1", "none of X Y Z B C E"}));

TEST(GcodeRotary, AMachineWithoutRotaryAxesRefusesWordsAndSwitches) {
  for (const auto& [text, word] :
       {std::pair("G0 X1 B5", "'B5'"), std::pair("G0 C5", "'C5'"), std::pair("G0 A5", "'A5'"),
        std::pair("G43.4", "'G43.4'"), std::pair("G49 G0 X1", "'G49'")}) {
    try {
      parse_gcode(text, "p.gcode", {});
      ADD_FAILURE() << text << " accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(std::string(word) + ": this machine has no rotary axes"));
      EXPECT_THAT(error.what(), StartsWith("p.gcode:1:"));
    }
  }
}

/// Refused with this text; "" where it is read.
std::string refusal(const std::string& text, const GcodeOptions& options) {
  try {
    parse_gcode(text, "p.gcode", options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(GcodeRotary, LettersAreThoseOfTheMachine) {
  for (const std::string letters : {"AC", "UV", "WD", "CB"}) {
    GcodeOptions options = five_axis(Coordinates::tip);
    options.rotary->letters = letters;
    const auto text = [&](const char* line) {
      std::string t = line;
      for (char& c : t)
        if (c == '#' || c == '@') c = letters[c == '#' ? 0 : 1];
      return t;
    };
    const auto steps = parse_gcode(text("G0 X5 #30 @40\nG91 G0 #10\n"), "p.gcode", options).steps;
    ASSERT_EQ(steps.size(), 2u);
    expect_pose(steps[0], {5, 0, 50}, 30, 40);
    expect_pose(steps[1], {5, 0, 50}, 40, 40);
    EXPECT_NE(refusal(text("G0 X5 #30 #30\n"), options), "");
  }
}

TEST(GcodeRotary, OneLetterLeavesTheOtherTurnAlone) {
  GcodeOptions options = five_axis(Coordinates::tip);
  options.rotary->letters = "B";
  const auto steps =
      parse_gcode("G0 X5 B30\nG1 I0 J0 K1 F100\nG0 B20\nG28 X Y Z B\n", "p.gcode", options).steps;
  ASSERT_EQ(steps.size(), 4u);
  expect_pose(steps[0], {5, 0, 50}, 30, 0);
  expect_pose(steps[2], {5, 0, 50}, 20, 0);  // one word is enough after I J K
  EXPECT_EQ(steps[3].kind, StepKind::home);
  EXPECT_THAT(refusal("G0 X5 C30\n", options), HasSubstr("the rotary axes of this machine are B"));
}

TEST(GcodeRotary, AUnitIsThatOfItsWord) {
  GcodeOptions options = five_axis(Coordinates::tip);
  options.rotary->b_unit = 1;              // radians
  options.rotary->c_unit = from_deg(360);  // revolutions
  const auto steps = parse_gcode("G0 X5 B0.5 C0.25\nG92 C0\nG0 C0.5\n", "p.gcode", options).steps;
  expect_pose(steps[0], {5, 0, 50}, to_deg(0.5), 90);
  expect_pose(steps[1], {5, 0, 50}, to_deg(0.5), 270);
}

TEST(GcodeRotary, TheMachineNamesWhatSwitchesItsCoordinates) {
  GcodeOptions options = five_axis(Coordinates::tip);
  options.rotary->tip_commands = {"M128", "TRAORI"};
  options.rotary->machine_commands = {"M129", "TRAFOOF"};
  for (const std::string line : {"M129", "trafoof", "N20 TRAFOOF ; off"}) {
    const auto steps = parse_gcode(line + "\nG0 X10 Z0 B90\n", "p.gcode", options).steps;
    expect_pose(steps.back(), carried(90, 0, {10, 0, 0}), 90, 0);
  }
  const auto back = parse_gcode("M129\nTRAORI\nG0 X10 Z0 B90\n", "p.gcode", options).steps;
  expect_pose(back.back(), {10, 0, 0}, 90, 0);
  EXPECT_THAT(refusal("G49\nG0 X1\n", options), HasSubstr("unknown word 'G49'"));
  EXPECT_THAT(refusal("TRACYL\nG0 X1\n", options), HasSubstr("unknown word 'TRACYL'"));
  for (const std::string taken : {"G1", "M105", "M117", "G21"}) {
    options.rotary->tip_commands = {taken};
    EXPECT_THAT(refusal("G0 X1\n", options), HasSubstr("'" + taken + "' cannot switch"));
  }
}

TEST(GcodeRotary, WithoutSlidesThereAreNoMachineCoordinates) {
  GcodeOptions options = five_axis(Coordinates::tip);
  options.rotary->slides = nullptr;
  options.rotary->slides_pose = nullptr;
  EXPECT_THAT(refusal("G49\nG0 X1\n", options), HasSubstr("p.gcode:1:1: 'G49': the machine's file does not"));
  // Then G28 X is the tip's.
  const auto steps = parse_gcode("G0 X5 Y7 B30\nG28 X\n", "p.gcode", options).steps;
  expect_pose(steps.back(), {0, 7, 50}, 30, 0);
  options.rotary->coordinates = Coordinates::machine;
  EXPECT_THAT(refusal("G0 X1\n", options), HasSubstr("coordinates 'machine': the machine's file"));
}

TEST(GcodeRotary, FilamentMayBeOnAnyLetterThatTurnsNothing) {
  GcodeOptions options = five_axis(Coordinates::tip);
  options.extruder_letter = 'U';
  EXPECT_DOUBLE_EQ(parse_gcode("G1 X5 U2 B3 F100\n", "p.gcode", options).steps[0].filament, 2e-3);
  options.extruder_letter = 'C';
  EXPECT_THAT(refusal("G0 X1\n", options), HasSubstr("extruder on 'C': that turns an axis"));
  options.extruder_letter = 'F';
  EXPECT_THAT(refusal("G0 X1\n", options), HasSubstr("extruder on 'F': one of E, A, B, C, D, U, V, W"));
}

/// A head 60 mm long that turns as a whole: a table that does not turn.
TEST(GcodeRotary, CrossingIsWhatTheMachineSays) {
  GcodeOptions options = five_axis(Coordinates::crossing);
  options.rotary->crossing = [](double b, double c) -> Pose {
    return make_pose(Mat3(Mat3::Identity()),
                     Vec3(turned(to_deg(b), to_deg(c)) * Vec3(0, 0, -0.06) + Vec3(0, 0, 0.06)));
  };
  options.offset_W = Vec3(0.001, 0, 0);
  const auto steps = parse_gcode("G0 X5 Y0 Z10 B90\nG0 X6\n", "p.gcode", options).steps;
  expect_pose(steps[0], {1 + 5 - 60, 0, 10 + 60}, 90, 0);
  expect_pose(steps[1], {1 + 6 - 60, 0, 10 + 60}, 90, 0);
}

}  // namespace
}  // namespace understudy::toolpath
