#include "control/compensation/compensated_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/compensation/command_map.h"
#include "core/error.h"
#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::control {
namespace {

using machine::MachineDescription;
using ::testing::HasSubstr;

toolpath::GcodeOptions options_of(const MachineDescription& machine) {
  toolpath::GcodeOptions options;
  options.X_WT_home = machine.X_WB * machine.X_BT_home;
  return options;
}

/// The struts of one side are longer than drawn: the tool leans, and its way bends.
MachineDescription bent_hexapod() {
  MachineDescription known = machine::load_machine("hexapod");
  for (std::size_t i = 0; i < 3; ++i) known.hexapod().geometry.length_offset[i] += 0.8e-3;
  return known;
}

struct Compensated {
  Compensated(const std::string& text, const CompensationTask& task)
      : program(toolpath::parse_gcode(text, "p.gcode", options_of(task.nominal))),
        moved(compensated_lines(
            program, toolpath::lines_that_place(text, "p.gcode", options_of(task.nominal)), task)) {}
  toolpath::Program program;
  toolpath::MovedLines moved;
};

TEST(CompensatedLines, EachEndIsTheCommandForWhatWasAsked) {
  const MachineDescription nominal = machine::load_machine("hexapod"), known = bent_hexapod();
  const Compensated result("G28\nG1 X5 F600\nM106 S1\nG1 X5.4 Y0.2\n", {nominal, known});
  ASSERT_EQ(result.moved.size(), 2) << "lines 2 and 4";
  CommandMap map(nominal, known);
  for (const int step : {1, 3}) {
    const toolpath::Step& asked = result.program.steps[static_cast<std::size_t>(step)];
    NominalCommand command;
    ASSERT_EQ(map.command(asked.X_WT, std::nullopt, command), kinematics::SolveStatus::ok);
    EXPECT_TRUE(result.moved.at(asked.line).back().X_WT.isApprox(command.X_WT, 1e-9));
    EXPECT_EQ(result.moved.at(asked.line).back().share, 1);
  }
}

TEST(CompensatedLines, ALongWayIsDividedUntilItKeepsItsTolerance) {
  const MachineDescription nominal = machine::load_machine("hexapod"), known = bent_hexapod();
  const std::string text = "G1 X-40 Y-20 F1200\nG1 X40 Y20\n";
  const double fine = 2e-6, coarse = 50e-6;
  const Compensated finely(text, {nominal, known, {}, fine}), coarsely(text, {nominal, known, {}, coarse});
  EXPECT_GT(finely.moved.at(2).size(), coarsely.moved.at(2).size());
  // In between, each piece is near the command for the pose that is asked for there.
  CommandMap map(nominal, known);
  NominalCommand command;
  const auto& steps = finely.program.steps;
  Pose begin = finely.moved.at(1).back().X_WT;
  double share = 0;
  for (const toolpath::MovedPiece& piece : finely.moved.at(2)) {
    const double middle = 0.5 * (share + piece.share);
    const Pose asked = interpolate(steps[0].X_WT, steps[1].X_WT, middle);
    ASSERT_EQ(map.command(asked, std::nullopt, command), kinematics::SolveStatus::ok);
    const Vec3 chord = 0.5 * (begin.translation() + piece.X_WT.translation());
    // The way is looked at every half millimetre, between which it bends by a thousandth of that.
    EXPECT_LT((chord - command.X_WT.translation()).norm(), fine + 0.5e-6);
    begin = piece.X_WT;
    share = piece.share;
  }
}

TEST(CompensatedLines, ACorrectionIsAddedToWhatIsAsked) {
  const MachineDescription nominal = machine::load_machine("hexapod");
  Twist up = Twist::Zero();
  up[2] = 0.1e-3;
  const Compensated result("G1 X5 F600\n", {nominal, nominal, [&](std::size_t, double) { return up; }});
  const Vec3 end = result.moved.at(1).back().X_WT.translation();
  EXPECT_LT((end - Vec3(5e-3, 0, 50.1e-3)).norm(), 1e-9);
}

TEST(CompensatedLines, APoseOutOfReachNamesItsLine) {
  const MachineDescription nominal = machine::load_machine("arm");
  try {
    static_cast<void>(Compensated("G1 X0 Y0 Z50 F600\nG1 X5000\n", {nominal, nominal}));
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.gcode:2: no axes of arm reach"));
  }
}

}  // namespace
}  // namespace understudy::control
