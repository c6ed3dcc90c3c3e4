#include "control/feeder.h"

#include <algorithm>

namespace understudy::control {

using machine::Status;

namespace {

constexpr std::size_t kBatch = 256;  // setpoints handed over at once
constexpr double kPatience = 30.0;   // [s], port clock: a call that takes longer has failed
constexpr int kLeadCycles = 2;       // a stretch begins this far ahead of the port's clock

}  // namespace

Feeder::Feeder(const machine::MachineDescription& machine, machine::MachinePort& port, const Pose& X_WT_start)
    : machine_(machine),
      mechanism_(machine.make_mechanism()),
      limits_(motion_limits(machine)),
      port_(port),
      X_WT_rest_(X_WT_start) {
  batch_.reserve(kBatch);
}

Pose Feeder::resting_pose() const { return planner_ ? planner_->resting_pose() : X_WT_rest_; }

Status Feeder::push(const toolpath::Step& step) {
  if (!planner_) {
    planner_ = std::make_unique<MotionPlanner>(*mechanism_, machine_.X_WB, limits_, X_WT_rest_,
                                               port_.now() + kLeadCycles * limits_.cycle_time);
    filament_at_start_ = filament_;
  }
  planner_->push(step);
  filament_ += step.filament;
  return pump();
}

Status Feeder::come_to_rest() {
  if (!planner_) return Status::ok;
  planner_->finish();
  if (const Status s = pump(); s != Status::ok) return s;
  if (const Status s = hand_over(); s != Status::ok) return s;
  X_WT_rest_ = planner_->resting_pose();
  planner_.reset();
  return port_.wait_until(end_time_ + limits_.cycle_time);
}

Status Feeder::pump() {
  PlannedPoint point;
  while (planner_->next(point)) {
    point.setpoint.filament += filament_at_start_;
    batch_.push_back(point.setpoint);
    if (batch_.size() == kBatch)
      if (const Status s = hand_over(); s != Status::ok) return s;
  }
  return Status::ok;
}

Status Feeder::hand_over() {
  if (batch_.empty()) return Status::ok;
  const double deadline = port_.now() + kPatience;
  Status s = port_.submit(batch_, deadline);
  while (s == Status::queue_full) {
    // The queue empties at the cycle's pace: wait for about one batch.
    if (const Status waited =
            port_.wait_until(port_.now() + static_cast<double>(kBatch) * limits_.cycle_time);
        waited != Status::ok)
      return waited;
    s = port_.submit(batch_, deadline);
  }
  if (s != Status::ok) return s;
  end_time_ = batch_.back().time;
  batch_.clear();
  return s;
}

}  // namespace understudy::control
