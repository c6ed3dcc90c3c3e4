// An arc is chords to the planner, which rounds no corner (gcode_curves.cpp, kArcTolerance).
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "control/motion/motion_planner.h"
#include "control/program/gcode_options.h"
#include "machine/description.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::control {
namespace {

/// [s] that a machine takes for a program about the middle of its work space.
double duration(const machine::MachineDescription& machine, const std::string& text) {
  const toolpath::Program program = toolpath::parse_gcode(text, "p.gcode", gcode_options({}, machine));
  const auto mechanism = machine.make_mechanism();
  MotionPlanner planner(*mechanism, machine.X_WB, motion_limits(machine), {machine.X_WB * machine.X_BT_home});
  PlannedPoint point;
  for (const toolpath::Step& step : program.steps) {
    planner.push(step);
    while (planner.next(point)) {
    }
  }
  planner.finish();
  while (planner.next(point)) {
  }
  return planner.time();
}

// Once round 15 mm at 20 mm/s takes as long as the circle is long, and no more than the time in which the
// tool gets up to speed and to rest again: 20 mm/s at 0.5 m/s^2, and with the arm's corners 5 % of it all.
TEST(ArcSpeed, ACircleIsPrintedAtItsFeed) {
  for (const char* name : {"hexapod", "arm"}) {
    const machine::MachineDescription machine = machine::load_machine(name);
    const Vec3 home = 1e3 * (machine.X_WB * machine.X_BT_home).translation();
    const std::string there = "G0 X" + std::to_string(home.x() + 15) + " Y" + std::to_string(home.y()) +
                              " Z" + std::to_string(home.z()) + "\n";
    const double circle = duration(machine, there + "G2 I-15 J0 E4 F1200\n") - duration(machine, there);
    const double asked = 2 * std::numbers::pi * 15 / 20;
    EXPECT_GE(circle, asked) << name;
    EXPECT_LE(circle, 1.05 * asked + 0.04) << name;
  }
}

}  // namespace
}  // namespace understudy::control
