#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>

#include "core/digest.h"
#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const GcodeOptions kHomeAt50{make_pose(Quat(1, 0, 0, 0), Vec3(0, 0, 0.05))};

Program parse(const std::string& text) { return parse_gcode(text, "p.gcode", kHomeAt50); }

std::string rejection(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
  return "accepted";
}

Vec3 position_mm(const Step& step) { return 1e3 * step.X_WT.translation(); }
// Text in millimetres becomes metres and back in doubles: 1e-12 mm is some thousand roundings.
constexpr double kRounding = 1e-12;

TEST(GcodeReader, ReadsAPrintOfEveryWord) {
  const Program program = parse(
      "; a comment\n"
      "N10 G21 G90 (modes) M83\n"
      "M104 S200\nM109 S210.5\nM106 S127.5\n"
      "G28\n"
      "G0 X1 Y-2 Z+3.5\n"
      "g1 x2 f60 i0 j0 k1\n"
      "X3 E0.25\n"
      "G1 E-1 F1200\n"
      "G4 P250\nG4 S2\n"
      "M107\nM30\n");
  const auto& s = program.steps;
  ASSERT_EQ(s.size(), 12u);
  const StepKind kinds[] = {StepKind::temperature, StepKind::temperature, StepKind::fan,   StepKind::home,
                            StepKind::travel,      StepKind::move,        StepKind::print, StepKind::move,
                            StepKind::dwell,       StepKind::dwell,       StepKind::fan,   StepKind::end};
  const int lines[] = {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14};
  for (std::size_t i = 0; i < s.size(); ++i) {
    EXPECT_EQ(s[i].kind, kinds[i]) << i;
    EXPECT_EQ(s[i].line, lines[i]) << i;
  }
  EXPECT_DOUBLE_EQ(s[0].temperature, 473.15);
  EXPECT_FALSE(s[0].wait);
  EXPECT_DOUBLE_EQ(s[1].temperature, 483.65);
  EXPECT_TRUE(s[1].wait);
  EXPECT_DOUBLE_EQ(s[2].fan, 0.5);
  EXPECT_EQ(s[3].X_WT.translation(), Vec3(0, 0, 0.05));
  EXPECT_LT((position_mm(s[4]) - Vec3(1, -2, 3.5)).norm(), kRounding);
  EXPECT_LT((position_mm(s[5]) - Vec3(2, -2, 3.5)).norm(), kRounding);
  EXPECT_DOUBLE_EQ(s[5].feed, 1e-3);  // 60 mm/min is 1 mm/s
  EXPECT_NEAR(s[6].filament, 0.25e-3, 1e-18);
  EXPECT_DOUBLE_EQ(s[6].feed, 1e-3);
  EXPECT_NEAR(s[7].filament, -1e-3, 1e-18);
  EXPECT_DOUBLE_EQ(s[7].duration, 0.05);  // 1 mm of filament at 20 mm/s
  EXPECT_DOUBLE_EQ(s[8].duration, 0.25);
  EXPECT_DOUBLE_EQ(s[9].duration, 2);
  EXPECT_EQ(s[10].fan, 0);
  EXPECT_EQ(program.file, "p.gcode");
  EXPECT_EQ(parse("G28").sha256, sha256_hex("G28"));
}

TEST(GcodeReader, QuaternionsAreScalarFirstAndModal) {
  // Half the angle of 90 deg about y: the tool axis leans to +x.
  const auto steps = parse("G0 W0.7071067812 I0 J0.7071067812 K0\nG0 X5\nG0 W1 I0 J0 K0 X6\n").steps;
  for (const int i : {0, 1}) {
    EXPECT_LT((tool_axis(steps[static_cast<std::size_t>(i)].X_WT) - Vec3::UnitX()).norm(), 1e-9);
    EXPECT_LT((steps[static_cast<std::size_t>(i)].X_WT.linear() * Vec3::UnitX() + Vec3::UnitZ()).norm(),
              1e-9);
  }
  EXPECT_LT((steps[2].X_WT.linear() - Mat3::Identity()).norm(), 1e-15);
  EXPECT_NEAR(steps[2].X_WT.linear().determinant(), 1, 1e-15);
}

