// Hands setpoints to a port: in batches, through a full queue, until they are executed.
#pragma once

#include <cstdint>
#include <vector>

#include "control/stop.h"
#include "machine/port.h"

namespace understudy::control {

class SetpointStreamer {
 public:
  /// `cycle_time` [s] lies between setpoints.
  SetpointStreamer(machine::MachinePort& port, double cycle_time);

  /// Nothing goes to the port before write(). Does not allocate up to a batch.
  void add(const machine::Setpoint& setpoint) { batch_.push_back(setpoint); }
  /// A batch is complete: half of a small queue, or 256.
  bool full() const { return batch_.size() >= batch_size_; }
  /// Hands over what was added; waits where the queue is full.
  Stop write();

  /// Waits until everything that was handed over is executed.
  Stop wait_until_executed();
  /// Stops the port: the axes brake along what is queued, the rest of it is dropped. Returns when they rest.
  Stop brake();

  /// G-code line of the setpoint that the machine goes to, or rests at; 0 before the first. What was handed
  /// over last may be seconds ahead.
  int line_executed() const;

  machine::MachinePort& port() { return port_; }
  const machine::MachinePort& port() const { return port_; }

 private:
  struct LineStart {
    std::uint64_t setpoint = 0;  ///< counted as the port accepts them
    int line = 0;
  };
  void note_lines(std::uint64_t first);
  /// In slices, so that an interrupt (thrown as Interrupted) is not slept through.
  Stop wait_until(double time);

  machine::MachinePort& port_;
  const double cycle_time_;
  const std::size_t batch_size_;
  std::vector<machine::Setpoint> batch_;
  std::vector<LineStart> lines_;  ///< from the one that is executed on
  double end_time_;               ///< [s], of the last setpoint handed over
  std::uint64_t dropped_ = 0;     ///< setpoints that were handed over and never executed
};

}  // namespace understudy::control
