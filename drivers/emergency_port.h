// A port beside which somebody may press the button.
#pragma once

#include <functional>

#include "drivers/driver_port.h"
#include "machine/load_reading.h"

namespace understudy::drivers {

/// Asks `pressed` every 20 ms while time passes, and before each urgent command. Once it says yes, the
/// machine is stopped as an emergency (by what is at hand where the port is no DriverPort: a stop, outputs
/// off), and every call answers `faulted`, with the fault emergency_stop.
class EmergencyPort : public machine::MachinePort, public machine::LoadSide {
 public:
  /// The port must outlive this object.
  EmergencyPort(machine::MachinePort& port, std::function<bool()> pressed)
      : port_(port), pressed_(std::move(pressed)) {}

  int axis_count() const override { return port_.axis_count(); }
  double now() const override { return port_.now(); }
  machine::AxisState state() const override;
  bool read_load(machine::LoadReading& reading) const override { return machine::read_load(port_, reading); }
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override;
  machine::Status wait_until(double time) override;
  machine::Status urgent(machine::UrgentCommand command) override;
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline) override;
  machine::Status capture(const Region& region, machine::Frame& frame, double deadline) override;

  bool stopped() const { return stopped_; }

 private:
  bool stop_if_pressed();

  machine::MachinePort& port_;
  std::function<bool()> pressed_;
  bool stopped_ = false;
};

}  // namespace understudy::drivers
