// What all machines in Bullet share: drives, stepping, settling, and the checks that a result is one. No
// collision world: the multibody algorithm and its constraint solver are called in the order of
// btMultiBodyDynamicsWorld. Private to this room.
#pragma once

#include <string>
#include <vector>

#include "sim/plant/bullet/bullet_play.h"
#include "sim/plant/bullet/bullet_solver.h"
#include "sim/plant/plant.h"

namespace understudy::sim {

class BulletPlantBase : public Plant {
 public:
  BulletPlantBase(const machine::MachineDescription& machine, const BulletOptions& options);

  std::string engine() const override;
  double timestep() const override { return options_.timestep; }
  double time() const override { return static_cast<double>(steps_) * options_.timestep; }
  void step(const DriveCommand& command) override;
  kinematics::AxisVector displacement() const override;
  kinematics::AxisVector drive_force() const override;
  double closure_error() const override { return 0; }
  void set_condition(int axis, const AxisCondition& condition) override;

 protected:
  /// A joint with dampers, of a tree that add_body() took.
  struct DampedJoint {
    btMultiBody* tree;
    int link;
    double damping;  ///< [N m s/rad]
  };
  /// Forgets the machine and fails until settle() has succeeded.
  void clear();
  /// `weight`: gravity acts on it.
  btMultiBody& add_body(std::unique_ptr<btMultiBody> body, bool weight = true);
  btMultiBodyConstraint& add_constraint(std::unique_ptr<btMultiBodyConstraint> constraint);
  void add_damping(const DampedJoint& joint) { damped_.push_back(joint); }
  /// The next axis' drive, at `displacement`, holds a joint that reads displacement + zero without play.
  void add_drive(btMultiBody& tree, int link, double displacement, double zero,
                 const BulletPlay::Properties& play);
  void set_gravity(const Vec3& gravity_W) { gravity_W_ = gravity_W; }
  /// Holds the drives at `displacement` until everything is at rest; time is 0 afterwards.
  void settle(const kinematics::AxisVector& displacement);
  /// Throws MachineError when the state is no machine any more.
  virtual void check_assembly() const {}
  /// Called when every body's frames are those of the step's beginning.
  virtual void before_step() {}
  /// Not in a drive's reading, in addition to growth: [m] or [rad].
  virtual double hidden_travel(int) const { return 0; }

  const machine::MachineDescription machine_;
  const BulletOptions options_;

 private:
  struct Drive {
    BulletPlay* play = nullptr;
    btMultiBody* rotor = nullptr;  ///< of an elastic drive
    double zero = 0;
    double play_built = 0;
    double position = 0, velocity = 0;                ///< of the motor side, where it is rigid
    double spring_position = 0, spring_velocity = 0;  ///< of an elastic drive's field
    double hidden = 0;
    AxisCondition condition;
    bool following = true;  ///< false once released
  };
  void command_drives(const DriveCommand& command);
  void turn_rotor(std::size_t axis);
  void integrate();
  void move_motors();
  void check_state(const DriveCommand& command) const;
  double largest_speed() const;  ///< [m/s] and [rad/s], of all joints

  std::vector<std::unique_ptr<btMultiBody>> bodies_;
  std::vector<bool> has_weight_;
  std::vector<std::unique_ptr<btMultiBodyConstraint>> constraints_;
  std::vector<btMultiBodyConstraint*> solved_;  ///< the same, as the solver takes them
  std::unique_ptr<BulletSolver> solver_;
  std::vector<DampedJoint> damped_;
  std::vector<Drive> drives_;
  Vec3 gravity_W_ = Vec3::Zero();
  btAlignedObjectArray<btScalar> scratch_r_;
  btAlignedObjectArray<btVector3> scratch_v_;
  btAlignedObjectArray<btMatrix3x3> scratch_m_;
  btAlignedObjectArray<btQuaternion> scratch_q_;
  long steps_ = 0;
  bool failed_ = true;  ///< the state is no result
};

}  // namespace understudy::sim
