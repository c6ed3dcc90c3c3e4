// Six-axis arm with a spherical wrist (Ishak 2018; dimensions as in docs/reference.md#robot-arm).
//
// All axes at 0: the upper arm points up, the forearm along x of B. j1 turns about z of B; j2 and j3 about y
// (positive leans forwards); j4 and j6 about the forearm's and the flange's own axis, along x; j5 about y.
// The flange F then has x up and z, its axis, forwards.
#pragma once

#include <array>
#include <span>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

constexpr int kArmAxes = 6;
constexpr int kArmBranches = 8;

using ArmAxes = std::array<double, kArmAxes>;  ///< [rad]

struct ArmGeometry {
  double d1 = 0;  ///< [m], height of axis 2 over the base
  double a1 = 0;  ///< [m], of axis 2 before axis 1
  double a2 = 0;  ///< [m], upper arm, axis 2 to axis 3; above 0
  double a3 = 0;  ///< [m], of the forearm's axis above axis 3
  double d4 = 0;  ///< [m], axis 3 to the wrist centre along the forearm; above 0
  double d6 = 0;  ///< [m], wrist centre to the flange
  Pose X_FT = Pose::Identity();
};

/// From the parameters of the kind "arm", in SI: d1 a1 a2 a3 d4 d6, the tip's place in F, and the tilt of the
/// nozzle. Untilted, z of T points back along the flange's axis; a positive tilt leans the nozzle towards x
/// of F.
ArmGeometry arm_geometry(std::span<const double> parameters);

/// The same arm as products of exponentials; axes j1..j6 without limits.
Chain arm_chain(const ArmGeometry& geometry);

/// Which of the eight ways to reach a pose.
struct ArmBranch {
  bool back = false;     ///< the wrist centre lies behind axis 2, seen along j1
  bool bent_up = false;  ///< elbow: q3 + atan2(d4, a3) is negative; the forearm folds up over the upper arm
  bool flipped = false;  ///< wrist: q5 is negative
  bool operator==(const ArmBranch&) const = default;
};

struct ArmSolution {
  ArmAxes axes{};  ///< in (-pi, pi]
  ArmBranch branch;
};

struct ArmSolutions {
  std::array<ArmSolution, kArmBranches> all;
  int count = 0;
};

/// Every solution of the closed form; its residual is rounding. 0 where the wrist centre is out of reach or
/// X_BT is no pose. Where the axes of j4 and j6 coincide, or the wrist centre lies on axis 1 or 2, the angle
/// that is free stays as in `previous` (0 if empty) and stands for its whole family. Neither allocates nor
/// throws.
int arm_branches(const ArmGeometry& geometry, const Pose& X_BT,
                 std::span<ArmSolution, kArmBranches> solutions, std::span<const double> previous = {});

/// How far the arm is from each of its three singular postures.
struct ArmClearance {
  double wrist = 0;     ///< [rad], q5 from 0 or half a turn, where j4 and j6 turn about one line
  double elbow = 0;     ///< [m], wrist centre from the stretched or the folded arm
  double shoulder = 0;  ///< [m], wrist centre from axis 1
};
ArmClearance arm_clearance(const ArmGeometry& geometry, std::span<const double> axes);

/// Nearer than this, check() reports a singularity: there an axis turns 20 times as fast as the tool, or at
/// more than 50 rad per metre that the wrist centre travels (an arm of the size of
/// docs/reference.md#robot-arm).
constexpr ArmClearance kArmClearanceMin{0.05, 1.5e-3, 20e-3};

}  // namespace understudy::kinematics
