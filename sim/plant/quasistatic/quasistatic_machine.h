// Axis mechanics, plays and drive deflection together. Private to this room.
#pragma once

#include "sim/plant/quasistatic/axis_mechanics.h"

namespace understudy::sim {

/// Positions are what the drives read; this adds zero, growth, deflection and play. Motion functions neither
/// throw nor allocate.
class QuasistaticMachine {
 public:
  QuasistaticMachine(const machine::MachineDescription& machine, const AsBuilt& as_built,
                     const QuasistaticOptions& options);

  int axis_count() const { return mechanics_->axis_count(); }
  const AxisMechanics& mechanics() const { return *mechanics_; }
  const BacklashDynamics& plays() const { return plays_; }

  /// Back to home with the plays in their middle.
  void start_from_home();
  /// Play, growth and drives as they were built.
  void repair();
  AxisVector home_displacement() const;
  void place_gap(int axis, double gap) { plays_.place(axis, gap); }
  void loosen(int axis, double play_added);
  void grow(int axis, double growth) { growth_[axis] = growth; }
  void stiffen(int axis) { compliance_[axis] = 0; }  ///< a drive that is locked where it stands

  /// Every play at rest under the load of this sample.
  kinematics::SolveStatus settle(const AxisVector& position, const AxisVector& velocity,
                                 const AxisVector& acceleration);
  /// One step of a path, in which plays may be under way. Commands give the acceleration of a step when it
  /// is over, so the plays are carried to the step's beginning with what is known, and from there ahead.
  struct Step {
    AxisVector end{};           ///< positions at the step's end
    AxisVector velocity{};      ///< at its beginning
    AxisVector acceleration{};  ///< mean over the step before
    AxisVector ahead{};         ///< the one expected during this step
    double duration = 0;        ///< [s], of both
  };
  kinematics::SolveStatus advance(const Step& step);

  Pose tool_pose() const { return mechanics_->tool_pose(); }
  const AxisVector& drive_force() const { return force_; }  ///< [N] or [N m]
  /// [m] or [rad], how far the drives yield.
  AxisVector deflection() const;

 private:
  kinematics::SolveStatus place(const AxisVector& position);
  kinematics::SolveStatus load(const AxisVector& velocity, const AxisVector& acceleration);
  bool let_plays_rest(kinematics::PerAxis<bool>& floating, const AxisVector& position,
                      const AxisVector& velocity, const AxisVector& acceleration,
                      kinematics::SolveStatus& status);

  std::unique_ptr<AxisMechanics> mechanics_;
  kinematics::PerAxis<machine::Drive> drives_;
  BacklashDynamics plays_;   ///< where the tool is
  BacklashDynamics behind_;  ///< at the beginning of the last step
  bool inertia_;
  AxisVector zero_{}, growth_{}, compliance_{}, force_{};
  AxisLoad load_;
  AxisMatrix mass_;
};

}  // namespace understudy::sim
