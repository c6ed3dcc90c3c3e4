// Open chains of axes between the work and the tool, by products of exponentials (Yu 2023, eq 2).
//
// The frame O of the chain is fixed to the machine's frame. Every axis is a screw in O at the position where
// all axes are 0. Axes form a tree: those that carry the tool, and those that carry the work.
//   X_OL(axis) = X_OL(parent) * exp(screw q);   X_OT = X_OL(tool_axis) X_OT0;   X_OS = X_OL(work_axis) X_OS0.
// The chain's pose is the tool seen from the work, X_ST = X_OS^-1 X_OT.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kinematics/mechanism.h"

namespace understudy::kinematics {

constexpr double kEndless = std::numeric_limits<double>::infinity();

struct ChainAxis {
  std::string name;                ///< "j1", "x"
  bool angle = true;               ///< turns about its line; else slides along it
  Vec3 direction = Vec3::UnitZ();  ///< unit, in O
  Vec3 point = Vec3::Zero();       ///< [m], on the line, in O; of a slide, only where it has a rod
  int parent = -1;                 ///< axis that carries this one; -1: the frame
  double lower = -kEndless;        ///< [m] or [rad]
  double upper = kEndless;
};

struct Chain {
  std::vector<ChainAxis> axes;  ///< a parent comes before what it carries; at most kMaxAxes
  int tool_axis = -1;           ///< axis that carries the tool
  int work_axis = -1;           ///< axis that carries the work; -1: the frame
  Pose X_OT_zero = Pose::Identity();
  Pose X_OS_zero = Pose::Identity();
  /// [m]: the lengths of three rods, by which three slides on the frame carry the tool (rods.h), X_OT_zero
  /// from where they meet; no axis carries the tool then. Empty: a tree.
  std::vector<double> rods = {};
  int size() const { return static_cast<int>(axes.size()); }
};

/// Without limits; `direction` is of unit length.
ChainAxis sliding_axis(const std::string& name, const Vec3& direction, int parent);
ChainAxis turning_axis(const std::string& name, const Vec3& direction, const Vec3& point, int parent);

/// Columns: twist of the tool seen from the work per unit of each axis: (velocity of the tip, angular), in S.
using ChainJacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxAxes>;

// None of these allocates or throws; `axes` holds chain.size() finite numbers.

/// exp(screw q).
Pose screw_motion(const ChainAxis& axis, double q);
/// Where each axis has carried its frame: X_OL, the identity when all axes are 0. `poses` holds chain.size().
void link_poses(const Chain& chain, std::span<const double> axes, std::span<Pose> poses);
/// X_ST.
Pose forward(const Chain& chain, std::span<const double> axes);
/// X_ST and its derivative.
Pose forward(const Chain& chain, std::span<const double> axes, ChainJacobian& jacobian);

/// What a machine file says of a chain, beyond the names of its kind.
struct ChainDescription {
  std::string kind;                ///< a ChainKind's name
  std::vector<double> parameters;  ///< SI, in the order of the kind's list
  Chain chain;                     ///< with the limits of its axes
  AxisVector home{};               ///< axis positions
  /// [m]: makes angles comparable to lengths, in condition numbers and in the norm of redundant axes: a
  /// radian weighs as much as this.
  double length_scale = 0.1;
  double condition_max = kEndless;  ///< of axis_rates with that scale
  /// Of a calibrated machine, whose `chain` is the measured one: the chain as drawn. Else without axes.
  Chain design = {};
  /// One or two words of programs that state turning axes, and those of X Y Z in machine coordinates: all
  /// three or none (chain_turns.h).
  std::vector<AxisWord> turn_words = {}, slide_words = {};
};

/// The mechanism of its kind; a numeric inverse where the kind has none of its own.
std::unique_ptr<Mechanism> make_chain_mechanism(const ChainDescription& description);

}  // namespace understudy::kinematics
