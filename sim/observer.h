// Observers read snapshots of the twin and cannot change the run.
#pragma once

#include "core/frames.h"
#include "machine/port.h"

namespace understudy::sim {

/// The truth at one instant.
struct Snapshot {
  double time = 0;                          ///< [s]
  Pose X_WT = Pose::Identity();             ///< true tool pose
  Pose X_WT_commanded = Pose::Identity();   ///< what the axes command means to the nominal geometry
  kinematics::AxisVector axes_commanded{};  ///< SI, controller's geometry
  kinematics::AxisVector axes{};            ///< SI, as the port reports it to the controller
  kinematics::AxisVector axes_reached{};    ///< SI, where the drives are, whatever the port reports
  double filament = 0;                      ///< [m], fed since the start
  double fan = 0;
  double nozzle_temperature = 0;         ///< [K]
  int line = 0;                          ///< G-code line
  double closure_error = 0;              ///< [m]
  kinematics::AxisVector drive_force{};  ///< [N] or [N m], as Plant::drive_force()
};

class Observer {
 public:
  virtual ~Observer() = default;
  virtual void observe(const Snapshot& snapshot) = 0;
};

}  // namespace understudy::sim
