// What all open chains share behind `Mechanism`: everything but the inverse.
#pragma once

#include <memory>

#include "kinematics/chain/chain.h"
#include "kinematics/chain/chain_turns.h"

namespace understudy::kinematics {

/// Derived classes add inverse(), and may say that the spin about the tool's axis is not theirs to choose.
class ChainMechanism : public Mechanism {
 public:
  /// `follows_spin` false: the task has five dimensions, the tip and the tool's axis.
  ChainMechanism(const ChainDescription& description, bool follows_spin);

  int axis_count() const override { return chain_.size(); }
  std::string axis_name(int axis) const override;
  bool axis_is_angle(int axis) const override;
  AxisRange axis_range(int axis) const override;
  Pose home() const override { return X_ST_home_; }
  bool follows_spin() const override { return follows_spin_; }

  SolveStatus forward(std::span<const double> axes, const Pose& seed, Pose& X_ST) const override;
  SolveStatus axis_rates(const Pose& X_ST, std::span<const double> axes,
                         Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 6>> rates) const override;
  double condition_number(const Pose& X_ST, std::span<const double> axes) const override;
  void check(const Pose& X_ST, std::span<const double> axes,
             std::vector<LimitViolation>& violations) const override;

  std::span<const AxisWord> rotary_words() const override { return description_.turn_words; }
  bool has_slide_words() const override { return !description_.slide_words.empty(); }
  SolveStatus pose_at_turns(const RotaryTarget& at, Pose& X_ST) const override;
  SolveStatus parts_at_turns(const RotaryTarget& at, Mat3& table, Mat3& head) const override;
  SolveStatus pose_at_slides(const RotaryTarget& at, Pose& X_ST) const override;
  SolveStatus slides_at_turns(const RotaryTarget& at, Vec3& slides) const override;
  SolveStatus axes_at_turns(const RotaryTarget& at, const RotaryTarget& rate, std::span<double> axes,
                            std::span<double> axis_rates) const override;

 protected:
  const Chain& chain() const { return chain_; }
  const ChainDescription& description() const { return description_; }
  /// `previous`, or home where it is empty.
  std::span<const double> near(std::span<const double> previous) const;
  /// Finite where given.
  bool usable(std::span<const double> previous) const;
  /// Sum of squares of the axes' differences, a radian weighing length_scale metres. [m^2]
  double distance2(std::span<const double> a, std::span<const double> b) const;
  /// Brings every angle to the turn nearest that of `previous` (home if empty), or to the one nearest of
  /// those within its range. True if `axes` are within the ranges then, or if they continue the motion from
  /// `previous`: a step that is as short as those of a path is never replaced by another turn or branch.
  bool settle(std::span<const double> previous, std::span<double> axes) const;

 private:
  bool within_ranges(std::span<const double> axes) const;
  bool continues(std::span<const double> previous, std::span<const double> axes) const;

  ChainDescription description_;
  const Chain& chain_ = description_.chain;
  bool can_turn(const RotaryTarget& at) const;

  bool follows_spin_;
  Pose X_ST_home_;
  std::unique_ptr<const ChainTurns> turns_;  // of programs with rotary words
};

/// Angle equal to `angle` modulo a turn that is nearest to `near`. [rad]
double nearest_turn(double angle, double near);

/// The same; where that is out of `range` and other turns are within, the one of these nearest to `near`.
double nearest_turn(double angle, double near, AxisRange range);

/// Finite, and a rotation within 1e-6.
bool is_pose(const Pose& X);

/// Damped least squares on the pose error from `axes` on (in and out): ok when both halves of the error are
/// below 1e-12 (m, rad). With `follows_spin` false the spin about the tool's axis is left out. Each step is
/// of the smallest norm, a radian weighing `length_scale` metres. Never throws or allocates.
/// `singular`: it came near (1e-6) but crawls, as where the solution is singular and hardly exists;
/// `unreachable`: the error settled at more than that, in a least distance, perhaps not the only one;
/// `not_converged`: neither within the steps allowed.
SolveStatus solve_numerically(const Chain& chain, const Pose& X_ST, bool follows_spin, double length_scale,
                              std::span<double> axes);

}  // namespace understudy::kinematics
