#include "control/stop.h"

#include <fmt/format.h>

namespace understudy::control {

using machine::Fault;
using machine::Status;

Stop stop_of(Status answer, const machine::MachinePort& port) {
  if (answer == Status::ok) return {};
  Stop stop;
  stop.status = answer;
  stop.fault = port.state().fault;
  stop.time = port.now();
  stop.why = answer == Status::faulted
                 ? fmt::format("the machine reports a fault: {}", to_string(stop.fault))
                 : fmt::format("the machine did not take the motion: {}", to_string(answer));
  return stop;
}

Stop stop_of(GapStop reason, const std::string& why, const machine::MachinePort& port) {
  Stop stop;
  stop.gap = reason;
  stop.fault = port.state().fault;
  if (stop.fault != Fault::none) stop.status = Status::faulted;
  stop.time = port.now();
  stop.why = fmt::format("{}: {}", to_string(reason), why);
  return stop;
}

}  // namespace understudy::control
