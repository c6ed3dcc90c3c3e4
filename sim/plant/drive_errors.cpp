#include "sim/plant/drive_errors.h"

#include <cmath>
#include <numbers>

namespace understudy::sim {
namespace {

double angle_of(const DriveError& error, double lead, double motor) {
  return 2 * std::numbers::pi * motor / lead + error.phase;
}

/// d travel / d motor.
double ratio(const DriveError& error, double lead, double motor) {
  return 1 + error.scale +
         error.periodic * 2 * std::numbers::pi / lead * std::cos(angle_of(error, lead, motor));
}

class DriveErrorPlant : public Plant {
 public:
  DriveErrorPlant(std::unique_ptr<Plant> plant, const machine::MachineDescription& machine,
                  const AsBuilt& built)
      : plant_(std::move(plant)), errors_(built.drives) {
    for (std::size_t i = 0; i < lead_.size(); ++i) lead_[i] = machine.drives[i].lead;
  }

  std::string engine() const override { return plant_->engine(); }
  double timestep() const override { return plant_->timestep(); }
  double time() const override { return plant_->time(); }
  void reset(const AxisVector& displacement) override { plant_->reset(travel(displacement)); }
  void step(const DriveCommand& command) override {
    DriveCommand axes{travel(command.position), command.velocity};
    for (std::size_t i = 0; i < lead_.size(); ++i)
      if (lead_[i] > 0) axes.velocity[i] *= ratio(errors_[i], lead_[i], command.position[i]);
    plant_->step(axes);
  }
  void set_condition(int axis, const AxisCondition& condition) override {
    plant_->set_condition(axis, condition);
  }
  Pose tool_pose() const override { return plant_->tool_pose(); }
  AxisVector displacement() const override {
    AxisVector motors = plant_->displacement();
    for (std::size_t i = 0; i < lead_.size(); ++i)
      if (lead_[i] > 0) motors[i] = motor_travel(errors_[i], lead_[i], motors[i]);
    return motors;
  }
  AxisVector drive_force() const override { return plant_->drive_force(); }
  double closure_error() const override { return plant_->closure_error(); }

 private:
  AxisVector travel(AxisVector motors) const {
    for (std::size_t i = 0; i < lead_.size(); ++i)
      if (lead_[i] > 0) motors[i] = axis_travel(errors_[i], lead_[i], motors[i]);
    return motors;
  }

  std::unique_ptr<Plant> plant_;
  PerAxis<DriveError> errors_;
  AxisVector lead_{};  // [m] or [rad], 0: no drive
};

}  // namespace

double axis_travel(const DriveError& error, double lead, double motor) {
  return (1 + error.scale) * motor +
         error.periodic * (std::sin(angle_of(error, lead, motor)) - std::sin(error.phase));
}

double motor_travel(const DriveError& error, double lead, double axis) {
  double motor = axis;
  // Newton; errors are small beside the lead, so that two or three steps do.
  for (int i = 0; i < 20; ++i) {
    const double step = (axis_travel(error, lead, motor) - axis) / ratio(error, lead, motor);
    motor -= step;
    if (std::abs(step) <= 1e-12 * lead) break;
  }
  return motor;
}

std::unique_ptr<Plant> with_drive_errors(std::unique_ptr<Plant> plant,
                                         const machine::MachineDescription& machine, const AsBuilt& built) {
  bool any = false;
  for (const DriveError& error : built.drives) any = any || error.scale != 0 || error.periodic != 0;
  if (!plant || !any) return plant;
  return std::make_unique<DriveErrorPlant>(std::move(plant), machine, built);
}

}  // namespace understudy::sim
