#include "machine/loopback_port.h"

#include <algorithm>
#include <cmath>

namespace understudy::machine {
namespace {

/// Slower than this the axes count as resting: no drive tells a micrometre per second from rest.
constexpr double kRest = 1e-6;  // [m/s or rad/s]

bool finite(const Setpoint& s, int axes) {
  bool all = std::isfinite(s.time) && std::isfinite(s.filament);
  for (std::size_t i = 0; i < static_cast<std::size_t>(axes); ++i)
    all = all && std::isfinite(s.position[i]) && std::isfinite(s.velocity[i]);
  return all;
}

bool resting(const Setpoint& s) {
  return std::all_of(s.velocity.begin(), s.velocity.end(), [](double v) { return std::abs(v) <= kRest; });
}

double hermite(double a, double va, double b, double vb, double h, double u) {
  const double u2 = u * u, u3 = u2 * u;
  return a + (b - a) * (3 * u2 - 2 * u3) + va * h * (u3 - 2 * u2 + u) + vb * h * (u3 - u2);
}

}  // namespace

LoopbackPort::LoopbackPort(const Options& options, FrameSource frames)
    : options_(options), frames_(std::move(frames)), ring_(options.queue_capacity) {
  last_.position = options_.start;
}

AxisVector LoopbackPort::position_at(double queue_time) const {
  if (size_ == 0) return last_.position;
  const Setpoint& next = front();
  const double h = next.time - last_.time;
  const double u = std::clamp((queue_time - last_.time) / h, 0.0, 1.0);
  AxisVector position{};
  for (std::size_t i = 0; i < position.size(); ++i)
    position[i] = hermite(last_.position[i], last_.velocity[i], next.position[i], next.velocity[i], h, u);
  return position;
}

AxisState LoopbackPort::state() const {
  AxisState s;
  s.time = s.sampled_at = time_;
  s.position = position_at(time_ - queue_lag_);
  s.accepted = accepted_;
  s.executed = executed_;
  s.free_slots = ring_.size() - size_;
  s.moving = size_ > 0 && !held_;
  s.fault = fault_;
  return s;
}

Status LoopbackPort::submit(std::span<const Setpoint> setpoints, double deadline) {
  if (fault_ != Fault::none) return Status::faulted;
  if (time_ > deadline) return Status::deadline_exceeded;
  double time = size_ == 0 ? time_ - queue_lag_ : back().time;
  for (const Setpoint& s : setpoints) {
    if (!finite(s, options_.axis_count) || !(s.time > time)) return Status::rejected;
    time = s.time;
  }
  if (setpoints.size() > ring_.size() - size_) return Status::queue_full;
  if (size_ == 0) last_.time = time_ - queue_lag_;  // the axes have rested at `last_` until now
  for (const Setpoint& s : setpoints) ring_[(head_ + size_++) % ring_.size()] = s;
  accepted_ += setpoints.size();
  return Status::ok;
}

void LoopbackPort::rest_at(const AxisVector& position) {
  last_.position = position;
  last_.velocity = {};
  last_.time = time_;
  size_ = 0;
  queue_lag_ = 0;
  held_ = false;
}

void LoopbackPort::raise(Fault fault) {
  rest_at(position_at(time_ - queue_lag_));
  fault_ = fault;
}

void LoopbackPort::execute_until(double time) {
  if (held_) {
    queue_lag_ += time - time_;
    time_ = time;
    return;
  }
  while (size_ > 0 && front().time + queue_lag_ <= time) {
    last_ = front();
    head_ = (head_ + 1) % ring_.size();
    --size_;
    ++executed_;
    if (options_.history) history_.push_back(last_);
    if (size_ == 0 && !resting(last_)) {
      time_ = last_.time + queue_lag_;
      return raise(Fault::underrun);
    }
  }
  time_ = time;
}

Status LoopbackPort::wait_until(double time) {
  if (fault_ == Fault::none && time > time_) {
    const bool fault_comes = coming_fault_ != Fault::none && coming_fault_time_ <= time;
    execute_until(fault_comes ? std::max(time_, coming_fault_time_) : time);
    if (fault_comes && fault_ == Fault::none) {
      raise(coming_fault_);
      coming_fault_ = Fault::none;
    }
  }
  return fault_ == Fault::none ? Status::ok : Status::faulted;
}

Status LoopbackPort::urgent(UrgentCommand command) {
  switch (command) {
    case UrgentCommand::hold:
      held_ = true;
      return Status::ok;
    case UrgentCommand::resume:
      held_ = false;
      return Status::ok;
    case UrgentCommand::stop:
      rest_at(position_at(time_ - queue_lag_));
      return Status::ok;
    case UrgentCommand::clear_fault:
      fault_ = Fault::none;
      return Status::ok;
  }
  return Status::rejected;
}

Status LoopbackPort::set_outputs(const Outputs& outputs, double deadline) {
  if (fault_ != Fault::none && !outputs.off()) return Status::faulted;
  if (time_ > deadline) return Status::deadline_exceeded;
  outputs_ = outputs;
  return Status::ok;
}

Status LoopbackPort::capture(const Region& region, Frame& frame, double deadline) {
  if (time_ + options_.frame_time > deadline) return Status::deadline_exceeded;
  const double received_at = time_ + options_.frame_time;
  const double exposed_at = time_ + options_.frame_time / 2;
  if (const Status s = wait_until(exposed_at); s != Status::ok) return s;
  const AxisState exposed = state();
  if (const Status s = wait_until(received_at); s != Status::ok) return s;
  const bool repeated = repeats_ > 0 && last_frame_.number > 0;
  if (repeats_ > 0) --repeats_;
  if (!repeated) {
    Image image;
    if (!frames_ || !frames_(exposed, region, image)) return Status::no_frame;
    last_frame_.image = std::move(image);
    last_frame_.exposed_at = exposed_at;
    last_frame_.number = ++frame_number_;
  }
  last_frame_.received_at = time_;
  frame = last_frame_;
  return Status::ok;
}

void LoopbackPort::inject_fault(Fault fault, double time) {
  if (time <= time_) return raise(fault);
  coming_fault_ = fault;
  coming_fault_time_ = time;
}

}  // namespace understudy::machine
