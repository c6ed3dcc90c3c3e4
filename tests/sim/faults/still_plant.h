// A plant without mechanics that remembers what its drives and axes were told.
#pragma once

#include <vector>

#include "sim/plant/plant.h"

namespace understudy::sim {

class StillPlant : public Plant {
 public:
  std::string engine() const override { return "still 1"; }
  double timestep() const override { return 1e-3; }
  double time() const override { return time_; }
  void reset(const kinematics::AxisVector& displacement) override { displacement_ = displacement; }
  void step(const DriveCommand& command) override {
    displacement_ = command.position;
    commands.push_back(command);
    time_ += timestep();
  }
  void set_condition(int axis, const AxisCondition& condition) override {
    conditions[static_cast<std::size_t>(axis)] = condition;
    ++changes;
  }
  Pose tool_pose() const override { return Pose::Identity(); }
  kinematics::AxisVector displacement() const override { return displacement_; }
  kinematics::AxisVector drive_force() const override { return {}; }
  double closure_error() const override { return 0; }

  std::vector<DriveCommand> commands;
  kinematics::PerAxis<AxisCondition> conditions{};
  int changes = 0;

 private:
  double time_ = 0;
  kinematics::AxisVector displacement_{};
};

}  // namespace understudy::sim
