// The fastest speed along a path cut into pieces, within speed and acceleration limits of every channel.
//
// x = (ds/dt)^2 at the nodes between pieces, constant path acceleration u on each piece, so x is linear in s.
// With q the channel's position, q'' = q' u + q'' x (primes: d/ds). On a piece q' is taken as linear, so the
// bound |q' u + q'' x| <= a at both its ends holds between them. A backward pass finds the largest x at each
// node from which the path can still be followed to rest at its end; a forward pass then takes the largest u
// (Pham and Pham 2018, reachability analysis).
#pragma once

#include <cstdint>
#include <deque>
#include <limits>

#include "control/motion/path_segment.h"

namespace understudy::control {

/// A piece of a segment, with the node at its beginning.
struct Piece {
  std::size_t segment = 0;  ///< running number
  double begin = 0;         ///< [m], s in its segment
  double length = 0;        ///< [m]; 0 for a rest
  double rest = 0;          ///< [s]
  double speed_max = 0;     ///< [m/s]
  /// [m/s^2] of the last channel, the tip, besides its limit. Not at corners.
  double tip_acceleration = std::numeric_limits<double>::infinity();
  ChannelArray slope_begin{}, slope_end{};  ///< dq/ds
  ChannelArray used{};  ///< part of each acceleration limit that jumps at corners near by may take

  double node_speed_max =
      0;                ///< [m/s], where the piece begins; 0: at rest there. Of a rest: with which it is met
  bool corner = false;  ///< `jump` is not 0
  ChannelArray jump{};  ///< |change of dq/ds| from the piece before

  double node_speed2 = 0;   ///< planned x where it begins [m^2/s^2]
  double end_speed2 = 0;    ///< planned x where it ends
  double duration() const;  ///< [s]
};

struct ChannelLimits {
  int count = 0;
  ChannelArray acceleration{};   ///< [m/s^2 or rad/s^2]
  ChannelArray velocity_jump{};  ///< [m/s or rad/s], at corners, besides the share of acceleration
  double cycle_time = 0;         ///< [s]
  /// Of each acceleration limit, for the jump of velocity at a corner; the rest is for what else happens in
  /// that cycle. The corners passed within one cycle share it, and `velocity_jump`.
  double corner_share = machine::PlannerSettings{}.corner_share;
};

/// Largest speed at which a lone corner stays within its share.
double corner_speed(const ChannelArray& jump, const ChannelLimits& limits);

/// Largest speed that a motion stops from, or starts with, by `velocity_jump` alone.
double jump_speed(const ChannelArray& slope, const ChannelLimits& limits);

/// Path run through in one cycle that begins at `speed`, within the channels' accelerations.
double cycle_reach(double speed, const ChannelArray& slope, const ChannelLimits& limits);

/// Lowers node_speed_max and raises `used` for the corners among the pieces. Idempotent.
void limit_corners(std::deque<Piece>& pieces, const ChannelLimits& limits);

/// Fills node_speed2 and end_speed2 of all pieces: from x = speed2_begin to rest at the end. A rest is met
/// with its node_speed2, and the motion after it starts with its end_speed2.
void plan_speeds(std::deque<Piece>& pieces, double speed2_begin, const ChannelLimits& limits);

}  // namespace understudy::control
