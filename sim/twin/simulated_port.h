// The twin behind MachinePort: drives with their quantisation, the plant, the microscope, observers.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine/description.h"
#include "machine/load_reading.h"
#include "machine/setpoint_queue.h"
#include "sim/exposure.h"
#include "sim/faults/camera_faults.h"
#include "sim/faults/faults.h"
#include "sim/observer.h"
#include "sim/plant/load_encoders.h"
#include "sim/plant/plant.h"

namespace understudy::sim {

struct TwinOptions {
  double observation_period = 2e-3;  ///< [s], between snapshots
  bool quantise_steps = true;        ///< drives move in whole microsteps
  /// Axes that are asked for more stay at the ends of their ranges; else the port rejects such setpoints.
  bool hold_at_limits = false;
  std::size_t queue_capacity = 4096;
  double nozzle_offset = 0;  ///< [K], of a heated nozzle beyond what was asked for
  std::vector<FaultEvent> faults;
  std::vector<CameraFaultEvent> camera_faults;
  std::uint64_t seed = 0;  ///< of what the camera's faults draw
  /// Of the true machine; nothing, or not present(): the port answers that it has none.
  std::optional<LoadEncoders> load_encoders = {};
};

/// Converts strut lengths of the controller's geometry to drive displacements (length minus nominal l_i0):
/// the as-built errors stay on the other side. Time advances inside wait_until() and capture() only.
class SimulatedPort : public machine::MachinePort, public machine::LoadSide {
 public:
  /// The description, plant and observers must outlive the port; the machine starts at rest at home.
  SimulatedPort(const machine::MachineDescription& machine, Plant& plant, Exposure exposure,
                std::vector<Observer*> observers, const TwinOptions& options = {});
  ~SimulatedPort() override;

  int axis_count() const override;
  double now() const override;
  machine::AxisState state() const override;
  bool read_load(machine::LoadReading& reading) const override;
  machine::Status submit(std::span<const machine::Setpoint> setpoints, double deadline) override;
  machine::Status wait_until(double time) override;
  machine::Status urgent(machine::UrgentCommand command) override;
  machine::Status set_outputs(const machine::Outputs& outputs, double deadline) override;
  machine::Status capture(const Region& region, machine::Frame& frame, double deadline) override;

  /// What the engine said when it failed; empty otherwise. A run with a failure has no result.
  const std::string& engine_failure() const { return engine_failure_; }
  std::uint64_t steps() const { return steps_; }
  /// [s], the age of this process when the first setpoint came; nothing before.
  std::optional<double> first_setpoint_at() const { return first_setpoint_at_; }
  double closure_max() const { return closure_max_; }  ///< [m]
  /// Frames that the camera's faults have changed visibly, or withheld.
  int altered_frames() const { return camera_.altered(); }

 private:
  using Target = machine::SetpointQueue::Target;  ///< by the controller's own geometry
  void advance();
  DriveCommand command_for(const Target& target);
  void coast(const Target& target, DriveCommand command);
  void observe(const Target& target);
  void raise(machine::Fault fault);
  machine::Frame expose(const Region& region);

  const machine::MachineDescription& machine_;
  std::unique_ptr<kinematics::Mechanism> mechanism_;
  Plant& plant_;
  Exposure exposure_;
  std::vector<Observer*> observers_;
  TwinOptions options_;
  kinematics::AxisVector drive_zero_;
  FaultyDrives drives_;
  FaultyCamera camera_;
  machine::Frame former_frame_;     ///< of a camera with faults
  kinematics::AxisVector asked_{};  ///< [m] or [rad], axis positions that the drives were last asked for

  machine::SetpointQueue queue_;

  Pose X_BT_commanded_;
  machine::Outputs outputs_;
  machine::Fault fault_ = machine::Fault::none;
  std::string engine_failure_;
  std::optional<double> first_setpoint_at_;
  std::uint64_t steps_ = 0, frame_number_ = 0;
  int steps_per_observation_ = 1;
  double closure_max_ = 0;
};

}  // namespace understudy::sim
