#include "control/motion/rotary_turns.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/control/five_axis_for_test.h"

namespace understudy::control {
namespace {

using testing::HasSubstr;

/// Points on a dome, the tool across it, round and round: C passes a whole turn, B goes up to 60 degrees.
toolpath::Program spiral_on_a_dome() {
  toolpath::Program program;
  for (int k = 0; k <= 400; ++k) {
    const double tilt = 60 * kDegree * k / 400, turn = 9 * kDegree * k;
    const Vec3 n(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
    toolpath::Step step;
    step.kind = k == 0 ? toolpath::StepKind::travel : toolpath::StepKind::print;
    step.X_WT = make_pose(shortest_arc_from_z(n), Vec3(0.02 * n + Vec3(0, 0, 0.01)));
    step.feed = 0.01;
    step.filament = k == 0 ? 0 : 1e-5;
    program.steps.push_back(step);
  }
  return program;
}

TEST(RotaryTurns, ReadBackAsTheSameTipsAndToolAxes) {
  const FiveAxisForTest printer;
  const toolpath::Program planned = spiral_on_a_dome();
  const std::string text =
      toolpath::write_gcode(with_turns(planned, printer.machine), {}, rotary_style(printer.machine));
  EXPECT_NE(text.find(" B"), std::string::npos);
  EXPECT_EQ(text.find(" W"), std::string::npos);
  const toolpath::Program read = printer.program(text);
  ASSERT_EQ(read.steps.size(), planned.steps.size());
  double before = 0;
  for (std::size_t k = 0; k < planned.steps.size(); ++k) {
    const Pose &is = read.steps[k].X_WT, &meant = planned.steps[k].X_WT;
    EXPECT_LT((is.translation() - meant.translation()).norm(), 1e-6) << k;
    EXPECT_LT(is.linear().col(2).cross(meant.linear().col(2)).norm(), 1e-6) << k;
    ASSERT_TRUE(read.steps[k].rotary.has_value());
    if (k > 1) {
      EXPECT_LT(std::abs(read.steps[k].rotary->c - before), 20 * kDegree) << k << ": no leap of a turn";
    }
    before = read.steps[k].rotary->c;
  }
  EXPECT_GT(std::abs(before), 8 * 2 * std::numbers::pi) << "ten times round";
}

TEST(RotaryTurns, BeginAnewAfterHome) {
  const FiveAxisForTest printer;
  toolpath::Program planned = spiral_on_a_dome();
  toolpath::Step home;
  home.kind = toolpath::StepKind::home;
  toolpath::Step last = planned.steps[10];
  planned.steps.push_back(home);
  planned.steps.push_back(last);
  const auto turned = with_turns(planned, printer.machine).steps;
  EXPECT_FALSE(turned[turned.size() - 2].rotary.has_value());
  EXPECT_LT(std::abs(turned.back().rotary->c), 2 * std::numbers::pi);
}

TEST(RotaryTurns, NeedAMachineThatHasThem) {
  try {
    with_turns(spiral_on_a_dome(), machine::load_machine("hexapod"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("hexapod has no rotary words"));
  }
}

}  // namespace
}  // namespace understudy::control
