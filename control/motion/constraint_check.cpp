#include "control/motion/constraint_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "control/motion/path_kinematics.h"
#include "control/motion/timed_plan.h"
#include "core/error.h"
#include "core/interrupt.h"

namespace understudy::control {

using kinematics::LimitKind;
using kinematics::LimitViolation;
using kinematics::SolveStatus;
using toolpath::Step;
using toolpath::StepKind;

namespace {

constexpr double kFeedLeft =
    0.5;  // of the programmed feed; with less, the print is not the one that was asked for

struct Found {
  ConstraintFinding finding;
  PathLocation at;
};

// Moves one after the other in which one part breaks one limit.
struct Run {
  bool begun = false;
  std::size_t found = 0;
  std::size_t move = 0;  // the last, counted
};

double excess(const LimitViolation& v) { return std::abs(v.value - v.limit); }

class Checker {
 public:
  Checker(const toolpath::Program& program, const machine::MachineDescription& machine, double step)
      : program_(program),
        step_(step),
        mechanism_(machine.make_mechanism()),
        X_BW_(machine.X_WB.inverse()),
        limits_(motion_limits(machine)),
        path_(*mechanism_, machine.X_WB),
        plan_(machine, limits_),
        X_WT_(machine.X_WB * machine.X_BT_home) {
    report_.axis_min.fill(std::numeric_limits<double>::infinity());
    report_.axis_max.fill(-std::numeric_limits<double>::infinity());
  }

  ConstraintReport run() {
    note_pose(X_WT_, path_.axes(X_WT_, axes_), 0, {});
    ++moves_;  // home is no line of the program
    for (const Step& step : program_.steps) {
      if (step.kind == StepKind::end) break;
      stop_if_interrupted();
      walk(step);
      if (plannable_) plan_.add(step);
      ++walked_;
    }
    plan_.finish();
    return finish();
  }

 private:
  // Every pose of the step, against every limit of a pose; the speed that its feed asks of the axes.
  void walk(const Step& step) {
    if (!toolpath::moves(step)) return;
    const PathSegment segment = path_.segment(step, X_WT_, axes_, limits_);
    if (!segment.moves()) return;
    ++moves_;
    if (const auto first = path_.self_motion_before(segment, axes_)) axes_ = first->self_motion->to;
    const bool programmed_feed = step.kind == StepKind::move || step.kind == StepKind::print;
    const int parts = parts_of(segment, step_, kCheckTurn);
    if (!at_possible_) refuse_step();  // it begins where no axes reach
    for (int k = 1; k <= parts; ++k) {
      const kinematics::AxisVector before = axes_;
      const double fraction = static_cast<double>(k) / parts, s = fraction * segment.length;
      const PathLocation at{walked_, fraction};
      at_possible_ = note_pose(path_.pose_at(segment, s), path_.axes_at(segment, s, axes_), step.line, at);
      if (!at_possible_) continue;
      if (!segment.rotary) note_leap(before, step.line, at);
      if (programmed_feed) note_speed(segment, s, at);
    }
    X_WT_ = segment.X_WT_end;
  }

  bool note_pose(const Pose& X_WT, SolveStatus status, int line, const PathLocation& at) {
    const Pose X_BT = X_BW_ * X_WT;
    violations_.clear();
    mechanism_->check(X_BT,
                      status == SolveStatus::ok ? std::span<const double>(axes_) : std::span<const double>(),
                      violations_);
    for (const LimitViolation& violation : violations_) note({violation, line}, at);
    if (status != SolveStatus::ok) {
      if (violations_.empty()) note({{LimitKind::unreachable, "tool pose", 0, 0, ""}, line}, at);
      refuse_step();
      return false;
    }
    for (std::size_t i = 0; i < axis_count(); ++i) {
      report_.axis_min[i] = std::min(report_.axis_min[i], axes_[i]);
      report_.axis_max[i] = std::max(report_.axis_max[i], axes_[i]);
    }
    report_.condition_worst = std::max(report_.condition_worst, mechanism_->condition_number(X_BT, axes_));
    return true;
  }

  /// No path through here: the planner would refuse it.
  void note_leap(const kinematics::AxisVector& before, int line, const PathLocation& at) {
    const auto [axis, turn] = path_.largest_turn(before, axes_);
    if (turn <= kMaxAxisJump) return;
    note({{LimitKind::singularity, "axis " + mechanism_->axis_name(axis), turn, kMaxAxisJump, "rad"}, line},
         at);
    refuse_step();
  }

