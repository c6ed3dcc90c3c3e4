// Cuts segments into pieces for the speed profile: fine where the speed has to change, coarse elsewhere.
#pragma once

#include <deque>
#include <vector>

#include "control/motion/path_kinematics.h"
#include "control/motion/speed_profile.h"

namespace understudy::control {

/// Largest speed of s at which the axes' velocity limits and the programmed speed hold, with these slopes.
double speed_limit(double programmed, const ChannelArray& slope, const MotionLimits& limits, int axis_count);

/// |Change of dq/ds| where `after` follows `before`: axes by absolute value, the tip as a vector.
ChannelArray corner_jump(const PathSegment& before, const PathSegment& after, int axis_count);

/// A segment among its neighbours.
struct SegmentPlace {
  std::size_t number = 0;  ///< running
  double exit_speed = 0;   ///< [m/s] of s, at most, where it ends; 0: at rest
  ChannelArray jump{};     ///< |change of dq/ds| from the segment before
};

/// Limits as a program states them, and as the speed profile takes them.
struct PlannerLimits {
  MotionLimits motion;
  ChannelLimits channels;
};

/// Appends the pieces of `segment`. `position`: near axis positions on entry, those at the segment's end on
/// return.
void append_pieces(const PathSegment& segment, const SegmentPlace& place, const PathKinematics& kinematics,
                   const PlannerLimits& limits, kinematics::AxisVector& position, std::deque<Piece>& pieces);

}  // namespace understudy::control
