// Redundant axes: of all rates that give a twist, the smallest (Yu 2023, eqs 3-5).
//
// The task has five dimensions: the velocity of the tip, and the turn of the tool's axis. The spin about that
// axis is left to the machine: a redundant stage need not be able to follow it
// (docs/reference.md#finishing-stage). "Smallest" needs a metric between metres and radians: a radian weighs
// as much as `metric` metres.
#pragma once

#include <span>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

/// What is left from one pose to another for the five-dimensional task, in S: the tip's way, and
/// axis x axis_wanted, whose length is the sine of the angle between the two tool axes.
Twist task_error(const Pose& X_ST, const Pose& X_ST_wanted);

/// Angle between the tool axes of two poses; exact for small ones. [rad]
double tool_axis_angle(const Pose& X_ST, const Pose& X_ST_wanted);

/// By how much a motion of the axis counts in the norm, where it stands at `q`: 1 in the middle 80 % of its
/// range, more and more towards an end, so that other axes turn instead (weighted least norm: Chan and Dubey
/// 1995). An axis without two ends always counts 1.
double range_weight(const ChainAxis& axis, double q);

/// J+ X_dot + (I - J+ J) z: rates of the smallest norm that make `twist` (tip velocity, angular velocity; in
/// S), plus the part of `null_space_motion` that moves the tool only about its own axis. The norm is weighted
/// by range_weight(): beside the plain one this is a null-space motion away from ends of ranges. `singular`:
/// J has lost rank; the rates make the part of the twist that is left. `bad_input`: spans shorter than the
/// chain, numbers that are not finite, a metric that is not positive. An empty `null_space_motion` is zero.
/// Never throws or allocates.
SolveStatus minimum_norm_rates(const Chain& chain, std::span<const double> axes, const Twist& twist,
                               double metric, std::span<const double> null_space_motion,
                               std::span<double> rates);

}  // namespace understudy::kinematics
