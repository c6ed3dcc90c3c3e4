#include "control/gap/setpoint_filter.h"

namespace understudy::control {

using kinematics::AxisVector;
using machine::Setpoint;

SetpointFilter::SetpointFilter(const machine::MachineDescription& machine)
    : machine_(machine), mechanism_(machine.make_mechanism()) {}

void SetpointFilter::drop() {
  holding_ = false;
  restart();
}

/// By how much the axes move for a shift along the tool axis. False: they cannot.
bool SetpointFilter::axes_shift(const PlannedPoint& point, double correction, kinematics::AxisVector& shift) {
  shift = {};
  if (correction == 0) return true;
  const auto axes = static_cast<std::size_t>(mechanism_->axis_count());
  const Pose X_BW = machine_.X_WB.inverse();
  Pose X_WT = point.X_WT;
  X_WT.translation() += correction * tool_axis(X_WT);
  kinematics::AxisVector plain = point.setpoint.position, shifted = point.setpoint.position;
  const std::span<double> from(plain.data(), axes), to(shifted.data(), axes);
  violations_.clear();
  const bool solved = mechanism_->inverse(X_BW * point.X_WT, from, from) == kinematics::SolveStatus::ok &&
                      mechanism_->inverse(X_BW * X_WT, to, to) == kinematics::SolveStatus::ok;
  if (solved) mechanism_->check(X_BW * X_WT, to, violations_);
  if (!solved || !violations_.empty()) return false;
  for (std::size_t i = 0; i < axes; ++i) shift[i] = shifted[i] - plain[i];
  return true;
}

bool SetpointFilter::shift(const PlannedPoint& point, double correction, Setpoint& ready) {
  kinematics::AxisVector shift{};
  reachable_ = axes_shift(point, correction, shift);
  if (!reachable_) shift = shift_held_;
  const bool complete = holding_;
  if (complete) {
    // The shift's own velocity by central difference: it is smooth over many cycles.
    const double span = point.setpoint.time - time_before_;
    if (span < 3 * machine_.cycle_time)
      for (std::size_t i = 0; i < shift.size(); ++i)
        held_.velocity[i] += (shift[i] - shift_before_[i]) / span;
    ready = held_;
  }
  time_before_ = complete ? held_.time : point.setpoint.time - machine_.cycle_time;
  shift_before_ = complete ? shift_held_ : shift;
  shift_held_ = shift;
  held_ = point.setpoint;
  for (std::size_t i = 0; i < shift.size(); ++i) held_.position[i] += shift[i];
  holding_ = true;
  return complete;
}

bool SetpointFilter::flush(Setpoint& ready) {
  if (!holding_) return false;
  ready = held_;
  holding_ = false;
  shift_before_ = shift_held_;
  return true;
}

}  // namespace understudy::control