TEST(GcodeReader, AnAxisAloneTurnsTheToolByTheShortestArc) {
  const auto steps = parse("G0 I0.6 J0 K0.8\nG0 I0 J0 K-1\n").steps;
  EXPECT_LT((tool_axis(steps[0].X_WT) - Vec3(0.6, 0, 0.8)).norm(), 1e-15);
  EXPECT_LT((steps[0].X_WT.linear() * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-15);  // turned about y only
  EXPECT_LT((tool_axis(steps[1].X_WT) + Vec3::UnitZ()).norm(), 1e-15);
}

TEST(GcodeReader, RelativeMovesAddUpAndOrientationStaysAbsolute) {
  const auto steps = parse("G91 G0 X1 Y2\nX1 I0.6 J0 K0.8\nX1 I0.6 J0 K0.8\nG90 X1\n").steps;
  EXPECT_LT((position_mm(steps[2]) - Vec3(3, 2, 50)).norm(), kRounding);
  EXPECT_LT((tool_axis(steps[2].X_WT) - Vec3(0.6, 0, 0.8)).norm(), 1e-15);
  EXPECT_LT((position_mm(steps[3]) - Vec3(1, 2, 50)).norm(), kRounding);
}

TEST(GcodeReader, ExtrusionIsAbsoluteUnlessM83AndG92SetsItsReading) {
  const auto steps =
      parse("G1 X1 E1 F60\nX2 E1.5\nG92 E0\nX3 E0.5\nM83\nX4 E0.5\nM82\nX5 E1.25\nX6\nX7 E1.25\n").steps;
  const double expected_mm[] = {1, 0.5, 0.5, 0.5, 0.25, 0, 0};
  ASSERT_EQ(steps.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(to_mm(steps[i].filament), expected_mm[i], kRounding) << i;
  EXPECT_EQ(steps[4].kind, StepKind::print);
  EXPECT_EQ(steps[5].kind, StepKind::move);
  EXPECT_EQ(steps[6].kind, StepKind::move);
}

TEST(GcodeReader, G92ShiftsCoordinatesUntilG28) {
  const auto steps =
      parse("G0 X10 Y10 Z10\nG92 X0 Z5\nG0 X1 Y1 Z6\nG91 G0 X1\nG90 G0 X0\nG28\nG0 X1\n").steps;
  EXPECT_LT((position_mm(steps[1]) - Vec3(11, 1, 11)).norm(), kRounding);
  EXPECT_LT((position_mm(steps[2]) - Vec3(12, 1, 11)).norm(), kRounding);
  EXPECT_LT((position_mm(steps[3]) - Vec3(10, 1, 11)).norm(), kRounding);
  EXPECT_LT((position_mm(steps[5]) - Vec3(1, 0, 50)).norm(), kRounding);
}

TEST(GcodeReader, InchesScaleLengthsFilamentAndFeedButNotOrientation) {
  const auto steps = parse("G20 G1 X1 F60 E1 I0.6 J0 K0.8\nG92 X0\nX1\nG21 X2\n").steps;
  EXPECT_LT((position_mm(steps[0]) - Vec3(25.4, 0, 50)).norm(), kRounding);
  EXPECT_NEAR(steps[0].feed, 25.4e-3, 1e-15);
  EXPECT_NEAR(steps[0].filament, 25.4e-3, 1e-15);
  EXPECT_LT((position_mm(steps[1]) - Vec3(50.8, 0, 50)).norm(), kRounding);
  EXPECT_LT((position_mm(steps[2]) - Vec3(27.4, 0, 50)).norm(), kRounding);
  EXPECT_NEAR(steps[2].feed, 25.4e-3, 1e-15);  // a feed keeps its value when the unit changes
}

TEST(GcodeReader, InverseTimeGivesTheDurationOfTheWholeMove) {
  const auto steps = parse("G93 G1 X10 F2\nX20 F120\nG0 X0\nG94 G1 X1 F60\n").steps;
  EXPECT_DOUBLE_EQ(steps[0].duration, 30);
  EXPECT_DOUBLE_EQ(steps[1].duration, 0.5);
  EXPECT_EQ(steps[2].duration, 0);
  EXPECT_EQ(steps[3].duration, 0);
  EXPECT_DOUBLE_EQ(steps[3].feed, 1e-3);
}

TEST(GcodeReader, AFeedMayStandAloneAndOnG0) {
  EXPECT_DOUBLE_EQ(parse("G1 F120\nG1 X1").steps[0].feed, 2e-3);
  EXPECT_DOUBLE_EQ(parse("F120\nG1 X1").steps[0].feed, 2e-3);
  const auto steps = parse("G0 X1 F120\nG1 X2").steps;
  EXPECT_EQ(steps[0].feed, 0);  // G0 runs as fast as the machine may
  EXPECT_DOUBLE_EQ(steps[1].feed, 2e-3);
}

TEST(GcodeReader, ForgivesSpacesCaseLineEndsAndByteOrderMark) {
  const auto steps = parse("G1X1F60\r\n\r\nx2").steps;
  EXPECT_LT((position_mm(steps[1]) - Vec3(2, 0, 50)).norm(), kRounding);
  const auto spaced = parse("\xef\xbb\xbf  g1\tX 1.5y-.5 Z5. F60(a)(b) ; c (\r\n").steps;
  EXPECT_LT((position_mm(spaced[0]) - Vec3(1.5, -0.5, 5)).norm(), kRounding);
}

struct Bad {
  const char* text;
  const char* place;
  const char* message;
};

class BadGcode : public ::testing::TestWithParam<Bad> {};

TEST_P(BadGcode, IsOneLineWithPlaceWordAndLimit) {
  const std::string line = rejection(GetParam().text);
  EXPECT_THAT(line, StartsWith(std::string("p.gcode") + GetParam().place + ": "));
  EXPECT_THAT(line, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Words, BadGcode,
    ::testing::Values(
        Bad{"G0 X1\n G6 X1", ":2:2", "unknown word 'G6'"}, Bad{"G0 X1 H5", ":1:7", "unknown word 'H5'"},
        Bad{"G92.1", ":1:1", "unknown word 'G92.1'"},
        Bad{"G0 X1\nhello there", ":2:1", "unknown word 'HELLO'"},
        Bad{"T2", ":1:1", "'T2': the machine has one extruder"}, Bad{"G0 X1 N5", ":1:7", "unknown word 'N5'"},
        Bad{"G0 X1 B12.5", ":1:7", "'B12.5': this machine has no rotary axes"},
        Bad{"G0 c3", ":1:4", "no rotary axes"}, Bad{"%5", ":1:1", "'%' starts no word"},
        Bad{"G0 X1 \x01", ":1:7", "'\\x01' starts no word"},
        Bad{"G0 XNaN", ":1:4", "'XNaN': X needs a finite decimal number"},
        Bad{"G0 X1 Yinf", ":1:7", "'Yinf': Y needs a finite"}, Bad{"G0 X", ":1:4", "'X': X needs"},
        Bad{"G0 X1.2.3", ":1:4", "'X1.2.3'"}, Bad{"G0 X--1", ":1:4", "'X--1'"}, Bad{"G0 X.", ":1:4", "'X.'"},
        Bad{"G0 X1 X2", ":1:7", "second X"}, Bad{"G0 X1\nG0 (open", ":2:4", "not closed"},
        Bad{"G0 X1)", ":1:6", "')' starts no word"}));

INSTANTIATE_TEST_SUITE_P(
    Meaning, BadGcode,
    ::testing::Values(
        Bad{"", "", "empty file"}, Bad{"; nothing\nG21\n", "", "0 moves, at least 1"},
        Bad{"G28\nG1", ":2:1", "'G1' has neither motion nor extrusion nor feed"},
        Bad{"G0", ":1:1", "'G0' has neither"}, Bad{"X1", ":1:1", "'X1' before any G0 or G1"},
        Bad{"G1 X1", ":1:1", "G1 without a feed"},
        Bad{"G28\nG1 X1 F0", ":2:7", "'F0': the feed must be above 0"}, Bad{"G1 X1 F-3", ":1:7", "above 0"},
        Bad{"G93 G1 X1 F60\nX2", ":2:1", "G93 needs F"}, Bad{"G93 F60", ":1:5", "under G93 an F belongs"},
        Bad{"G1 X1 F60\nG93\nG94\nX2", ":4:1", "without a feed"},
        Bad{"G0 G1 X1", ":1:4", "'G1' cannot share a line with 'G0'"}, Bad{"G20 G21", ":1:5", "cannot share"},
        Bad{"M104 S1 M106", ":1:9", "cannot share"}, Bad{"G0 E1", ":1:1", "G0 with E without a feed"},
        Bad{"G28 I0", ":1:5", "'I0' belongs to no command"},
        Bad{"G28\nG1 X1 S5 F60", ":2:7", "'S5' belongs to no command"}, Bad{"G92", ":1:1", "none of X Y Z E"},
        Bad{"G92 I1", ":1:1", "none of X Y Z E"}, Bad{"M104", ":1:1", "needs S"},
        Bad{"M109 S-1", ":1:6", "below 0 C"}, Bad{"M106 S-1", ":1:6", "outside 0 to 255"},
        Bad{"M106 S256", ":1:6", "outside 0 to 255"}, Bad{"G4 P1 S1", ":1:1", "either P"},
        Bad{"G4 S-1", ":1:4", "outside 0 to 86400 s"}, Bad{"G28\nM30\nG0 X1", ":3:1", "after the end"}));

INSTANTIATE_TEST_SUITE_P(
    Size, BadGcode,
    ::testing::Values(Bad{"G0 W1 I0.1 J0 K0", ":1:4",
                          "quaternion W I J K has length 1.00499, farther than 0.0001 from 1"},
                      Bad{"G0 W0 I0 J0 K0", ":1:4", "length 0"},
                      Bad{"G0 X1 I0.5 J0 K0.5", ":1:7", "tool axis I J K has length 0.707107"},
                      Bad{"G0 I1 J0", ":1:4", "orientation without K"},
                      Bad{"G0 W1", ":1:4", "orientation without I"},
                      Bad{"G0 X100000.1", ":1:4", "beyond 100000 mm"},
                      Bad{"G91 G0 X60000\nX60000", ":2:1", "leads to 120000 mm"},
                      Bad{"G1 X1 F1 E99999999999", ":1:10", "beyond 1e+09 mm"}));

TEST(GcodeReader, DigitsBeyondDoublesAreNotFiniteAndTinyOnesAreZero) {
  EXPECT_THAT(rejection("G0 X1" + std::string(400, '0')), HasSubstr("needs a finite"));
  const std::string tiny = "0." + std::string(400, '0') + "1";
  EXPECT_LT(position_mm(parse("G0 X" + tiny).steps[0]).x(), 1e-300);
}

TEST(GcodeReader, MissingFileIsNamed) {
  try {
    read_gcode("/nonexistent/bottle.gcode", {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nonexistent/bottle.gcode"));
  }
}

TEST(GcodeReader, FortyThousandLinesTakeLessThanASecondOfProcessorTime) {
  std::string text = "G21 G90 M82\n";
  for (int i = 0; i < 40000; ++i)
    text += "G1 X" + std::to_string(i % 100) + ".125 Y2.25 Z40.737 W1 I0 J0 K0 E" + std::to_string(i) +
            ".5 F1500\n";
  const std::clock_t start = std::clock();
  EXPECT_EQ(parse(text).steps.size(), 40000u);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  RecordProperty("seconds", std::to_string(seconds));
  EXPECT_LT(seconds, 1);  // 0.05 s measured, 0.35 s under the address sanitizer
}

TEST(GcodeReader, AnExponentIsNoFilament) {
  const auto steps = parse("G0 X1\nG1 X1.5e1 Y-2e-06 F1e+3\n").steps;
  EXPECT_NEAR(steps[1].X_WT.translation().x(), 0.015, 1e-12);
  EXPECT_NEAR(steps[1].X_WT.translation().y(), -2e-9, 1e-15);
  EXPECT_NEAR(steps[1].feed, 1 / 60., 1e-12);
  for (const char* bad : {"X1e", "X1e-", "X1e400", "X1.e+x"})
    EXPECT_THAT([&] { parse(std::string("G0 ") + bad); },
                testing::ThrowsMessage<InputError>(HasSubstr("X needs a finite decimal number")))
        << bad;
  EXPECT_EQ(parse("G0X1\ng1x2e1f60\nG1X3E2F60\n").steps.size(), 3u) << "filament";
}

TEST(GcodeReader, ACarriageReturnEndsALineAndItsComment) {
  const Program unix = parse("G0 X1 ; here\nG1 X2 F60 (there)\nG1 X3\n");
  for (const char* text :
       {"G0 X1 ; here\rG1 X2 F60 (there)\rG1 X3\r", "G0 X1 ; here\r\nG1 X2 F60 (there)\r\nG1 X3\r\n"}) {
    const Program other = parse(text);
    ASSERT_EQ(other.steps.size(), unix.steps.size());
    for (std::size_t i = 0; i < unix.steps.size(); ++i) {
      EXPECT_EQ(other.steps[i].line, unix.steps[i].line);
      EXPECT_EQ(other.steps[i].X_WT.translation(), unix.steps[i].X_WT.translation());
    }
  }
}

TEST(GcodeReader, ALineOfMegabytesIsRefusedAtOnce) {
  std::string text = "G0 X1\n";
  for (int i = 0; i < 80'000; ++i) text += "G0 ";
  EXPECT_THAT([&] { parse(text); },
              testing::ThrowsMessage<InputError>(HasSubstr("p.gcode:2: the line has 240000 bytes")));
}

}  // namespace
}  // namespace understudy::toolpath
