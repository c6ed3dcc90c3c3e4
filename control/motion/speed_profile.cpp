#include "control/motion/speed_profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace understudy::control {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNoSlope = 1e-9;  // below, a channel does not feel u: 1e-9 of any acceleration is rounding
constexpr int kNewtonSteps = 60;   // each removes one line of at most 30 from the search: never met

// |A u + B x| <= C with A >= 0.
struct Bound {
  double A, B, C;
};

struct Bounds {
  std::array<Bound, std::size_t{2} * kChannelsMax> rows;
  int count = 0;

  void add(double A, double B, double C) {
    const double sign = A < 0 ? -1 : 1;
    rows[count++] = {sign * A, sign * B, C};
  }
};

Bounds bounds_of(const Piece& piece, const ChannelLimits& limits) {
  Bounds bounds;
  for (int i = 0; i < limits.count; ++i) {
    const double curvature = (piece.slope_end[i] - piece.slope_begin[i]) / piece.length;
    double C = limits.acceleration[i] * (1 - piece.used[i]);
    if (i == limits.count - 1) C = std::min(C, piece.tip_acceleration);
    bounds.add(piece.slope_begin[i], curvature, C);
    // At the end x has become x + 2 length u.
    bounds.add(piece.slope_end[i] + 2 * piece.length * curvature, curvature, C);
  }
  return bounds;
}

// A bound on u that is linear in x.
struct Line {
  double at_0, slope;
  double at(double x) const { return at_0 + slope * x; }
};

struct Range {
  Line low, high;
};

// The tightest bounds on u at x, also such that x at the end of the piece stays in [0, x_end_max].
Range acceleration_range(const Bounds& bounds, double length, double x_end_max, double x) {
  Range range{{0, -0.5 / length}, {0.5 * x_end_max / length, -0.5 / length}};
  for (int k = 0; k < bounds.count; ++k) {
    const auto& [A, B, C] = bounds.rows[k];
    if (A < kNoSlope) continue;
    const Line low{-C / A, -B / A}, high{C / A, -B / A};
    if (low.at(x) > range.low.at(x)) range.low = low;
    if (high.at(x) < range.high.at(x)) range.high = high;
  }
  return range;
}

// Largest x in [0, cap] that leaves a choice of u. high(x) - low(x) is concave and not negative at x = 0, so
// Newton's steps from above come down to its root without passing it.
double largest_speed2(const Bounds& bounds, double length, double x_end_max, double cap) {
  double x = cap;
  for (int k = 0; k < bounds.count; ++k) {
    const auto& [A, B, C] = bounds.rows[k];
    if (A < kNoSlope && std::abs(B) * x > C) x = C / std::abs(B);
  }
  for (int step = 0; step < kNewtonSteps; ++step) {
    const auto [low, high] = acceleration_range(bounds, length, x_end_max, x);
    if (low.at(x) <= high.at(x)) return x;
    const double closing = low.slope - high.slope;
    const double root = closing > 0 ? (high.at_0 - low.at_0) / closing : 0;
    if (!(root < x)) return x;  // met but for rounding
    x = std::max(root, 0.0);
  }
  return x;
}

double node_cap(const std::deque<Piece>& pieces, std::size_t k) {
  const Piece& piece = pieces[k];
  double speed = std::min(piece.node_speed_max, piece.speed_max);
  if (k > 0 && pieces[k - 1].length > 0) speed = std::min(speed, pieces[k - 1].speed_max);
  return speed * speed;
}

// The corner at node k with those before it that can fall into the same cycle.
struct CornerWindow {
  std::size_t first = 0;
  double length = 0;  // [m], from the first corner to node k
  double speed = 0;
  ChannelArray jump{};
};

CornerWindow corner_window(const std::deque<Piece>& pieces, std::size_t k, const ChannelLimits& limits) {
  const double speed = std::min(pieces[k].node_speed_max, pieces[k].speed_max);
  CornerWindow window{k, 0, std::min(speed, corner_speed(pieces[k].jump, limits)), pieces[k].jump};
  double distance = 0;
  for (std::size_t j = k; j-- > 0;) {
    const Piece& piece = pieces[j];
    distance += piece.length;
    if (piece.length == 0 || pieces[j + 1].node_speed_max == 0) break;
    if (distance > cycle_reach(window.speed, piece.slope_begin, limits)) break;
    if (!piece.corner) continue;
    ChannelArray sum = window.jump;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += piece.jump[i];
    // So slow that the two fall into different cycles would do as well.
    const double reach_at_rest = cycle_reach(0, piece.slope_begin, limits);
    const double apart = std::max(0.0, distance - reach_at_rest) / limits.cycle_time;
    const double together = corner_speed(sum, limits);
    if (together < apart) {
      window.speed = std::min(window.speed, apart);
      break;
    }
    window = {j, distance, std::min(window.speed, together), sum};
  }
  return window;
}

