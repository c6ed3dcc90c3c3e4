#include "machine/loopback_port.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace understudy::machine {
namespace {

/// Slower than this the axes count as resting: no drive tells a micrometre per second from rest.
constexpr double kRest = 1e-6;  // [m/s or rad/s]

constexpr double kStep = 0.5e-3;  // [s], in which the queue's clock slows down and speeds up: as the twin's

SetpointQueueOptions queue_options(const LoopbackPort::Options& options) {
  SetpointQueueOptions queue;
  queue.capacity = options.queue_capacity;
  queue.ranges = options.ranges;
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  if (queue.ranges.empty())
    queue.ranges.assign(static_cast<std::size_t>(options.axis_count), {-kEndless, kEndless});
  queue.rest_velocity.fill(kRest);
  return queue;
}

}  // namespace

LoopbackPort::LoopbackPort(const Options& options, FrameSource frames)
    : options_(options), frames_(std::move(frames)), queue_(queue_options(options), options.start, 0) {}

AxisState LoopbackPort::state() const {
  AxisState s;
  s.time = s.sampled_at = time_;
  s.position = queue_.target().position;
  for (std::size_t i = 0; i < s.position.size(); ++i)
    s.position[i] = (s.position[i] - options_.drive_zero[i]) + options_.drive_zero[i];
  s.accepted = queue_.accepted();
  s.executed = queue_.executed();
  s.free_slots = queue_.free_slots();
  s.moving = queue_.moving();
  s.fault = fault_;
  return s;
}

Status LoopbackPort::submit(std::span<const Setpoint> setpoints, double deadline) {
  if (fault_ != Fault::none) return Status::faulted;
  if (time_ > deadline) return Status::deadline_exceeded;
  return queue_.submit(setpoints, time_);
}

void LoopbackPort::raise(Fault fault) {
  queue_.advance_to(time_);
  queue_.clear(time_);
  fault_ = fault;
}

/// The time that the clock shows when it is asked to run until `time`: at most half a step before it.
double LoopbackPort::on_clock(double time) const {
  const double step = options_.clock_step;
  if (!(step > 0)) return time;
  double steps = std::ceil(time_ / step - 0.5);
  const double end = time - 0.5 * step;
  steps = std::max(steps, std::floor(end / step) - 1);
  while (steps * step < end) ++steps;
  return std::max(time_, steps * step);
}

void LoopbackPort::execute_until(double time) {
  while (time_ < time && fault_ == Fault::none) {
    const double next = queue_.rate_changes() ? std::min(time, time_ + kStep) : time;
    if (!queue_.moving() && !queue_.rate_changes()) {  // held, or nothing to do
      queue_.pass(next - time_, next);
      time_ = next;
      return;
    }
    while (const Setpoint* done = queue_.execute_next(next)) {
      if (options_.history) history_.push_back(*done);
      if (!queue_.ran_dry()) continue;
      time_ = done->time + queue_.lag();
      return raise(Fault::underrun);
    }
    queue_.advance_to(next);
    queue_.pass(next - time_, next);
    time_ = next;
  }
}

Status LoopbackPort::wait_until(double time) {
  if (fault_ == Fault::none && time > time_) {
    const bool fault_comes = coming_fault_ != Fault::none && coming_fault_time_ <= time;
    execute_until(fault_comes ? std::max(time_, coming_fault_time_) : on_clock(time));
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
      queue_.hold();
      return Status::ok;
    case UrgentCommand::resume:
      queue_.resume();
      return Status::ok;
    case UrgentCommand::stop:
      queue_.stop(time_);
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
  if (!frames_) return Status::no_frame;
  const double received_at = time_ + options_.frame_time;
  const double exposed_at = time_ + options_.frame_time / 2;
  if (const Status s = wait_until(exposed_at); s != Status::ok) return s;
  const AxisState exposed = state();
  if (const Status s = wait_until(received_at); s != Status::ok) return s;
  const bool repeated = repeats_ > 0 && frames_delivered_ > 0;
  if (repeats_ > 0) --repeats_;
  if (!repeated) {
    Image image;
    if (!frames_(exposed, region, image)) return Status::no_frame;
    last_frame_.image = std::move(image);
    last_frame_.exposed_at = exposed_at;
    last_frame_.number = frames_delivered_++;
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
