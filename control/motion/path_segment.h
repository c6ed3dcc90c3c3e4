// One programmed step as a curve in a path parameter s: the tip on a straight line, the orientation on the
// shortest arc or as the rotary axes turn it, and what the axes do along it.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "control/motion/motion_planner.h"

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
  Vec3 travel{0, 0, 0};     ///< [m], p_end - p_begin in W
  Vec3 turn_axis{0, 0, 1};  ///< unit, in T at the beginning
  double turn = 0;          ///< [rad]
  double length = 0;        ///< [m] of s
  double speed = 0;         ///< [m/s] of s, programmed
  double rest = 0;          ///< [s], for a segment of no length: a dwell, or filament fed at rest
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
  toolpath::RotaryTurns turns_at(double s) const;     ///< of one with `rotary`
  Vec3 tip_slope() const { return travel / length; }  ///< per unit of s, constant along the segment
  Twist twist_W() const;  ///< the same with the angular part, of an orientation on the shortest arc
  double filament_at(double fraction) const;
};

/// A step from X_WT_begin on. Throws InputError naming the line: a pose that is not finite or not rigid, no
/// feed, a negative duration.
PathSegment make_segment(const toolpath::Step& step, const Pose& X_WT_begin,
                         const std::optional<PathSegment::Rotary>& rotary, const MotionLimits& limits);
[[noreturn]] void refuse(int line, const std::string& message);

/// The mechanism along a segment.
class PathKinematics {
 public:
  PathKinematics(const kinematics::Mechanism& mechanism, const Pose& X_WB);

  int axis_count() const { return axis_count_; }
  int channels() const { return axis_count_ + 1; }

  /// A step from X_WT_begin on, where the axes stand at `axes_begin`. Throws InputError as make_segment does,
  /// and for a pose that is not the one of the step's B and C.
  PathSegment segment(const toolpath::Step& step, const Pose& X_WT_begin,
                      const kinematics::AxisVector& axes_begin, const MotionLimits& limits) const;

  kinematics::SolveStatus axes(const Pose& X_WT, kinematics::AxisVector& position) const;
  Pose pose_at(const PathSegment& segment, double s) const;
  /// Positions at s (`position` holds a near one on entry: the branch).
  kinematics::SolveStatus axes_at(const PathSegment& segment, double s,
                                  kinematics::AxisVector& position) const;
  /// Positions at s (`position` holds a near one on entry: the branch) and d/ds of every channel.
  kinematics::SolveStatus evaluate(const PathSegment& segment, double s, kinematics::AxisVector& position,
                                   ChannelArray& slope) const;
  /// InputError naming line, part, value and limit for the first pose that is out, the end first, and for an
  /// axis that would have to leap. The poses are at most kCheckTravel and kCheckTurn apart. `position` is
  /// near the segment's beginning on entry, and at its end afterwards. Sets fineness.
  void require_reachable(PathSegment& segment, PoseCheck check, kinematics::AxisVector& position) const;
  /// Where the segment begins in a pose that leaves an axis free, and its way needs that axis elsewhere: the
  /// motion that brings it there first, with the tool at rest.
  std::optional<PathSegment> self_motion_before(const PathSegment& segment,
                                                const kinematics::AxisVector& position) const;
  /// The angle axis that moves most from one to the other, and by how much [rad].
  std::pair<int, double> largest_turn(const kinematics::AxisVector& from,
                                      const kinematics::AxisVector& to) const;

 private:
  struct Walk {
    double condition = 0;  ///< the largest on the way, where the mechanism may pass singular poses
    double leap = 0;       ///< [rad], largest turn of an axis from one look to the next
    int leaping_axis = 0;
  };
  Walk walk(const PathSegment& segment, PoseCheck check, kinematics::AxisVector& position) const;
  kinematics::RotaryTarget turned_tip(const PathSegment& segment, double s) const;
  void require_turns(const toolpath::Step& step) const;
  kinematics::SolveStatus evaluate_rotary(const PathSegment& segment, double s,
                                          kinematics::AxisVector& position, ChannelArray& slope) const;
  kinematics::SolveStatus evaluate_self_motion(const PathSegment& segment, double s,
                                               kinematics::AxisVector& position, ChannelArray& slope) const;

  const kinematics::Mechanism& mechanism_;
  Pose X_WB_, X_BW_;
  int axis_count_;
  std::optional<kinematics::RotaryAxes> rotary_axes_;
};

/// An axis that turns farther between two such poses goes through a singular pose, not along a path.
constexpr double kMaxAxisJump = 0.7;     // [rad], 40 degrees
constexpr double kCheckTravel = 0.5e-3;  // [m]; a strut's length between bends by 0.2 um at the most
constexpr double kCheckTurn = 0.0175;    // [rad], 1 degree

/// Number of equal parts, each at most `travel` of path and `turn` [rad].
int parts_of(const PathSegment& segment, double travel, double turn);

}  // namespace understudy::control
