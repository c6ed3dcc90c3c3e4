// One programmed step as a curve in a path parameter s: the tip on a straight line, the orientation on the
// shortest arc or as the rotary axes turn it, and what the axes do along it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include "control/motion/motion_limits.h"
#include "toolpath/program.h"

namespace understudy::control {

/// Axes first, then the tip's own speed: what has an acceleration limit.
constexpr int kChannelsMax = machine::kMaxAxes + 1;
using ChannelArray = std::array<double, kChannelsMax>;

/// [m/rad] of path for a turn: s counts tip travel, or turn times this where that is more.
constexpr double kTurnRadius = 5e-3;

/// A step that is shorter than this does not move: rounding of poses leaves so much.
constexpr double kShortestPath = 1e-9;  // [m]

struct PathSegment {
  Pose X_WT_begin = Pose::Identity();
  Pose X_WT_end = Pose::Identity();
  Vec3 travel{0, 0, 0};                        ///< [m], p_end - p_begin in W
  Vec3 turn_axis{0, 0, 1};                     ///< unit, in T at the beginning
  double turn = 0;                             ///< [rad]
  double length = 0;                           ///< [m] of s
  double speed = 0;                            ///< [m/s] of s, programmed
  double acceleration = toolpath::kUnlimited;  ///< [m/s^2] of the tip, programmed
  double rest = 0;  ///< [s], for a segment of no length: a dwell, or filament fed at rest
  double filament_begin = 0, filament_end = 0;  ///< [m], absolute
  int line = 0;
  std::size_t step = 0;
  ChannelArray slope_begin{}, slope_end{};  ///< d(axis)/ds, d(tip)/ds at both ends
  /// The axes move and the tool stays: a table turns under an upright tool. From and to, along all of s.
  struct SelfMotion {
    kinematics::AxisVector from{}, to{};
  };
  std::optional<SelfMotion> self_motion;
  /// The program names the turning axes: they run linearly in s, and the pose is what they make of it. For a
  /// segment of no length, how they stand.
  struct Rotary {
    toolpath::RotaryTurns from, to;
  };
  std::optional<Rotary> rotary;
  int fineness = 1;        ///< by which it is looked at more closely: it passes a singular pose
  double entry_speed = 0;  ///< [m/s] of s, at most, where it begins; 0: at rest

  bool moves() const { return length > 0; }
  Vec3 tip_at(double s) const;
  toolpath::RotaryTurns turns_at(double s) const;  ///< of one with `rotary`
  /// Per unit of s, constant along the segment.
  Vec3 tip_slope() const { return moves() ? Vec3(travel / length) : Vec3::Zero(); }
  Twist twist_W() const;  ///< the same with the angular part, of an orientation on the shortest arc
  double filament_at(double fraction) const;
};

/// A step from X_WT_begin on. Throws InputError naming the line: a pose that is not finite or not rigid, no
/// feed, a negative duration.
PathSegment make_segment(const toolpath::Step& step, const Pose& X_WT_begin,
                         const std::optional<PathSegment::Rotary>& rotary, const MotionLimits& limits);
[[noreturn]] void refuse(int line, const std::string& message);

/// Number of equal parts, each at most `travel` of path and `turn` [rad].
int parts_of(const PathSegment& segment, double travel, double turn);

}  // namespace understudy::control
