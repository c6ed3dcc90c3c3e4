// A port that tells what another says of its axes while time passes.
#pragma once

#include <deque>
#include <functional>

#include "machine/load_reading.h"
#include "machine/port.h"

namespace understudy::cli {

struct SeenMotion {
  machine::AxisState state;
  int line = 0;         ///< G-code line of the setpoint that is due
  double filament = 0;  ///< [m], fed by then
};

/// Changes nothing of what the other port does.
class WatchedPort : public machine::MachinePort, public machine::LoadSide {
 public:
  /// `seen` is called after each wait, on the thread that waits. The port must outlive this object.
  WatchedPort(machine::MachinePort& port, std::function<void(const SeenMotion&)> seen)
      : port_(port), seen_(std::move(seen)) {}

  int axis_count() const override { return port_.axis_count(); }
  double now() const override { return port_.now(); }
  machine::AxisState state() const override { return port_.state(); }
  bool read_load(machine::LoadReading& reading) const override { return machine::read_load(port_, reading); }
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override;
  machine::Status wait_until(double time) override;
  machine::Status urgent(machine::UrgentCommand command) override { return port_.urgent(command); }
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline) override {
    return port_.set_outputs(outputs, deadline);
  }
  machine::Status capture(const Region& region, machine::Frame& frame, double deadline) override {
    return port_.capture(region, frame, deadline);
  }

 private:
  struct Due {
    double time = 0;
    int line = 0;
    double filament = 0;
  };

  machine::MachinePort& port_;
  std::function<void(const SeenMotion&)> seen_;
  std::deque<Due> due_;
  Due last_;
};

}  // namespace understudy::cli
