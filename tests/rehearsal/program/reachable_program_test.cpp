#include "rehearsal/program/reachable_program.h"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

struct Checked {
  Reach reach;
  std::vector<double> x_mm;  // of moves
};

/// On the arm, of which no pose is 5 m away.
Checked checked(const std::string& text, bool keep = false) {
  const auto machine = machine::load_machine("arm");
  toolpath::GcodeOptions options;
  options.X_WT_home = machine.X_WB * machine.X_BT_home;
  toolpath::Program program = toolpath::parse_gcode(text, "p.gcode", options);
  Checked result{check_reach(program, machine, keep), {}};
  for (const toolpath::Step& step : program.steps)
    if (toolpath::moves(step)) result.x_mm.push_back(std::round(to_mm(step.X_WT.translation().x())));
  return result;
}

const std::string kThere = "G0 X0 Y0 Z20\nG1 X10 F3000\nG1 X5000\nG1 X20\nG1 X30\n";

TEST(ReachableProgram, MovesThatNoAxesMakeAreLeftOutAndTold) {
  const Checked c = checked(kThere);
  EXPECT_THAT(c.x_mm, ElementsAre(0, 10, 20, 30));
  EXPECT_THAT(c.reach.passed_over, ElementsAre(Pair(3, 4)));
  ASSERT_FALSE(c.reach.findings.empty());
  EXPECT_EQ(c.reach.findings[0].severity, Severity::error);
  EXPECT_EQ(c.reach.findings[0].gcode_line, 3);
  EXPECT_THAT(c.reach.findings[0].message, HasSubstr("passed over, and the rest simulated"));
}

TEST(ReachableProgram, ALastMoveIsLeftOutWithNothingInItsPlace) {
  const Checked c = checked("G0 X0 Y0 Z20\nG1 X10 F3000\nG0 X5000\n");
  EXPECT_THAT(c.x_mm, ElementsAre(0, 10));
  EXPECT_THAT(c.reach.passed_over, ElementsAre(Pair(3, 3)));
}

TEST(ReachableProgram, StaysWhereItIsToBeKeptOrNothingIsLeft) {
  EXPECT_THAT(checked(kThere, true).x_mm, ElementsAre(0, 10, 5000, 20, 30));
  EXPECT_THAT(checked(kThere, true).reach.passed_over, IsEmpty());
  EXPECT_THAT(checked("G0 X5000\n").x_mm, ElementsAre(5000));
  EXPECT_THAT(checked("G0 X0 Y0 Z20\nG1 X10 F3000\n").reach.findings, IsEmpty());
}

}  // namespace
}  // namespace understudy::rehearsal
