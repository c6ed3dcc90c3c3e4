// A port that records another: everything that goes through it, in both directions.
#pragma once

#include <filesystem>

#include "machine/load_reading.h"
#include "machine/port.h"
#include "machine/record/record_writer.h"

namespace understudy::machine {

/// Changes nothing of what the other port does, but that longer waits are made in parts, so that its state is
/// seen. Calls of the control cycle write to memory; the file is written in wait_until(), capture() and
/// set_outputs(). A disk that is full throws MachineError there.
class RecordingPort : public MachinePort, public LoadSide {
 public:
  /// Both must outlive this object. `period` [s]: states are recorded so often while time passes.
  RecordingPort(MachinePort& port, RecordWriter& writer, double period = 0.01)
      : port_(port), writer_(writer), period_(period) {}

  int axis_count() const override { return port_.axis_count(); }
  double now() const override { return port_.now(); }
  AxisState state() const override { return port_.state(); }
  bool read_load(LoadReading& reading) const override { return machine::read_load(port_, reading); }
  Status submit(std::span<const Setpoint> setpoints, double deadline) override;
  Status wait_until(double time) override;
  Status urgent(UrgentCommand command) override;
  Status set_outputs(const Outputs& outputs, double deadline) override;
  Status capture(const Region& region, Frame& frame, double deadline) override;

 private:
  void write_positions();

  MachinePort& port_;
  RecordWriter& writer_;
  double period_;
};

}  // namespace understudy::machine
