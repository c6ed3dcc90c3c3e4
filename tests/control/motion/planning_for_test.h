// The product's hexapod and short ways to write steps, for the tests of planner and constraint check.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "control/motion/motion_planner.h"
#include "core/units.h"

namespace understudy::control {

/// The shipped machine's geometry, with the dynamics that the tests' figures are worked out for: tuning the
/// product must not move them.
inline machine::MachineDescription hexapod_of_known_dynamics() {
  machine::MachineDescription m = machine::load_machine("hexapod");
  for (machine::Drive& drive : m.drives) {
    drive.velocity_max = 0.060;
    drive.acceleration_max = 2.0;
  }
  m.acceleration = 1.0;
  m.travel_velocity = 0.050;
  m.orientation_velocity = from_deg(60);
  m.cycle_time = 1e-3;
  return m;
}

/// That machine with its tool at home; `at` is relative to home in W.
struct HexapodForTest {
  machine::MachineDescription machine = hexapod_of_known_dynamics();
  std::unique_ptr<kinematics::Mechanism> mechanism = machine.make_mechanism();
  MotionLimits limits = motion_limits(machine);
  Pose X_WT_home = machine.X_WB * machine.X_BT_home;

  Pose at(const Vec3& p, const Vec3& turn = Vec3::Zero()) const {
    return make_pose(Mat3(exp_rotation(turn) * X_WT_home.linear()), X_WT_home.translation() + p);
  }

  std::unique_ptr<kinematics::Mechanism> with_limits(const kinematics::HexapodLimits& l) const {
    return kinematics::make_hexapod(machine.hexapod().geometry, machine.hexapod().joints, l,
                                    machine.X_BT_home);
  }

  toolpath::Step step(toolpath::StepKind kind, const Pose& X_WT, double feed, int line) const {
    toolpath::Step s;
    s.kind = kind;
    s.X_WT = X_WT;
    s.feed = feed;
    s.line = line;
    return s;
  }
  toolpath::Step print_to(const Pose& X_WT, double feed, int line, double filament = 0) const {
    toolpath::Step s = step(toolpath::StepKind::print, X_WT, feed, line);
    s.filament = filament;
    return s;
  }

  MotionPlanner planner(double start_time = 0, PoseCheck check = PoseCheck::limits) const {
    return {*mechanism, machine.X_WB, limits, MotionStart{X_WT_home, start_time}, check};
  }
};

/// Only the shortest strut counts, which lets the platform turn far about the tool.
inline kinematics::HexapodLimits limits_of_turning(double strut_min) {
  kinematics::HexapodLimits l;
  l.strut_min = strut_min, l.strut_max = 1;
  l.base_alpha_min = l.ball_min = -10, l.base_alpha_max = l.base_beta_max = l.ball_max = 10;
  l.condition_max = kinematics::kSingularCondition;
  return l;
}

inline void take_all(MotionPlanner& planner, std::vector<PlannedPoint>& points) {
  PlannedPoint point;
  while (planner.next(point)) points.push_back(point);
}

/// Pushes, takes what is ready after each push as the print loop does, finishes.
inline std::vector<PlannedPoint> stream(MotionPlanner& planner, const std::vector<toolpath::Step>& steps) {
  std::vector<PlannedPoint> points;
  for (const auto& step : steps) {
    planner.push(step);
    take_all(planner, points);
  }
  planner.finish();
  take_all(planner, points);
  return points;
}

}  // namespace understudy::control
