// The shipped five-axis printer and its rotary words, for tests of reader, planner and check together.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "control/motion/motion_planner.h"
#include "kinematics/chain/five_axis.h"
#include "tests/control/motion/planning_for_test.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::control {

struct FiveAxisForTest {
  machine::MachineDescription machine = machine::load_machine("five-axis");
  std::unique_ptr<kinematics::Mechanism> mechanism = machine.make_mechanism();
  MotionLimits limits = motion_limits(machine);
  Pose X_WT_home = machine.X_WB * machine.X_BT_home;

  toolpath::GcodeOptions gcode() const {
    const std::vector<double>& p = machine.chain().kinematics.parameters;
    const kinematics::FiveAxisGeometry geometry{p[0], p[1], p[2], p[3]};
    toolpath::GcodeOptions options;
    options.X_WT_home = X_WT_home;
    toolpath::RotaryWords words;
    words.tip_pose = kinematics::five_axis_tip_pose;
    words.slides_pose = [geometry](const Vec3& s, double b, double c) -> Pose {
      return kinematics::five_axis_pose(geometry, {s.x(), s.y(), s.z(), b, c});
    };
    words.slides = [geometry](const Vec3& p_WT, double b, double c) -> Vec3 {
      const auto axes = kinematics::five_axis_at_tip(geometry, p_WT, b, c);
      return {axes[0], axes[1], axes[2]};
    };
    options.rotary = words;
    return options;
  }

  toolpath::Program program(const std::string& text) const {
    return toolpath::parse_gcode(text, "p.gcode", gcode());
  }

  std::vector<PlannedPoint> plan(const std::string& text) const {
    MotionPlanner planner(*mechanism, machine.X_WB, limits, {X_WT_home});
    return stream(planner, program(text).steps);
  }
};

}  // namespace understudy::control
