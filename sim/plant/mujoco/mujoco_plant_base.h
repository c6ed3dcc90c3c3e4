// What all machines in MuJoCo share: driven joints, stepping, settling, and the checks that a result is one.
// Private to this room.
#pragma once

#include <string>
#include <vector>

#include "sim/plant/mujoco/mujoco_engine.h"
#include "sim/plant/plant.h"

namespace understudy::sim {

/// A joint that a drive moves, and the play joints behind it, by their names in the model.
struct DrivenJoint {
  std::string name;               ///< joint; its equality has the same name unless the drive is elastic
  std::vector<std::string> play;  ///< limited joints that a looser axis widens; the first takes it all
  bool angle = false;
};

class MujocoPlantBase : public Plant {
 public:
  MujocoPlantBase(const machine::MachineDescription& machine, const MujocoOptions& options);

  std::string engine() const override;
  double timestep() const override { return options_.timestep; }
  double time() const override { return data_->time; }
  void step(const DriveCommand& command) override;
  kinematics::AxisVector displacement() const override;
  kinematics::AxisVector drive_force() const override;
  void set_condition(int axis, const AxisCondition& condition) override;
  double closure_error() const override;

 protected:
  /// Compiles the model; `assembled`: drive displacements at which the driven joints read 0.
  void load(const std::string& mjcf, const std::vector<DrivenJoint>& joints,
            const kinematics::AxisVector& assembled);
  /// Holds the drives at `displacement` until everything is at rest; time is 0 afterwards.
  void settle(const kinematics::AxisVector& displacement);
  /// The equalities, by name, that close the mechanism's loops: the first of the model, in this order.
  void set_closures(const std::vector<std::string>& names);
  /// Not in a drive's reading, in addition to growth: [m] or [rad].
  virtual double hidden_travel(int) const { return 0; }
  void fail_until_reset() { failed_ = true; }

  const machine::MachineDescription machine_;
  const MujocoOptions options_;
  ModelPointer model_;
  DataPointer data_;

 private:
  struct Drive {
    int qpos = 0, dof = 0, joint = 0;
    int equality = -1;  ///< -1: elastic
    int play = -1;      ///< joint
    double play_built = 0;
    double damping = 0;  ///< of an elastic drive [N s/m] or [N m s/rad]
    AxisCondition condition;
    double hidden = 0;      ///< growth and hidden travel that the last command included
    bool following = true;  ///< false once released
    double held = 0;        ///< joint position of a self-locking drive that was released
  };
  void command_drives(const DriveCommand& command);
  void let_go(const Drive& drive);
  void check_closures() const;
  void check_state(const DriveCommand& command) const;
  double largest_speed() const;  ///< [m/s] and [rad/s], of all joints
  double force_of(const Drive& drive) const;

  std::vector<Drive> drives_;
  kinematics::AxisVector assembled_{};
  int closures_ = 0;
  bool failed_ = true;  ///< the state is no result
};

}  // namespace understudy::sim
