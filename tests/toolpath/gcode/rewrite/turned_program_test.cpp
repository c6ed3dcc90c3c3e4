#include "toolpath/gcode/rewrite/turned_program.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace understudy::toolpath {
namespace {

class TurnedProgram : public testing::Test {
 protected:
  Program read(const std::string& text, const ProgramTurn& by, GcodeOptions options = {}) const {
    options.X_WT_home = make_pose(Quat::Identity(), Vec3(0.01, 0.02, 0.05));
    return parse_turned_gcode(text, "p.gcode", options, by);
  }
};

constexpr double kQuarter = 90 * kDegree;

// By hand: a quarter turn takes x to y, and the axis that leans towards x leans towards y.
TEST_F(TurnedProgram, IsTheProgramWrittenInTurnedCoordinates) {
  const char* given = "G0 X30 Y10 Z5 I0.6 J0 K0.8\nG1 X-4 F600 E1\nG2 X6 Y10 I5 J0 E2\n";
  const char* by_hand = "G0 X-10 Y30 Z5 I0 J0.6 K0.8\nG1 Y-4 F600 E1\nG2 X-10 Y6 I0 J5 E2\n";
  const Program turned = read(given, {kQuarter, 0}), expected = read(by_hand, {});
  ASSERT_EQ(turned.steps.size(), expected.steps.size());
  for (std::size_t i = 0; i < turned.steps.size(); ++i)
    EXPECT_TRUE(turned.steps[i].X_WT.isApprox(expected.steps[i].X_WT, 1e-12)) << "step " << i;
}

TEST_F(TurnedProgram, TurnsAboutItsOrigin) {
  GcodeOptions options;
  options.offset_W = Vec3(0.1, 0.2, 0.003);
  const Program turned = read("G0 X10 Y0 Z0\n", {kQuarter, 0}, options);
  EXPECT_TRUE(turned.steps.back().X_WT.translation().isApprox(Vec3(0.1, 0.21, 0.003), 1e-12));
}

TEST_F(TurnedProgram, HomeStaysAndWordsThatAreLeftOutAreThoseOfHome) {
  const Program turned = read("G28\nG4 P10\nG0 Z5\nG0 X0 Y0\nG28\n", {kQuarter, kQuarter});
  const Vec3 home(0.01, 0.02, 0.05);
  EXPECT_TRUE(turned.steps[0].X_WT.isApprox(make_pose(Quat::Identity(), home), 0));
  EXPECT_TRUE(turned.steps[1].X_WT.isApprox(turned.steps[0].X_WT, 0)) << "a dwell does not turn the tool";
  EXPECT_TRUE(turned.steps[2].X_WT.translation().isApprox(Vec3(0.01, 0.02, 0.005), 1e-12));
  EXPECT_TRUE(turned.steps[3].X_WT.translation().isApprox(Vec3(0, 0, 0.005), 1e-12));
  EXPECT_TRUE(turned.steps[4].X_WT.isApprox(turned.steps[0].X_WT, 0));
}

TEST_F(TurnedProgram, SpinTurnsTheToolAboutItsOwnAxisAlone) {
  const Program spun = read("G0 X1 Y2 Z3 I0.6 J0 K0.8\n", {0, kQuarter}),
                plain = read("G0 X1 Y2 Z3 I0.6 J0 K0.8\n", {});
  const Pose off = plain.steps.back().X_WT.inverse() * spun.steps.back().X_WT;
  EXPECT_TRUE(off.isApprox(make_pose(exp_rotation(kQuarter * Vec3::UnitZ()), Vec3(0, 0, 0)), 1e-12));
}

TEST_F(TurnedProgram, RotaryWordsAreRefused) {
  GcodeOptions options;
  options.rotary = RotaryWords{};
  options.rotary->tip_pose = [](const Vec3& p, double b, double c) -> Pose {
    return make_pose(Mat3(exp_rotation(c * Vec3::UnitZ()) * exp_rotation(b * Vec3::UnitY())), p);
  };
  EXPECT_THROW(read("G0 X1 B10 C20\n", {kQuarter, 0}, options), InputError);
  EXPECT_NO_THROW(read("G0 X1\n", {kQuarter, 0}, options)) << "its table stands still";
}

}  // namespace
}  // namespace understudy::toolpath