  void note_speed(const PathSegment& segment, double s, const PathLocation& at) {
    if (!std::isfinite(segment.speed)) return;  // a spin under a tip at rest: no feed asks for any speed
    ChannelArray slope{};
    if (path_.evaluate(segment, s, axes_, slope) != SolveStatus::ok) return;
    for (std::size_t i = 0; i < axis_count(); ++i) {
      const double needed = std::abs(slope[i]) * segment.speed, limit = limits_.axis_velocity[i];
      if (limit >= kFeedLeft * needed) continue;
      const int axis = static_cast<int>(i);
      const bool angle = mechanism_->axis_is_angle(axis);
      ConstraintFinding finding{{LimitKind::axis_velocity, "axis " + mechanism_->axis_name(axis), needed,
                                 limit, angle ? "rad/s" : "m/s"},
                                segment.line};
      finding.reduced_feed = limit / needed;
      note(std::move(finding), at);
    }
  }

  // The worst of a kind and part stays, over lines that follow each other.
  void note(ConstraintFinding finding, const PathLocation& at) {
    finding.last_line = finding.line;
    Run& run = runs_[{finding.violation.kind, finding.violation.part}];
    const bool goes_on = run.begun && moves_ <= run.move + 1;
    if (!goes_on) {
      run.found = found_.size();
      found_.push_back({finding, at});
      plan_.find_time(run.found, at);
    }
    run.begun = true;
    run.move = moves_;
    Found& known = found_[run.found];
    known.finding.last_line = finding.line;
    if (!(excess(finding.violation) > excess(known.finding.violation))) return;
    finding.line = known.finding.line;
    known = {std::move(finding), at};
    plan_.find_time(run.found, at);
  }

  /// Nothing is planned from here on.
  void refuse_step() {
    plannable_ = false;
    auto& steps = report_.impossible;
    if (walked_ < program_.steps.size() && (steps.empty() || steps.back() != walked_))
      steps.push_back(walked_);
  }

  // Everything else that the planner refuses was noted and is not planned.
  void note_refused_by_plan() {
    const std::size_t step = *plan_.refused();
    note({{LimitKind::singularity, "the way past a singular pose", 0, 0, ""}, program_.steps[step].line},
         {step, 0});
    auto& steps = report_.impossible;
    const auto at = std::lower_bound(steps.begin(), steps.end(), step);
    if (at == steps.end() || *at != step) steps.insert(at, step);
  }

  ConstraintReport finish() {
    if (plan_.refused()) note_refused_by_plan();
    report_.duration = plan_.duration();
    report_.velocity_max = plan_.velocity_max();
    report_.acceleration_max = plan_.acceleration_max();
    for (std::size_t k = 0; k < found_.size(); ++k) {
      found_[k].finding.time = plan_.time_of(k);
      report_.findings.push_back(std::move(found_[k].finding));
    }
    std::stable_sort(report_.findings.begin(), report_.findings.end(),
                     [](const auto& a, const auto& b) { return a.line < b.line; });
    for (std::size_t i = axis_count(); i < report_.axis_min.size(); ++i)
      report_.axis_min[i] = report_.axis_max[i] = 0;
    return std::move(report_);
  }

  std::size_t axis_count() const { return static_cast<std::size_t>(mechanism_->axis_count()); }

  const toolpath::Program& program_;
  double step_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  Pose X_BW_;
  MotionLimits limits_;
  PathKinematics path_;
  TimedPlan plan_;
  Pose X_WT_;
  bool plannable_ = true;
  bool at_possible_ = true;  // where the step before ended
  std::size_t walked_ = 0;
  kinematics::AxisVector axes_{};
  std::vector<LimitViolation> violations_;
  std::vector<Found> found_;
  std::map<std::pair<LimitKind, std::string>, Run> runs_;
  std::size_t moves_ = 0;
  ConstraintReport report_;
};

}  // namespace

ConstraintReport check_constraints(const toolpath::Program& program,
                                   const machine::MachineDescription& machine, double step) {
  return Checker(program, machine, step).run();
}

}  // namespace understudy::control
