// A stranger's five-axis program of 41 534 moves, where it is at hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "control/motion/constraint_check.h"
#include "tests/control/five_axis_for_test.h"

namespace understudy::control {
namespace {

const std::filesystem::path kProgram =
    UNDERSTUDY_SOURCE_DIR "/../shared/data/five-axis-gcode/simple_curve.gcode";

/// Its words are slides of axes that cross at its origin, 40 mm below the table's top, and count the other
/// way round (docs/gcode.md).
toolpath::GcodeOptions dialect(const FiveAxisForTest& printer) {
  toolpath::GcodeOptions options = printer.gcode();
  options.rotary->coordinates = toolpath::RotaryWords::Coordinates::crossing;
  options.b_sign = options.c_sign = -1;
  options.offset_W = Vec3(0, 0, -0.040);
  return options;
}

/// [m], the longest way between lines on end that feed filament.
double longest_print(const toolpath::Program& program) {
  double longest = 0;
  for (std::size_t k = 1; k < program.steps.size(); ++k) {
    const auto &before = program.steps[k - 1], &now = program.steps[k];
    if (before.feed == 0) continue;  // filament pressed out at rest: the way down to the work comes after it
    if (before.kind == toolpath::StepKind::print && now.kind == toolpath::StepKind::print)
      longest = std::max(longest, (now.X_WT.translation() - before.X_WT.translation()).norm());
  }
  return longest;
}

TEST(FiveAxisProgram, ItsRowsAreEvenOnlyWithItsOwnSignsAndCoordinates) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << kProgram << " is not there";
  const FiveAxisForTest printer;
  const auto program = toolpath::read_gcode(kProgram, dialect(printer));
  // G1, of which 20 only set a feed, G0 and G28.
  EXPECT_EQ(std::count_if(program.steps.begin(), program.steps.end(), toolpath::moves), 41534 - 20 + 81 + 1);
  // Points of a row are 0.8 mm apart and rows not much more: where the words are read as they were meant, no
  // print jumps. Computed apart from this code: 1.58 mm, and from 22 to 63 mm for every other reading.
  EXPECT_LT(longest_print(program), 1.6e-3);
  EXPECT_GT(longest_print(toolpath::read_gcode(kProgram, printer.gcode())), 20e-3);
  auto wrong = dialect(printer);
  wrong.c_sign = 1;
  EXPECT_GT(longest_print(toolpath::read_gcode(kProgram, wrong)), 20e-3);
}

TEST(SlowFiveAxisProgram, IsCheckedWholeWithoutAnError) {
  if (!std::filesystem::exists(kProgram)) GTEST_SKIP() << kProgram << " is not there";
  const FiveAxisForTest printer;
  const auto report = check_constraints(toolpath::read_gcode(kProgram, dialect(printer)), printer.machine);
  for (const ConstraintFinding& finding : report.findings)  // that C is too slow for a feed is no error
    EXPECT_EQ(finding.violation.kind, kinematics::LimitKind::axis_velocity)
        << finding.line << ": " << to_string(finding.violation);
  EXPECT_GT(report.duration, 37e3 / 25);  // [s], more than its 37 m of path at 25 mm/s
}

}  // namespace
}  // namespace understudy::control
