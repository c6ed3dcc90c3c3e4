// A mechanism along a segment: axis positions and rates at any place of it, and whether it can be followed.
#pragma once

#include <optional>
#include <span>
#include <utility>

#include "control/motion/path_segment.h"
#include "kinematics/mechanism.h"

namespace understudy::control {

/// An axis that turns farther between two such poses goes through a singular pose, not along a path.
constexpr double kMaxAxisJump = 0.7;     // [rad], 40 degrees
constexpr double kCheckTravel = 0.5e-3;  // [m]; a strut's length between bends by 0.2 um at the most
constexpr double kCheckTurn = 0.0175;    // [rad], 1 degree

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
  std::span<const kinematics::AxisWord> rotary_words_;
};

}  // namespace understudy::control
