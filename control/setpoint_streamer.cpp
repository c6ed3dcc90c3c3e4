#include "control/setpoint_streamer.h"

#include <algorithm>

#include "core/interrupt.h"

namespace understudy::control {

using machine::Status;

namespace {

constexpr std::size_t kBatch = 256;  // setpoints handed over at once, or half of a small queue
constexpr double kPatience = 30.0;   // [s], port clock: a call that takes longer has failed
constexpr double kLead = 0.05;       // [s], a stretch begins this far ahead: time to plan its first batch
constexpr double kSlice = 0.25;      // [s], between looks at the interrupt flag
constexpr double kLook = 0.01;       // [s], between looks whether the last setpoint was executed
constexpr double kBraking = 0.1;   // [s], of motion within which a port that is told to stop has come to rest
constexpr double kReserve = 0.02;  // of the axes' velocity and acceleration, for what a watch adds

MotionLimits limits_for(const machine::MachineDescription& machine, bool watched) {
  MotionLimits limits = motion_limits(machine);
  if (!watched) return limits;
  for (double& v : limits.axis_velocity) v *= 1 - kReserve;
  for (double& a : limits.axis_acceleration) a *= 1 - kReserve;
  return limits;
}

}  // namespace

SetpointStreamer::SetpointStreamer(const machine::MachineDescription& machine, machine::MachinePort& port,
                                   const Pose& X_WT_start, SetpointFilter* watch)
    : machine_(machine),
      mechanism_(machine.make_mechanism()),
      limits_(limits_for(machine, watch != nullptr)),
      port_(port),
      watch_(watch),
      batch_size_(std::clamp<std::size_t>(port.state().free_slots / 2, 1, kBatch)),
      X_WT_rest_(X_WT_start),
      axes_rest_(port.state().position),
      end_time_(port.now()) {
  batch_.reserve(batch_size_);
}

Pose SetpointStreamer::resting_pose() const { return planner_ ? planner_->resting_pose() : X_WT_rest_; }

Status SetpointStreamer::push(const toolpath::Step& step) {
  if (!planner_) {
    planner_ = std::make_unique<MotionPlanner>(*mechanism_, machine_.X_WB, limits_, X_WT_rest_,
                                               port_.now() + kLead, PoseCheck::limits, &axes_rest_);
    filament_at_start_ = filament_;
  }
  planner_->push(step);
  filament_ += step.filament;
  return pump();
}

Status SetpointStreamer::come_to_rest() {
  if (!planner_) return Status::ok;
  planner_->finish();
  if (const Status s = pump(); s != Status::ok) return s;
  if (machine::Setpoint last; watch_ && watch_->flush(last)) batch_.push_back(last);
  if (const Status s = hand_over(); s != Status::ok) return s;
  X_WT_rest_ = planner_->resting_pose();
  axes_rest_ = planner_->resting_axes();
  planner_.reset();
  if (const Status s = wait_until(end_time_ + limits_.cycle_time); s != Status::ok) return s;
  // Accepted is not executed: a machine that was held is late, not done.
  const double deadline = end_time_ + kPatience;
  while (port_.state().executed + dropped_ < port_.state().accepted) {
    if (port_.now() > deadline) return Status::deadline_exceeded;
    if (const Status s = wait_until(port_.now() + kLook); s != Status::ok) return s;
  }
  return Status::ok;
}

Status SetpointStreamer::pump() {
  PlannedPoint point;
  while (planner_->next(point)) {
    point.setpoint.filament += filament_at_start_;
    if (watch_) {
      if (const Status s = queue_watched(point); s != Status::ok) return s;
    } else {
      batch_.push_back(point.setpoint);
    }
    if (batch_.size() >= batch_size_)
      if (const Status s = hand_over(); s != Status::ok) return s;
  }
  return Status::ok;
}

/// Not before its time comes within the lead: until then it can still be shifted.
Status SetpointStreamer::queue_watched(const PlannedPoint& point) {
  for (;;) {
    const double release = point.setpoint.time - watch_->lead();
    if (port_.now() >= release) break;
    if (const Status s = hand_over(); s != Status::ok) return s;
    stop_if_interrupted();
    const double before = port_.now();
    if (const Status s = watch_->pass_time(release); s != Status::ok) return s;
    if (watch_->stop() != GapStop::none) return Status::rejected;
    if (port_.now() <= before) break;  // as near as the port's clock comes
  }
  if (machine::Setpoint ready; watch_->shift(point, ready)) batch_.push_back(ready);
  return watch_->stop() == GapStop::none ? Status::ok : Status::rejected;
}

/// A port brakes along what is queued, and a watched queue is shorter than that.
Status SetpointStreamer::queue_braking_way() {
  if (!planner_) return Status::ok;
  planner_->finish();
  const double until = port_.now() + kBraking;
  bool on = true;
  for (PlannedPoint point; on && planner_->next(point);) {
    point.setpoint.filament += filament_at_start_;
    on = point.setpoint.time < until;
    machine::Setpoint ready = point.setpoint;
    if (!watch_ || watch_->shift(point, ready)) batch_.push_back(ready);
  }
  if (machine::Setpoint last; on && watch_ && watch_->flush(last)) batch_.push_back(last);
  return hand_over();
}

Status SetpointStreamer::abandon(double filament) {
  if (const Status s = queue_braking_way(); s != Status::ok) return s;
  planner_.reset();
  batch_.clear();
  filament_ = filament;
  if (const Status s = port_.urgent(machine::UrgentCommand::stop); s != Status::ok) return s;
  const double deadline = port_.now() + kPatience;
  do {
    if (port_.now() > deadline) return Status::deadline_exceeded;
    if (const Status s = wait_until(port_.now() + kLook); s != Status::ok) return s;
  } while (port_.state().moving);
  const machine::AxisState rest = port_.state();
  dropped_ = rest.accepted - rest.executed;
  axes_rest_ = rest.position;
  const auto axes = static_cast<std::size_t>(mechanism_->axis_count());
  Pose X_BT;
  const Pose X_BT_near = machine_.X_WB.inverse() * X_WT_rest_;
  if (mechanism_->forward(std::span<const double>(axes_rest_.data(), axes), X_BT_near, X_BT) !=
      kinematics::SolveStatus::ok)
    return Status::rejected;
  X_WT_rest_ = machine_.X_WB * X_BT;
  return Status::ok;
}

Status SetpointStreamer::hand_over() {
  if (batch_.empty()) return Status::ok;
  const double deadline = port_.now() + kPatience;
  Status s = port_.submit(batch_, deadline);
  while (s == Status::queue_full) {
    if (port_.now() > deadline) return Status::deadline_exceeded;
    // The queue empties at the cycle's pace: wait for about one batch.
    const double pause = static_cast<double>(batch_size_) * limits_.cycle_time;
    if (const Status waited = wait_until(std::min(port_.now() + pause, deadline + limits_.cycle_time));
        waited != Status::ok)
      return waited;
    s = port_.submit(batch_, deadline);
  }
  if (s != Status::ok) return s;
  end_time_ = batch_.back().time;
  batch_.clear();
  return s;
}

Status SetpointStreamer::wait_until(double time) {
  while (port_.now() < time) {
    stop_if_interrupted();
    const double before = port_.now();
    if (const Status s = port_.wait_until(std::min(time, before + kSlice)); s != Status::ok) return s;
    if (port_.now() <= before) break;  // as near as the port's clock comes
  }
  return Status::ok;
}

}  // namespace understudy::control
