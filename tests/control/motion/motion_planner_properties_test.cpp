// What the planner promises of every program: limits, continuity, feeds, and that all of it is run.
#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "tests/control/five_axis_for_test.h"
#include "tests/control/motion/planning_for_test.h"
#include "tests/property.h"

namespace understudy::control {
namespace {

using property::magnitude;
using property::real;
using property::whole;
using toolpath::Step;
using toolpath::StepKind;

const HexapodForTest& hexapod() {
  static const HexapodForTest machine;
  return machine;
}

MotionLimits drawn_limits() {
  MotionLimits limits = hexapod().limits;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    limits.axis_velocity[i] = *magnitude(0.01, 0.06);
    limits.axis_acceleration[i] = *magnitude(0.2, 4);
    limits.velocity_jump[i] = *rc::gen::element(0.0, 1.0) * *magnitude(1e-4, 5e-3);
  }
  limits.tip_acceleration = *magnitude(0.2, 4);
  limits.travel_velocity = *magnitude(0.01, 0.1);
  limits.orientation_velocity = *magnitude(0.2, 2);
  limits.cycle_time = *rc::gen::element(1e-3, 2e-3);
  return limits;
}

/// Within 12 mm and 6 degrees of home. Steps of 10 um to some millimetres, turns with them or alone, feeds as
/// speeds and as times, dwells, filament fed at rest.
std::vector<Step> drawn_program(int count) {
  std::vector<Step> steps;
  Vec3 p(0, 0, 0), turn(0, 0, 0);
  for (int n = 1; n <= count; ++n) {
    const int kind = *whole(0, 9);
    const double size = *magnitude(1e-5, 5e-3);
    if (kind < 8) p = (p + *property::vector(size)).cwiseMax(-0.012).cwiseMin(0.012);
    if (kind < 8 && *whole(0, 1) == 1)
      turn = (turn + *property::vector(20 * size)).cwiseMax(-0.1).cwiseMin(0.1);
    Step step = hexapod().print_to(hexapod().at(p, turn), *magnitude(2e-3, 0.15), n, *real(0, 1e-4));
    if (kind == 0) step.kind = StepKind::travel, step.filament = 0;
    if (kind == 1) step.kind = StepKind::move, step.filament = 0;
    if (kind == 2) step.feed = 0, step.duration = *magnitude(1e-3, 0.5);
    if (kind == 8) step.kind = StepKind::dwell, step.filament = 0, step.duration = *magnitude(1e-4, 0.3);
    if (kind == 9) step.filament = *real(-1e-3, 1e-3);
    steps.push_back(step);
  }
  return steps;
}

std::vector<PlannedPoint> plan(const MotionLimits& limits, const std::vector<Step>& steps) {
  MotionPlanner planner(*hexapod().mechanism, hexapod().machine.X_WB, limits, {hexapod().X_WT_home, 0.5});
  return stream(planner, steps);
}

/// What the port sees from cycle to cycle. Slopes are taken as linear over a piece of path, and where a cycle
/// passes several corners the tip speeds up a little between them: 2 % of an acceleration.
void within_limits(const MotionLimits& limits, const PlannedPoint& from, const PlannedPoint& to, int axes) {
  const auto &a = from.setpoint, &b = to.setpoint;
  const double T = limits.cycle_time;
  for (std::size_t i = 0; i < static_cast<std::size_t>(axes); ++i) {
    const double v_max = limits.axis_velocity[i] * 1.001;
    const double change = 1.02 * limits.axis_acceleration[i] * T + 1.001 * limits.velocity_jump[i];
    if (std::abs(b.velocity[i]) <= v_max && std::abs(b.position[i] - a.position[i]) <= v_max * T &&
        std::abs(b.velocity[i] - a.velocity[i]) <= change)
      continue;
    RC_FAIL(fmt::format("axis {} at {} s, line {}: velocity {} to {} of {}, change {} of {}", i + 1, b.time,
                        b.line, a.velocity[i], b.velocity[i], limits.axis_velocity[i],
                        b.velocity[i] - a.velocity[i], change));
  }
  RC_ASSERT(angle_between(from.X_WT.linear(), to.X_WT.linear()) <
            limits.orientation_velocity * T * (1 + 1e-6) + 1e-7);  // acos near 1
}

/// [m/s], of the tip, that a step may reach.
double fastest(const Step& step, const Pose& from, const MotionLimits& limits) {
  if (step.kind == StepKind::travel) return limits.travel_velocity;
  const double way = (step.X_WT.translation() - from.translation()).norm();
  return step.duration > 0 ? way / step.duration : step.feed;
}

TEST(MotionPlannerProperties, NoAxisExceedsItsVelocityOrAccelerationInAnyCycle) {
  property::check({200, 60}, [] {
    const MotionLimits limits = drawn_limits();
    const auto points = plan(limits, drawn_program(*rc::gen::inRange(1, 40)));
    for (std::size_t n = 1; n < points.size(); ++n)
      within_limits(limits, points[n - 1], points[n], kinematics::kStruts);
    // It begins and ends at rest.
    if (points.empty()) return;
    PlannedPoint before;
    before.X_WT = hexapod().X_WT_home;
    RC_ASSERT(hexapod().mechanism->inverse(hexapod().machine.X_WB.inverse() * before.X_WT, {},
                                           before.setpoint.position) == kinematics::SolveStatus::ok);
    within_limits(limits, before, points.front(), kinematics::kStruts);
    for (const double v : points.back().setpoint.velocity) RC_ASSERT(v == 0);
  });
}

TEST(MotionPlannerProperties, TheTipIsNeverFasterThanProgrammedAndEveryStepTakesItsTime) {
  property::check({200, 60}, [] {
    const MotionLimits limits = drawn_limits();
    const std::vector<Step> steps = drawn_program(*rc::gen::inRange(1, 40));
    const auto points = plan(limits, steps);
    const auto start_of = [&](std::size_t step) {
      return step == 0 ? hexapod().X_WT_home : steps[step - 1].X_WT;
    };
    for (std::size_t n = 1; n < points.size(); ++n) {
      double speed = 0;
      for (std::size_t k = points[n - 1].step; k <= points[n].step; ++k)
        speed = std::max(speed, fastest(steps[k], start_of(k), limits));
      const double way = (points[n].X_WT.translation() - points[n - 1].X_WT.translation()).norm();
      RC_ASSERT(way <= speed * limits.cycle_time * (1 + 1e-6) + 1e-12);
    }
    double least = 0;  // [s]
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const Step& step = steps[k];
      const double way = (step.X_WT.translation() - start_of(k).translation()).norm();
      const bool still = way == 0 && angle_between(step.X_WT.linear(), start_of(k).linear()) < 1e-9;
      if (step.kind == StepKind::dwell) least += step.duration;
      if (moves(step) && still && step.duration == 0 && step.kind != StepKind::travel)
        least += std::abs(step.filament) / step.feed;
      if (moves(step) && !still) least += way / std::max(1e-9, fastest(step, start_of(k), limits));
    }
    const double took = points.empty() ? 0 : points.back().setpoint.time - 0.5;
    RC_ASSERT(took >= least * (1 - 1e-9) - 1e-9);
  });
}

