// Each expected program is written by hand from the words of the dialect (docs/gcode.md).
#include "toolpath/gcode/rewrite/gcode_rewrite.h"

#include <cmath>

#include <fmt/format.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

GcodeOptions upright_home() {
  GcodeOptions options;
  options.X_WT_home = make_pose(Mat3(Mat3::Identity()), Vec3(0, 0, 0.05));
  return options;
}

Pose at(double x_mm, double y_mm, double z_mm) {
  return make_pose(Mat3(Mat3::Identity()), Vec3(from_mm(x_mm), from_mm(y_mm), from_mm(z_mm)));
}

std::string rewritten(const std::string& text, const MovedLines& moved) {
  return rewrite_gcode(text, "p.gcode", upright_home(), moved);
}

TEST(GcodeRewrite, ALineKeepsAllButItsPlace) {
  EXPECT_EQ(
      rewritten("; head\nN5 G1 X1 Y2 (here) E0.5 F600 ; bead\nM117 done\r\n", {{2, {{at(1.25, 2, 50.5)}}}}),
      "; head\nN5 G1 X1.25 Y2 Z50.5 (here) E0.5 F600 ; bead\nM117 done\r\n");
}

TEST(GcodeRewrite, ALineThatGoesNowhereElseStaysByteForByte) {
  const std::string text = "\xef\xbb\xbfg21\ng1 x1.50 f600\n\nM106 S10\n";
  EXPECT_EQ(rewritten(text, {}), text);
}

TEST(GcodeRewrite, MissingCoordinatesFollowThoseThatAreThere) {
  EXPECT_EQ(rewritten("G1 F600 Y2\n", {{1, {{at(0.1, 2, 50)}}}}), "G1 F600 Y2 X0.1 Z50\n");
  EXPECT_EQ(rewritten("G1 X1 F600\nY3\n", {{2, {{at(1, 3.5, 50)}}}}), "G1 X1 F600\nY3.5 X1 Z50\n");
}

TEST(GcodeRewrite, PiecesShareFilamentAndSayWhoseTheyAre) {
  const MovedLines moved{{2, {{at(1, 0.1, 50), {}, 0.25}, {at(4, 0, 50), {}, 1}}}};
  EXPECT_EQ(rewritten("G92 E10\nG1 X4 E12 F600 ; long\n", moved),
            "G92 E10\nG1 X1 Y0.1 Z50 E10.5 F600 ; long\nX4 Y0 Z50 E12 ; 2/2 of line 2\n");
  EXPECT_EQ(rewritten("M83\nG1 X4 E2 F600\n", moved),
            "M83\nG1 X1 Y0.1 Z50 E0.5 F600\nX4 Y0 Z50 E1.5 ; 2/2 of line 2\n");
}

TEST(GcodeRewrite, UnderG93EachPieceHasItsShareOfTheTime) {
  EXPECT_EQ(rewritten("G93\nG1 X4 F30\n", {{2, {{at(1, 0, 50), {}, 0.25}, {at(4, 0, 50), {}, 1}}}}),
            "G93\nG1 X1 Y0 Z50 F120\nX4 Y0 Z50 F40 ; 2/2 of line 2\n");
}

TEST(GcodeRewrite, RelativeWordsCountFromWhereTheRewrittenProgramIs) {
  EXPECT_EQ(rewritten("G91\nG1 X1 F600\nG1 X1\n", {{2, {{at(1.5, 0, 50)}}}, {3, {{at(2, 0.25, 50)}}}}),
            "G91\nG1 X1.5 Y0 Z0 F600\nG1 X0.5 Y0.25 Z0\n");
  // The mode may stand on the line itself.
  EXPECT_EQ(rewritten("G1 X1 F600\nG91 G1 X1\n", {{1, {{at(1.5, 0, 50)}}}, {2, {{at(2, 0, 50)}}}}),
            "G1 X1.5 Y0 Z50 F600\nG91 G1 X0.5 Y0 Z0\n");
}

TEST(GcodeRewrite, InchesAndShiftsCount) {
  EXPECT_EQ(rewritten("G20\nG1 X1 F60\n", {{2, {{at(12.7, 0, 50.8)}}}}), "G20\nG1 X0.5 Y0 Z2 F60\n");
  EXPECT_EQ(rewritten("G92 X10\nG1 X11 F600\n", {{2, {{at(1.5, 0, 50)}}}}),
            "G92 X10\nG1 X11.5 Y0 Z50 F600\n");
  EXPECT_EQ(rewritten("G10 L2 P1 X5\nG54\nG53 G0 X1\n", {{3, {{at(1.5, 0, 50)}}}}),
            "G10 L2 P1 X5\nG54\nG53 G0 X1.5 Y0 Z50\n");
}

