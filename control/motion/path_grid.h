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

/// Appends the pieces of `segment`, which carries the running number `number` and is left at `exit_speed` at
/// most. `position`: near axis positions on entry, those at the segment's end on return.
void append_pieces(const PathSegment& segment, std::size_t number, double exit_speed,
                   const ChannelArray& jump, const PathKinematics& kinematics, const MotionLimits& motion,
                   const ChannelLimits& channels, kinematics::AxisVector& position,
                   std::deque<Piece>& pieces);

}  // namespace understudy::control
