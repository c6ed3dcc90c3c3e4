#include "drivers/gcode/post_port.h"

#include <algorithm>
#include <utility>

namespace understudy::drivers {

using machine::Fault;
using machine::Status;

namespace {

constexpr std::size_t kCapacity = 4096;
constexpr double kToStart = 5;  // [s], for a machine that is not quite there

}  // namespace

PostPort::PostPort(const machine::MachineDescription& machine, const PostController& controller,
                   const machine::AxisVector& start, std::function<void(const std::string&)> line)
    : writer_(controller.family, controller.axes),
      path_(machine, kCapacity, start),
      fitter_(controller.tolerance, controller.axes.grid, controller.axes.turns),
      has_outputs_(controller.has_outputs),
      line_(std::move(line)) {
  fitter_.begin(path_.last());
}

void PostPort::write(const std::string& line) {
  figures_.bytes += line.size() + 1;
  line_(line);
}

void PostPort::begin() {
  for (const std::string& line : writer_.preamble()) write(line);
  Block start;
  start.duration = kToStart;
  PathSample elsewhere = path_.last();
  for (int i = 0; i < axis_count(); ++i) {
    const auto axis = static_cast<std::size_t>(i);
    start.position[axis] = path_.last().position[axis];
    elsewhere.position[axis] += writer_.axes().unit(i);  // so that every axis is named
  }
  writer_.begin(elsewhere);
  write(writer_.block(start));
  writer_.begin(path_.last());
}

machine::AxisState PostPort::state() const {
  const machine::SetpointQueue& queue = path_.queue();
  machine::AxisState s;
  s.time = s.sampled_at = now_;
  s.position = path_.last().position;
  s.accepted = queue.accepted();
  s.executed = queue.executed();
  s.free_slots = queue.free_slots();
  s.moving = queue.moving();
  s.fault = fault_;
  return s;
}

Status PostPort::submit(std::span<const machine::Setpoint> setpoints, double deadline) {
  if (fault_ != Fault::none) return Status::faulted;
  if (now_ > deadline) return Status::deadline_exceeded;
  return path_.queue().submit(setpoints, now_);
}

void PostPort::write_blocks() {
  while (const auto block = fitter_.take()) {
    if (figures_.duration - second_began_ >= 1) {
      second_began_ = figures_.duration;
      blocks_then_ = figures_.blocks;
      bytes_then_ = figures_.bytes;
    }
    write(writer_.block(*block));
    ++figures_.blocks;
    figures_.duration += block->duration;
    figures_.blocks_in_second = std::max(figures_.blocks_in_second, figures_.blocks - blocks_then_);
    figures_.bytes_in_second = std::max(figures_.bytes_in_second, figures_.bytes - bytes_then_);
  }
}

Status PostPort::wait_until(double time) {
  while (now_ < time && fault_ == Fault::none) {
    if (!path_.queue().moving() && !path_.queue().rate_changes() && !path_.in_motion()) {
      path_.queue().pass(time - now_, time);
      now_ = time;
      break;
    }
    const double next = std::min(time, now_ + kSampleTime);
    const auto passed = path_.pass(now_, next, fitter_);
    now_ = next;
    if (passed != PathSampler::Passed::on) fitter_.finish();
    if (passed == PathSampler::Passed::ran_dry) {
      fault_ = Fault::underrun;
      path_.queue().clear(now_);
    }
  }
  write_blocks();
  return fault_ == Fault::none ? Status::ok : Status::faulted;
}

Status PostPort::urgent(machine::UrgentCommand command) {
  switch (command) {
    case machine::UrgentCommand::hold:
      path_.queue().hold();
      break;
    case machine::UrgentCommand::resume:
      path_.queue().resume();
      break;
    case machine::UrgentCommand::stop:
      path_.queue().stop(now_);
      break;
    case machine::UrgentCommand::clear_fault:
      fault_ = Fault::none;
      break;
  }
  return Status::ok;
}

Status PostPort::set_outputs(const machine::Outputs& outputs, double deadline) {
  if (fault_ != Fault::none && !outputs.off()) return Status::faulted;
  if (now_ > deadline) return Status::deadline_exceeded;
  if (has_outputs_)
    for (const std::string& line : writer_.outputs(outputs_, outputs)) write(line);
  outputs_ = outputs;
  return Status::ok;
}

Status PostPort::capture(const Region& /*region*/, machine::Frame& /*frame*/, double deadline) {
  return now_ > deadline ? Status::deadline_exceeded : Status::no_frame;
}

}  // namespace understudy::drivers
