// A machine as built that is driven from pose to pose through its port, as a lab does to calibrate it: play,
// gravity, microsteps, errors of the screws and heat are the plant's.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "sim/plant/plant.h"
#include "sim/twin/simulated_port.h"

namespace understudy::studies {

/// From which side axes come to where they stop.
enum class StopSide { lengthening, shortening };

struct SessionOptions {
  std::string engine = "quasistatic";  ///< or mujoco
  StopSide side = StopSide::lengthening;
  /// Growth of every axis by warming, [m] or [rad]: `growth` (1 - exp(-t / time)). Of struts: the length at
  /// which it is reckoned is the middle of their range.
  double growth = 0;
  double warming_time = 0;  ///< [s]; above 0 where there is growth
  bool gravity = true, play = true, microsteps = true;
};

const std::vector<std::string>& session_engines();

class PlantSession {
 public:
  /// The machine rests at home. `drawn` must outlive the session. Throws InputError for an engine that is
  /// none.
  PlantSession(const machine::MachineDescription& drawn, const sim::AsBuilt& built,
               const SessionOptions& options);
  ~PlantSession();

  /// Drives all axes at once, straight and smoothly: first 1 mm or 0.5 degrees beyond (less at the end of a
  /// range), then from the stated side to `axes` [m or rad, as the controller commands them]. Waits until the
  /// tool rests; returns its true pose X_WT. Throws InputError for axes out of range, MachineError for a
  /// plant that fails or does not come to rest.
  Pose visit(const std::vector<double>& axes);

  double now() const;  ///< [s], the port's clock

 private:
  void drive_to(const std::vector<double>& axes);
  Pose rest();

  const machine::MachineDescription& drawn_;
  SessionOptions options_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  std::unique_ptr<sim::Plant> plant_;
  std::unique_ptr<sim::SimulatedPort> port_;
  std::vector<double> at_;  ///< axes as commanded last
};

/// Struts that warm by `rise` [K] while these stops are visited from home, 95 % of it by the last.
void set_warming(const machine::MachineDescription& machine, double rise,
                 const std::vector<std::vector<double>>& stops, SessionOptions& options);

}  // namespace understudy::studies
