#include "control/motion/path_grid.h"

#include <algorithm>
#include <cmath>

namespace understudy::control {
namespace {

constexpr double kPieceMax = 0.5e-3;      // [m]: slopes are linear over it to 1e-4 of a hexapod's limits
constexpr double kPieceTurnMax = 0.0175;  // [rad], 1 degree
constexpr double kSteady = 0.99;          // of the programmed speed; from there nothing needs to be resolved
constexpr int kFinePieces = 10;           // over the way it takes to speed up, and a quarter more
constexpr double kGrowth = 1.5;
constexpr double kGradedPart =
    0.49;  // of a segment's length from each end: what is left between is not nothing

struct End {
  double speed = 0;   // [m/s], at most, where the segment begins or ends
  double reach = 0;   // [m], one cycle from there
  double run_up = 0;  // [m], from that speed to the programmed one at full acceleration
};

End make_end(double speed, double cruise, double cycle_time, const ChannelArray& slope,
             const ChannelLimits& channels) {
  End end{std::min(speed, cruise), cycle_reach(speed, slope, channels), 0};
  const double half_u = (cycle_reach(0, slope, channels)) / (cycle_time * cycle_time);
  if (half_u > 0) end.run_up = (cruise * cruise - end.speed * end.speed) / (4 * half_u);
  // Finer than an eighth of a cycle at full speed gains an eighth of a cycle at the most.
  end.run_up = std::max(end.run_up, cruise * cycle_time);
  return end;
}

// Distances of the nodes from one end of a segment, up to `reach_max`.
void grade(const End& end, double cruise, double piece_max, double reach_max,
           std::vector<double>& distances) {
  distances.clear();
  if (end.speed >= kSteady * cruise) return;
  double at = 0;
  if (end.speed > 0 && end.reach < reach_max / 2) distances.push_back(at = end.reach);
  double piece = end.run_up / (0.8 * kFinePieces);
  for (int n = 1; piece < piece_max; ++n) {
    at += piece;
    if (at >= reach_max) return;
    distances.push_back(at);
    if (n >= kFinePieces) piece *= kGrowth;
  }
}

void make_nodes(double length, double piece_max, const std::vector<double>& from_begin,
                const std::vector<double>& from_end, std::vector<double>& nodes) {
  nodes.assign(1, 0.0);
  nodes.insert(nodes.end(), from_begin.begin(), from_begin.end());
  const double left = nodes.back(), right = length - (from_end.empty() ? 0 : from_end.back());
  // Two at least, or a segment from rest to rest would have no node that moves.
  const int parts = std::max(from_begin.empty() && from_end.empty() ? 2 : 1,
                             static_cast<int>(std::ceil((right - left) / piece_max)));
  for (int k = 1; k <= parts; ++k) nodes.push_back(left + (right - left) * k / parts);
  for (auto it = from_end.rbegin(); it != from_end.rend(); ++it) {
    if (it == from_end.rbegin()) continue;
    nodes.push_back(length - *it);
  }
  if (!from_end.empty()) nodes.push_back(length);
  nodes.back() = length;
}

}  // namespace

double speed_limit(double programmed, const ChannelArray& slope, const MotionLimits& limits, int axis_count) {
  double speed = programmed;
  for (int i = 0; i < axis_count; ++i)
    if (std::abs(slope[i]) * speed > limits.axis_velocity[i])
      speed = limits.axis_velocity[i] / std::abs(slope[i]);
  return speed;
}

ChannelArray corner_jump(const PathSegment& before, const PathSegment& after, int axis_count) {
  ChannelArray jump{};
  for (int i = 0; i < axis_count; ++i) jump[i] = std::abs(after.slope_begin[i] - before.slope_end[i]);
  jump[axis_count] = (after.tip_slope() - before.tip_slope()).norm();
  return jump;
}

void append_pieces(const PathSegment& segment, const SegmentPlace& place, const PathKinematics& kinematics,
                   const PlannerLimits& limits, kinematics::AxisVector& position, std::deque<Piece>& pieces) {
  Piece piece;
  piece.tip_acceleration = segment.acceleration;
  piece.segment = place.number;
  piece.rest = segment.rest;
  piece.jump = place.jump;
  piece.corner = std::any_of(piece.jump.begin(), piece.jump.end(), [](double j) { return j > 0; });
  piece.node_speed_max = segment.entry_speed;
  if (!segment.moves()) {
    piece.speed_max = segment.entry_speed;
    pieces.push_back(piece);
    return;
  }
  const MotionLimits& motion = limits.motion;
  ChannelLimits channels = limits.channels;
  double& tip_acceleration = channels.acceleration[channels.count - 1];
  tip_acceleration = std::min(tip_acceleration, segment.acceleration);
  const double piece_max =
      segment.self_motion ? kTurnRadius * kPieceTurnMax
                          : segment.length / (segment.fineness * parts_of(segment, kPieceMax, kPieceTurnMax));
  const auto cruise = [&](const ChannelArray& slope) {
    return speed_limit(segment.speed, slope, limits.motion, kinematics.axis_count());
  };
  const double cruise_begin = cruise(segment.slope_begin), cruise_end = cruise(segment.slope_end);
  std::vector<double> from_begin, from_end, nodes;
  grade(make_end(segment.entry_speed, cruise_begin, motion.cycle_time, segment.slope_begin, channels),
        cruise_begin, piece_max, kGradedPart * segment.length, from_begin);
  grade(make_end(place.exit_speed, cruise_end, motion.cycle_time, segment.slope_end, channels), cruise_end,
        piece_max, kGradedPart * segment.length, from_end);
  make_nodes(segment.length, piece_max, from_begin, from_end, nodes);

  piece.slope_begin = segment.slope_begin;
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    piece.begin = nodes[k];
    piece.length = nodes[k + 1] - nodes[k];
    // A pose on the way is as good as those that were checked; where it is not, the last slopes hold.
    ChannelArray slope = piece.slope_begin;
    if (kinematics.evaluate(segment, nodes[k + 1], position, slope) != kinematics::SolveStatus::ok)
      slope = piece.slope_begin;
    piece.slope_end = slope;
    piece.speed_max = std::min(cruise(piece.slope_begin), cruise(piece.slope_end));
    pieces.push_back(piece);
    piece.slope_begin = piece.slope_end;
    piece.node_speed_max = piece.speed_max;
    piece.jump.fill(0);
    piece.corner = false;
  }
}

}  // namespace understudy::control
