// Follows a path of poses point by point with redundant axes (Yu 2023, figure 5): the way to the next point
// plus a PI controller's answer to the error left at the last one, made into axis steps of the smallest norm.
// The paper stops there. `corrections` adds Newton steps at each point, which remove what the first step's
// linearisation leaves. Here, to reproduce the paper's figures with the product's minimum_norm_rates: the
// product itself plans with Mechanism::inverse.
#pragma once

#include <array>
#include <span>

#include "kinematics/chain/minimum_norm.h"

namespace understudy::kinematics {

struct FollowerOptions {
  double proportional = 3.5;  ///< [1/s], kp of the paper
  double integral = 0.2;      ///< [1/s^2], ki of the paper
  double period = 1e-3;       ///< [s] from point to point; kp period < 1, or the errors grow
  double metric = 0.1;        ///< [m], weight of a radian in the norm
  int corrections = 1;        ///< Newton steps at each point; 0 is the paper's scheme
  /// z of eq 4, added to each step as far as it does not move the task; [m] and [rad] per point.
  AxisVector null_space_motion{};
};

class FinishingFollower {
 public:
  /// `start`: axis positions, chain.size() of them. The chain is copied.
  FinishingFollower(const Chain& chain, std::span<const double> start, const FollowerOptions& options);

  /// One step to the next point; axes() then hold the result. On any status but `ok` they stay as they were.
  /// `bad_input`: a pose, start or option that is not finite or not rigid, gains that make errors grow.
  SolveStatus step(const Pose& X_ST_target);

  std::span<const double> axes() const { return {axes_.data(), chain_.axes.size()}; }
  Pose pose() const { return forward(chain_, axes()); }  ///< X_ST

 private:
  Chain chain_;
  FollowerOptions options_;
  bool usable_ = false;
  AxisVector axes_{};
  Twist error_ = Twist::Zero();  // left at the last point
  Twist sum_ = Twist::Zero();    // its integral over time
};

}  // namespace understudy::kinematics
