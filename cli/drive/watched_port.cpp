#include "cli/drive/watched_port.h"

namespace understudy::cli {

machine::Status WatchedPort::submit(std::span<const machine::Setpoint> setpoints, double deadline) {
  const machine::Status answer = port_.submit(setpoints, deadline);
  if (answer == machine::Status::ok)
    for (const machine::Setpoint& setpoint : setpoints)
      due_.push_back({setpoint.time, setpoint.line, setpoint.filament});
  return answer;
}

machine::Status WatchedPort::wait_until(double time) {
  const machine::Status answer = port_.wait_until(time);
  SeenMotion seen;
  seen.state = port_.state();
  for (; !due_.empty() && due_.front().time <= seen.state.time; due_.pop_front()) last_ = due_.front();
  seen.line = last_.line;
  seen.filament = last_.filament;
  seen_(seen);
  return answer;
}

}  // namespace understudy::cli
