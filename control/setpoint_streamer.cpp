#include "control/setpoint_streamer.h"

#include <algorithm>

#include "core/interrupt.h"

namespace understudy::control {

using machine::Status;

namespace {

constexpr std::size_t kBatch = 256;  // setpoints handed over at once, or half of a small queue
constexpr double kPatience = 30.0;   // [s], port clock: a call that takes longer has failed
constexpr double kSlice = 0.25;      // [s], between two checks of the interrupt flag
constexpr double kPoll = 0.01;       // [s], between two checks whether the last setpoint was executed

}  // namespace

SetpointStreamer::SetpointStreamer(machine::MachinePort& port, double cycle_time)
    : port_(port),
      cycle_time_(cycle_time),
      batch_size_(std::clamp<std::size_t>(port.state().free_slots / 2, 1, kBatch)),
      end_time_(port.now()) {
  batch_.reserve(kBatch);
  lines_.reserve(port.state().free_slots + kBatch);
}

Stop SetpointStreamer::write() {
  if (batch_.empty()) return {};
  const double deadline = port_.now() + kPatience;
  const std::uint64_t first = port_.state().accepted;
  Status s = port_.submit(batch_, deadline);
  // The queue empties at the cycle's pace: it has room after one batch, or by rounding a little later. A
  // second batch would let a small queue run dry.
  double pause = static_cast<double>(batch_size_) * cycle_time_;
  while (s == Status::queue_full) {
    const double before = port_.now();
    if (before > deadline) return stop_of(Status::deadline_exceeded, port_);
    if (Stop stop = wait_until(std::min(before + pause, deadline + cycle_time_))) return stop;
    pause = port_.now() > before ? cycle_time_ : 2 * pause;  // a port's clock may be coarser than the cycle
    s = port_.submit(batch_, deadline);
  }
  if (s != Status::ok) return stop_of(s, port_);
  end_time_ = batch_.back().time;
  note_lines(first);
  batch_.clear();
  return {};
}

/// Of the batch, whose first setpoint is the port's `first`. What was executed is forgotten.
void SetpointStreamer::note_lines(std::uint64_t first) {
  const std::uint64_t next = port_.state().executed + dropped_;
  const auto ahead = std::ranges::find_if(lines_, [&](const LineStart& s) { return s.setpoint > next; });
  if (ahead - lines_.begin() > 1) lines_.erase(lines_.begin(), ahead - 1);
  for (const machine::Setpoint& setpoint : batch_) {
    if (lines_.empty() || lines_.back().line != setpoint.line) lines_.push_back({first, setpoint.line});
    ++first;
  }
}

int SetpointStreamer::line_executed() const {
  const std::uint64_t next = port_.state().executed + dropped_;
  int line = 0;
  for (const LineStart& start : lines_)
    if (start.setpoint <= next) line = start.line;
  return line;
}

Stop SetpointStreamer::wait_until_executed() {
  if (Stop stop = wait_until(end_time_ + cycle_time_)) return stop;
  // Accepted is not executed: a machine that was held is late, not done.
  const double deadline = end_time_ + kPatience;
  while (port_.state().executed + dropped_ < port_.state().accepted) {
    if (port_.now() > deadline) return stop_of(Status::deadline_exceeded, port_);
    if (Stop stop = wait_until(port_.now() + kPoll)) return stop;
  }
  return {};
}

Stop SetpointStreamer::brake() {
  batch_.clear();
  if (Stop stop = stop_of(port_.urgent(machine::UrgentCommand::stop), port_)) return stop;
  const double deadline = port_.now() + kPatience;
  do {
    if (port_.now() > deadline) return stop_of(Status::deadline_exceeded, port_);
    if (Stop stop = wait_until(port_.now() + kPoll)) return stop;
  } while (port_.state().moving);
  dropped_ = port_.state().accepted - port_.state().executed;
  return {};
}

Stop SetpointStreamer::wait_until(double time) {
  while (port_.now() < time) {
    stop_if_interrupted();
    const double before = port_.now();
    if (Stop stop = stop_of(port_.wait_until(std::min(time, before + kSlice)), port_)) return stop;
    if (port_.now() <= before) break;  // as near as the port's clock comes
  }
  return {};
}

}  // namespace understudy::control
