#include "control/cycle.h"

#include "core/interrupt.h"

namespace understudy::control {

using machine::Status;

namespace {

MotionLimits limits_for(const machine::MachineDescription& machine, bool gap_control) {
  MotionLimits limits = motion_limits(machine);
  if (!gap_control) return limits;
  const double kept = 1 - limits.planner.gap_reserve;
  for (double& v : limits.axis_velocity) v *= kept;
  for (double& a : limits.axis_acceleration) a *= kept;
  return limits;
}

}  // namespace

ControlCycle::ControlCycle(const machine::MachineDescription& machine, machine::MachinePort& port,
                           const Pose& X_WT_start, const CycleOptions& options)
    : machine_(machine),
      mechanism_(machine.make_mechanism()),
      limits_(limits_for(machine, options.gap != nullptr)),
      streamer_(port, limits_.cycle_time),
      gap_(options.gap),
      poses_(options.poses),
      X_WT_rest_(X_WT_start),
      axes_rest_(port.state().position) {}

/// One cycle after the other, until the planner needs another step.
Stop ControlCycle::run() {
  while (next_point()) {
    Stop stop = read();
    if (!stop) stop = update();
    if (!stop) stop = write();
    if (gap_) gap_->record();
    if (stop) return stop;
  }
  return {};
}

/// The port's state, and a frame of the gap where one is due. Where the next point may still be shifted, the
/// port's clock runs until its time comes within the gap controller's lead.
Stop ControlCycle::read() {
  clock_stands_ = false;
  if (due()) return {};
  stop_if_interrupted();
  const double before = port().now();
  const Status answer = gap_->read(point_.setpoint.time - gap_->lead());
  clock_stands_ = port().now() <= before;
  return stop_of(answer, port());
}

/// The estimate of the gap, and the planned points that are due, with the correction that follows from it.
Stop ControlCycle::update() {
  if (gap_) gap_->update();
  Stop stop = gap_stop();
  while (!stop && !streamer_.full() && next_point() && due()) {
    take_point();
    stop = gap_stop();
  }
  return stop;
}

/// Setpoints to the port's queue: a batch at a time, or, under gap control, at once.
Stop ControlCycle::write() {
  if (!gap_ && !streamer_.full()) return {};
  return streamer_.write();
}

bool ControlCycle::next_point() {
  if (pending_ || !planner_ || !planner_->next(point_)) return pending_;
  point_.setpoint.filament += filament_at_start_;
  return pending_ = true;
}

/// Without gap control there is nothing to wait for.
bool ControlCycle::due() const {
  return !gap_ || clock_stands_ || streamer_.port().now() >= point_.setpoint.time - gap_->lead();
}

void ControlCycle::take_point() {
  pending_ = clock_stands_ = false;
  if (!gap_) return streamer_.add(point_.setpoint);
  if (machine::Setpoint ready; gap_->shift(point_, ready)) streamer_.add(ready);
}

Stop ControlCycle::gap_stop() const {
  if (!gap_ || gap_->stop() == GapStop::none) return {};
  const auto cause = gap_->stop_cause();
  Stop stop = stop_of(gap_->stop(), cause.why, streamer_.port());
  stop.line = cause.line;
  stop.time = cause.time;
  return stop;
}

Stop ControlCycle::push(const toolpath::Step& step) {
  if (!planner_) {
    planner_ = std::make_unique<MotionPlanner>(
        *mechanism_, machine_.X_WB, limits_,
        MotionStart{X_WT_rest_, port().now() + limits_.planner.lead_time, axes_rest_}, poses_);
    filament_at_start_ = filament_;
  }
  planner_->push(step);
  filament_ += step.filament;
  return run();
}

Stop ControlCycle::come_to_rest() {
  if (!planner_) return {};
  planner_->finish();
  if (Stop stop = run()) return stop;
  if (machine::Setpoint last; gap_ && gap_->flush(last)) streamer_.add(last);
  if (Stop stop = streamer_.write()) return stop;
  X_WT_rest_ = planner_->resting_pose();
  axes_rest_ = planner_->resting_axes();
  planner_.reset();
  return streamer_.wait_until_executed();
}

/// A port brakes along what is queued, and under gap control the queue is shorter than that.
Stop ControlCycle::queue_braking_path() {
  if (!planner_) return {};
  planner_->finish();
  const double until = port().now() + machine::kBrakingTime;
  bool on = true;
  while (on && next_point()) {
    on = point_.setpoint.time < until;
    take_point();
  }
  if (machine::Setpoint last; on && gap_ && gap_->flush(last)) streamer_.add(last);
  const Stop stop = streamer_.write();
  if (gap_) gap_->record();
  return stop;
}

Stop ControlCycle::abandon(double filament) {
  if (Stop stop = queue_braking_path()) return stop;
  planner_.reset();
  pending_ = false;
  filament_ = filament;
  if (Stop stop = streamer_.brake()) return stop;
  axes_rest_ = port().state().position;
  const auto axes = static_cast<std::size_t>(mechanism_->axis_count());
  Pose X_BT;
  const Pose X_BT_near = machine_.X_WB.inverse() * X_WT_rest_;
  const auto solved = mechanism_->forward(std::span<const double>(axes_rest_.data(), axes), X_BT_near, X_BT);
  if (solved != kinematics::SolveStatus::ok) {
    Stop stop = stop_of(Status::rejected, port());
    stop.why = std::string("the axes rest where no pose belongs to them: ") + to_string(solved);
    return stop;
  }
  X_WT_rest_ = machine_.X_WB * X_BT;
  return {};
}

Pose ControlCycle::resting_pose() const { return planner_ ? planner_->resting_pose() : X_WT_rest_; }

}  // namespace understudy::control