TEST(GcodeRewrite, AnArcBecomesStraightMovesAndLeavesNoWordBehind) {
  const MovedLines moved{{2, {{at(5, 5, 50), {}, 0.5}, {at(10, 0, 50), {}, 1}}}};
  EXPECT_EQ(rewritten("G17\nG2 X10 Y0 I5 J0 E1 F600 ; round\n", moved),
            "G17\nG1 X5 Y5 Z50 E0.5 F600 ; round\nX10 Y0 Z50 E1 ; 2/2 of line 2\n");
  // A modal arc has no command of its own.
  const MovedLines two{{1, {{at(10, 0, 50)}}}, {2, {{at(0, 0, 50)}}}};
  EXPECT_EQ(rewritten("G2 X10 I5 F600\nX0 I-5\n", two), "G1 X10 Y0 Z50 F600\nX0 G1 Y0 Z50\n");
}

TEST(GcodeRewrite, OrientationIsWrittenWhereItIsNotThatOfBefore) {
  const double half = 0.5 * std::asin(0.6);
  Pose leaning = at(1, 0, 50);
  leaning.linear() = Eigen::AngleAxisd(std::asin(0.6), Vec3::UnitY()).toRotationMatrix();
  const std::string text =
      rewritten("G1 X1 F600\nG1 X2 I0 J0 K1\n", {{1, {{leaning}}}, {2, {{at(2, 0, 50)}}}});
  EXPECT_EQ(text, fmt::format("G1 X1 Y0 Z50 W{:.9f} I0 J{:.9f} K0 F600\nG1 X2 I0 J0 K0 Y0 Z50 W1\n",
                              std::cos(half), std::sin(half)));
}

TEST(GcodeRewrite, LinesThatPlaceAreThoseWhoseOwnWordsDo) {
  EXPECT_THAT(
      lines_that_place(
          "G28\nG1 F600\nG1 X1\nM83\nG1 E1\nG92 X0\nG2 X2 I1\nG4 P10\nG0 Z60\nG28 X0\nM221 X0 Y0 Z0\n",
          "p.gcode", upright_home()),
      ElementsAre(3, 7, 9));
}

TEST(GcodeRewrite, ReadingTheResultGivesTheProgramThatWasAskedFor) {
  const MovedLines moved{{1, {{at(1.0000004, 2, 50), {}, 0.5}, {at(3, 2, 51), {}, 1}}}};
  const Program program = parse_gcode(rewritten("G1 X3 Y2 Z51 E1 F600", moved), "p.gcode", upright_home());
  ASSERT_EQ(program.steps.size(), 2);
  // Written with 1e-6 mm.
  EXPECT_NEAR(program.steps[0].X_WT.translation().x(), 1.0000004e-3, 0.51e-9);
  EXPECT_NEAR(program.steps[0].filament, 0.5e-3, 1e-12);
  EXPECT_NEAR(program.steps[1].filament, 0.5e-3, 1e-12);
  EXPECT_EQ(program.steps[1].line, 2);
}

TEST(GcodeRewrite, KnowsItsContinuations) {
  EXPECT_TRUE(is_continuation("X4 Y0 " + continuation_comment(2, 12, 1307)));
  EXPECT_FALSE(is_continuation("G1 X4 ; 2/2 of the line"));
  EXPECT_FALSE(is_continuation("G1 X4"));
}

TEST(GcodeRewrite, APoseThatTheWordsCannotSayIsRefusedByItsLine) {
  GcodeOptions options = upright_home();
  options.rotary.emplace();  // one machine whose tip pose ignores what it is told
  options.rotary->letters = "B";
  options.rotary->tip_pose = [](const Vec3&, double, double) { return at(7, 7, 7); };
  try {
    static_cast<void>(
        rewrite_gcode("G1 X1 B0 F600\n", "p.gcode", options, {{1, {{at(2, 0, 50), RotaryTurns{}}}}}));
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.gcode:1: the words of this line cannot say"));
  }
}

}  // namespace
}  // namespace understudy::toolpath
