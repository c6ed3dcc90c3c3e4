#include "rehearsal/serving/served_machine.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/text/printable.h"

namespace understudy::rehearsal {

using toolpath::StepKind;

namespace {

constexpr double kLongestMove = 86400;  // [s]; docs/limits.md

std::unique_ptr<control::MotionPlanner> planner_from(const kinematics::Mechanism& mechanism,
                                                     const machine::MachineDescription& machine,
                                                     const control::MotionStart& start) {
  return std::make_unique<control::MotionPlanner>(mechanism, machine.X_WB, control::motion_limits(machine),
                                                  start, control::PoseCheck::solvable);
}

std::string without_place(const InputError& error) {
  const std::string place = to_string(error.place()), text = error.what();
  return place.empty() || !text.starts_with(place) ? text
                                                   : text.substr(std::min(place.size() + 2, text.size()));
}

}  // namespace

ServedMachine::ServedMachine(const machine::MachineDescription& machine,
                             const toolpath::GcodeOptions& options, int blocks)
    : machine_(machine),
      options_(options),
      reader_(file_, options_, read_),
      mechanism_(machine.make_mechanism()),
      limits_(control::motion_limits(machine)),
      path_(*mechanism_, machine.X_WB),
      planner_(planner_from(*mechanism_, machine, {machine.X_WB * machine.X_BT_home})),
      blocks_(blocks),
      X_WT_taken_(machine.X_WB * machine.X_BT_home) {
  static_cast<void>(path_.axes(X_WT_taken_, axes_taken_));
  at_.X_WT = X_WT_taken_;
  at_.setpoint.position = axes_taken_;
}

void ServedMachine::take(const std::string& line) {
  read_.clear();
  const Pose X_WT_before = X_WT_taken_;
  const auto axes_before = axes_taken_;
  ++line_;
  try {
    reader_.read_or_undo(line, line_);
    try {
      check(read_);
    } catch (const InputError& error) {
      reader_.undo();
      throw BeyondLimits(error.what());
    }
  } catch (const InputError& error) {
    X_WT_taken_ = X_WT_before;
    axes_taken_ = axes_before;
    ++refused_;
    text_ += fmt::format("; refused: {} ({})\n", printable(line), printable(without_place(error)));
    throw;
  }
  text_ += line + "\n";
  for (const toolpath::Step& step : read_) {
    moves_ += toolpath::moves(step) ? 1 : 0;
    waiting_.push_back(step);
  }
  feed();
}

void ServedMachine::check(const std::vector<toolpath::Step>& steps) {
  for (const toolpath::Step& step : steps) {
    if (!toolpath::moves(step)) continue;
    control::PathSegment segment = path_.segment(step, X_WT_taken_, axes_taken_, limits_);
    if (segment.length > kLongestMove * segment.speed)
      throw InputError(fmt::format("the move takes {:.3g} s, more than {:g} s",
                                   segment.length / segment.speed, kLongestMove));
    if (const auto first = path_.self_motion_before(segment, axes_taken_))
      axes_taken_ = first->self_motion->to;
    path_.require_reachable(segment, control::PoseCheck::limits, axes_taken_);
    X_WT_taken_ = segment.X_WT_end;
  }
}

void ServedMachine::apply(const toolpath::Step& step) {
  if (step.kind == StepKind::temperature) temperature_ = step.temperature;
  if (step.kind == StepKind::fan) fan_ = step.fan;
}

/// Into the planner, as far as it has room. Outputs wait for the moves before them.
void ServedMachine::feed() {
  while (!waiting_.empty()) {
    const toolpath::Step& step = waiting_.front();
    const bool moves = toolpath::moves(step) || step.kind == StepKind::dwell;
    if (!moves) {
      if (pushed_ != done_) return;
      apply(step);
    } else {
      if (free_blocks() <= 0) return;
      if (pushed_ == done_) offset_ = std::max(offset_, now_ - planner_->time());
      planner_->push(step);
      ++pushed_;
      finished_ = false;
    }
    waiting_.pop_front();
  }
}

void ServedMachine::run_until(double now) {
  const double passed = now - now_;
  now_ = std::max(now, now_);
  if (held_) {
    offset_ += std::max(0.0, passed);
    return;
  }
  feed();
  while (pushed_ != done_ && planner_->time() + offset_ < now_) {
    control::PlannedPoint next;
    if (planner_->next(next)) {
      const double dt = machine_.cycle_time;
      speed_ = (next.X_WT.translation() - at_.X_WT.translation()).norm() / dt;
      next.setpoint.filament += filament_before_;
      at_ = next;
      done_ = std::max(done_, static_cast<std::size_t>(next.step));
    } else if (!finished_) {
      planner_->finish();  // nothing more has come: what is queued ends at rest
      finished_ = true;
    } else {
      done_ = pushed_;
    }
    feed();
  }
}

void ServedMachine::drop() {
  dropped_ = dropped_ || !idle();
  waiting_.clear();
  filament_before_ = at_.setpoint.filament;
  planner_ = planner_from(*mechanism_, machine_, {at_.X_WT, 0, at_.setpoint.position});
  pushed_ = done_ = 0;
  at_.step = 0;
  offset_ = now_;
  speed_ = 0;
  held_ = false;
  X_WT_taken_ = at_.X_WT;
  axes_taken_ = at_.setpoint.position;
}

}  // namespace understudy::rehearsal
