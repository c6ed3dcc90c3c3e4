#include "drivers/emergency_port.h"

#include <algorithm>

namespace understudy::drivers {

using machine::Fault;
using machine::Status;

namespace {

constexpr double kBetween = 0.02;  // [s]

}  // namespace

bool EmergencyPort::stop_if_pressed() {
  if (stopped_ || !pressed_()) return stopped_;
  stopped_ = true;
  if (auto* driver = dynamic_cast<DriverPort*>(&port_))
    driver->emergency_stop();
  else
    static_cast<void>(port_.urgent(machine::UrgentCommand::stop));
  static_cast<void>(port_.set_outputs({}, port_.now() + 1));
  return true;
}

machine::AxisState EmergencyPort::state() const {
  machine::AxisState state = port_.state();
  if (stopped_) state.fault = Fault::emergency_stop;
  return state;
}

Status EmergencyPort::submit(std::span<const machine::Setpoint> setpoints, double deadline) {
  return stopped_ ? Status::faulted : port_.submit(setpoints, deadline);
}

Status EmergencyPort::wait_until(double time) {
  while (true) {
    if (stop_if_pressed()) return Status::faulted;
    const double before = port_.now(), until = std::min(time, before + kBetween);
    Status answer = port_.wait_until(until);
    if (answer != Status::ok || until >= time) return answer;
    if (port_.now() <= before) return port_.wait_until(time);  // its clock is coarser than that
  }
}

Status EmergencyPort::urgent(machine::UrgentCommand command) {
  stop_if_pressed();
  return port_.urgent(command);
}

Status EmergencyPort::set_outputs(const machine::Outputs& outputs, double deadline) {
  if (stopped_ && !outputs.off()) return Status::faulted;
  return port_.set_outputs(outputs, deadline);
}

Status EmergencyPort::capture(const Region& region, machine::Frame& frame, double deadline) {
  return stopped_ ? Status::faulted : port_.capture(region, frame, deadline);
}

}  // namespace understudy::drivers
