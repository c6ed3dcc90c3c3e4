#include "machine/record/recording_port.h"

#include <algorithm>

namespace understudy::machine {

Status RecordingPort::submit(std::span<const Setpoint> setpoints, double deadline) {
  const double now = port_.now();
  const Status answer = port_.submit(setpoints, deadline);
  writer_.submit(now, deadline, setpoints, answer);
  return answer;
}

void RecordingPort::write_positions() {
  writer_.state(port_.state());
  LoadReading load;
  if (read_load(load)) writer_.load(load);
}

Status RecordingPort::wait_until(double time) {
  while (true) {
    const double now = port_.now();
    double until = std::min(time, now + period_);
    Status answer = port_.wait_until(until);
    if (answer == Status::ok && until < time && port_.now() <= now)  // its clock is coarser than that
      answer = port_.wait_until(until = time);
    writer_.wait(now, until, port_.now(), answer);
    write_positions();
    writer_.flush();
    if (answer != Status::ok || until >= time) return answer;
  }
}

Status RecordingPort::urgent(UrgentCommand command) {
  const double now = port_.now();
  const Status answer = port_.urgent(command);
  writer_.urgent(now, command, answer);
  return answer;
}

Status RecordingPort::set_outputs(const Outputs& outputs, double deadline) {
  const double now = port_.now();
  const Status answer = port_.set_outputs(outputs, deadline);
  writer_.outputs(now, outputs, deadline, answer);
  writer_.flush();
  return answer;
}

Status RecordingPort::capture(const Region& region, Frame& frame, double deadline) {
  const double now = port_.now();
  const Status answer = port_.capture(region, frame, deadline);
  writer_.frame(now, region, deadline, answer, frame);
  write_positions();
  writer_.flush();
  return answer;
}

}  // namespace understudy::machine