TEST(MotionPlannerProperties, EveryStepIsRunInOrderToThePoseAndTheFilamentOfTheProgramsEnd) {
  property::check({200, 60}, [] {
    const MotionLimits limits = drawn_limits();
    const std::vector<Step> steps = drawn_program(*rc::gen::inRange(1, 40));
    const auto points = plan(limits, steps);
    double fed = 0;
    for (const Step& step : steps) fed += step.filament;
    if (points.empty()) {
      RC_ASSERT((steps.back().X_WT.matrix() - hexapod().X_WT_home.matrix()).norm() < 1e-9);
      return;
    }
    std::size_t step = 0;
    double fraction = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
      const PlannedPoint& p = points[n];
      RC_ASSERT(p.step > step || (p.step == step && p.fraction >= fraction));
      step = p.step, fraction = p.fraction;
      RC_ASSERT(p.fraction >= 0 && p.fraction <= 1);
      RC_ASSERT(p.setpoint.line == steps[step].line);
      RC_ASSERT(std::abs(p.setpoint.time - (0.5 + static_cast<double>(n + 1) * limits.cycle_time)) < 1e-9);
      const Pose from = step == 0 ? hexapod().X_WT_home : steps[step - 1].X_WT;
      const Pose expected = interpolate(from, steps[step].X_WT, p.fraction);
      RC_ASSERT((p.X_WT.matrix() - expected.matrix()).cwiseAbs().maxCoeff() < 1e-12);
    }
    RC_ASSERT((points.back().X_WT.matrix() - steps.back().X_WT.matrix()).cwiseAbs().maxCoeff() < 1e-12);
    RC_ASSERT(std::abs(points.back().setpoint.filament - fed) < 1e-12);
  });
}

// Programs in tip coordinates with B and C: the table turns without end while the tip runs over the work.
TEST(MotionPlannerProperties, RotaryProgramsKeepTheLimitsOfEveryAxisAndEndWhereTheySay) {
  property::check({60, 40}, [] {
    static const FiveAxisForTest printer;
    const int feed = *whole(300, 9000);  // [mm/min]
    std::string text = fmt::format("G1 F{}\n", feed);
    Vec3 p(0, 0, 30);
    double b = 0, c = 0;
    for (int n = *rc::gen::inRange(1, 25); n > 0; --n) {
      p = (p + *property::vector(*magnitude(0.02, 10)))
              .cwiseMax(Vec3(-25, -25, 15))
              .cwiseMin(Vec3(25, 25, 45));
      if (*whole(0, 2) > 0) b = *real(-30, 30);
      if (*whole(0, 2) > 0) c += *real(-40, 40);
      text += fmt::format("G1 X{:.4f} Y{:.4f} Z{:.4f} B{:.4f} C{:.4f}\n", p.x(), p.y(), p.z(), b, c);
    }
    RC_LOG() << text;
    const auto points = printer.plan(text);
    MotionLimits limits = printer.limits;
    limits.orientation_velocity = 1e9;  // the table spins under the tool; its axis is looked at below
    for (std::size_t n = 1; n < points.size(); ++n) {
      within_limits(limits, points[n - 1], points[n], 5);
      const PlannedPoint &from = points[n - 1], &to = points[n];
      const double way = (to.X_WT.translation() - from.X_WT.translation()).norm();
      if (from.setpoint.line > 1) RC_ASSERT(way <= feed / 60e3 * limits.cycle_time * (1 + 1e-3) + 1e-12);
      RC_ASSERT((tool_axis(to.X_WT) - tool_axis(from.X_WT)).norm() <=
                printer.limits.orientation_velocity * limits.cycle_time * (1 + 1e-3));
    }
    if (points.empty()) return;
    // Printed with four decimals: the end is that of the text to its last digit.
    RC_ASSERT((points.back().X_WT.translation() * 1e3 - p).cwiseAbs().maxCoeff() < 0.51e-4);
    RC_ASSERT(std::abs(points.back().setpoint.position[3] - from_deg(b)) < from_deg(0.51e-4));
    RC_ASSERT(std::abs(points.back().setpoint.position[4] - from_deg(c)) < from_deg(0.51e-4));
  });
}

}  // namespace
}  // namespace understudy::control