void take_share(Piece& piece, const CornerWindow& window, const ChannelLimits& limits) {
  for (int i = 0; i < limits.count; ++i) {
    const double jump = window.speed * window.jump[i];
    if (jump <= limits.velocity_jump[i]) continue;
    const double share = (jump - limits.velocity_jump[i]) / (limits.acceleration[i] * limits.cycle_time);
    piece.used[i] = std::max(piece.used[i], std::min(share, limits.corner_share));
  }
}

}  // namespace

double Piece::duration() const {
  if (length == 0) return rest;
  return 2 * length / (std::sqrt(node_speed2) + std::sqrt(end_speed2));
}

double corner_speed(const ChannelArray& jump, const ChannelLimits& limits) {
  double speed = kInfinity;
  for (int i = 0; i < limits.count; ++i)
    if (jump[i] > 0)
      speed = std::min(speed, (limits.corner_share * limits.acceleration[i] * limits.cycle_time +
                               limits.velocity_jump[i]) /
                                  jump[i]);
  return speed;
}

double jump_speed(const ChannelArray& slope, const ChannelLimits& limits) {
  double speed = kInfinity;
  for (int i = 0; i < limits.count; ++i)
    if (std::abs(slope[i]) > kNoSlope) speed = std::min(speed, limits.velocity_jump[i] / std::abs(slope[i]));
  return speed;
}

double cycle_reach(double speed, const ChannelArray& slope, const ChannelLimits& limits) {
  double acceleration = kInfinity;
  for (int i = 0; i < limits.count; ++i)
    if (std::abs(slope[i]) > kNoSlope)
      acceleration = std::min(acceleration, limits.acceleration[i] / std::abs(slope[i]));
  if (acceleration == kInfinity) acceleration = 0;
  return limits.cycle_time * (speed + 0.5 * acceleration * limits.cycle_time);
}

void limit_corners(std::deque<Piece>& pieces, const ChannelLimits& limits) {
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    if (!pieces[k].corner) continue;
    const CornerWindow window = corner_window(pieces, k, limits);
    for (std::size_t j = window.first; j <= k; ++j)
      pieces[j].node_speed_max = std::min(pieces[j].node_speed_max, window.speed);
    const double reach = cycle_reach(window.speed, pieces[k].slope_begin, limits);
    double distance = 0;
    for (std::size_t j = k; j < pieces.size() && distance < reach; distance += pieces[j++].length)
      take_share(pieces[j], window, limits);
    distance = 0;
    for (std::size_t j = k; j-- > 0 && distance < reach + window.length; distance += pieces[j].length)
      take_share(pieces[j], window, limits);
  }
}

void plan_speeds(std::deque<Piece>& pieces, double speed2_begin, const ChannelLimits& limits) {
  double next = 0;
  for (std::size_t k = pieces.size(); k-- > 0;) {
    Piece& piece = pieces[k];
    piece.end_speed2 = next;
    const double cap = node_cap(pieces, k);
    if (cap > 0 && piece.length > 0)
      piece.node_speed2 = largest_speed2(bounds_of(piece, limits), piece.length, next, cap);
    else
      piece.node_speed2 = cap;
    next = piece.node_speed2;
  }
  double x = pieces.empty() ? 0 : std::min(speed2_begin, pieces.front().node_speed2);
  for (Piece& piece : pieces) {
    piece.node_speed2 = x;
    if (piece.length > 0) {
      const double u =
          acceleration_range(bounds_of(piece, limits), piece.length, piece.end_speed2, x).high.at(x);
      piece.end_speed2 = std::clamp(x + 2 * piece.length * u, 0.0, piece.end_speed2);
    }
    x = piece.end_speed2;
    assert(piece.length == 0 || piece.node_speed2 + piece.end_speed2 > 0);
  }
}

}  // namespace understudy::control
