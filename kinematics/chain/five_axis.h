// Three slides that carry the tool, and a table that tilts (B) and turns (C) (Han 2024;
// docs/reference.md#five-axis-printer).
//   X_ST = [C axis: turn C] [B axis: turn B] (X, Y, Z);   with both axes through the origin
//   p_ST = Rz(C) Ry(B) (X, Y, Z), R_ST = Rz(C) Ry(B); the tool's axis is (sin B cos C, sin B sin C, cos B).
// Axes x y z b c. The frame O of the machine is S, the frame of the work on the table, at B = C = 0. The
// table itself turns by -B about y and by -C about its own z, so positive angles tilt the tool seen from the
// work.
#pragma once

#include <array>
#include <span>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

constexpr int kFiveAxes = 5;
using FiveAxes = std::array<double, kFiveAxes>;  ///< x y z [m], b c [rad]

/// Where the two axes stand at B = C = 0, seen from the work's origin. [m]
struct FiveAxisGeometry {
  double b_axis_x = 0, b_axis_z = 0;  ///< the line of B is parallel to y
  double c_axis_x = 0, c_axis_y = 0;  ///< the line of C is parallel to z
};

/// Branch 0 has B in [0, pi], branch 1 is (-B, C + pi) with slides of its own; angles in [-pi, pi].
struct FiveAxisBranches {
  std::array<FiveAxes, 2> axes{};
  bool turn_is_free = false;  ///< the tool's axis is that of C: c is then what the caller passed as `c_held`
};

Chain five_axis_chain(const FiveAxisGeometry& geometry);

/// Both ways to bring the tool's tip and axis to a pose; its spin is disregarded. `bad_input` unless the pose
/// is rigid and finite.
SolveStatus five_axis_branches(const FiveAxisGeometry& geometry, const Pose& X_ST, double c_held,
                               FiveAxisBranches& branches);

// The two readings of a program line X Y Z B C. Without tool-centre-point control its words are the axes
// themselves; with it X Y Z are the tip's place in the part and the slides follow from it.

/// Without: the pose that axes make. Finite axes are the caller's to see to, here and below.
Pose five_axis_pose(const FiveAxisGeometry& geometry, const FiveAxes& axes);
/// With: the pose whose tip stands at p_ST with the table at b and c.
Pose five_axis_tip_pose(const Vec3& p_ST, double b, double c);
/// With, to axes: b and c stay as they are written, turns and branch included.
FiveAxes five_axis_at_tip(const FiveAxisGeometry& geometry, const Vec3& p_ST, double b, double c);

}  // namespace understudy::kinematics
