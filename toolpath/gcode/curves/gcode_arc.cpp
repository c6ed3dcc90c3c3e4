#include "toolpath/gcode/curves/gcode_arc.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::toolpath {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
// Files have three digits of a millimetre; arcs that were fitted to chords are off by some more.
constexpr double kRounded = 0.02e-3, kRoundedShare = 2e-3;  // [m]; of the radius

struct Plane {
  int u, v;  // axes of a right-handed frame with the normal
};
Plane plane_of(int normal) { return {(normal + 1) % 3, (normal + 2) % 3}; }

Vec2 in_plane(const Vec3& p, const Plane& plane) { return {p[plane.u], p[plane.v]}; }

double angle_of(const Vec2& v) { return std::atan2(v.y(), v.x()); }

/// Above 0 and at most a turn, counter-clockwise.
double turn_between(double from, double to) {
  double turn = std::fmod(to - from, kTurn);
  if (turn <= 0) turn += kTurn;
  return turn;
}

double sweep_of(const Arc& arc, const Vec2& from, const Vec2& to) {
  const bool whole = (from - to).norm() < 1e-9;
  const double a = angle_of(from), b = angle_of(to);
  const double turn = whole ? kTurn : arc.clockwise ? turn_between(b, a) : turn_between(a, b);
  return (arc.clockwise ? -1 : 1) * (turn + kTurn * (arc.turns - 1));
}

}  // namespace

std::optional<Vec3> arc_centre(const Arc& arc, double radius) {
  const Plane plane = plane_of(arc.normal);
  const Vec2 from = in_plane(arc.from, plane), chord = in_plane(arc.to, plane) - from;
  const double half = chord.norm() / 2;
  if (half < 1e-9 || half > std::abs(radius) + kRounded) return std::nullopt;
  const double height = std::sqrt(std::max(0.0, radius * radius - half * half));
  // Left of the chord for the shorter way counter-clockwise.
  const Vec2 left = Vec2(-chord.y(), chord.x()) / (2 * half);
  const Vec2 centre = from + chord / 2 + ((radius < 0) != arc.clockwise ? -height : height) * left;
  Vec3 result = arc.from;
  result[plane.u] = centre.x(), result[plane.v] = centre.y();
  return result;
}

std::optional<double> arc_mismatch(const Arc& arc) {
  const Plane plane = plane_of(arc.normal);
  const Vec2 centre = in_plane(arc.centre, plane);
  const double r0 = (in_plane(arc.from, plane) - centre).norm(),
               r1 = (in_plane(arc.to, plane) - centre).norm();
  const double difference = std::abs(r1 - r0);
  if (r0 > 1e-9 && difference <= std::max(kRounded, kRoundedShare * r0)) return std::nullopt;
  return difference;
}

Chords arc_chords(const Arc& arc, const ChordLimits& limits) {
  const Plane plane = plane_of(arc.normal);
  const Vec2 centre = in_plane(arc.centre, plane);
  const Vec2 from = in_plane(arc.from, plane) - centre, to = in_plane(arc.to, plane) - centre;
  const double r0 = from.norm(), r1 = to.norm(), sweep = sweep_of(arc, from, to);
  const double largest = std::max(r0, r1);
  double chord = chord_angle(largest, limits.tolerance);
  if (largest > limits.tolerance) chord = std::min(chord, std::max(limits.turn, limits.shortest / largest));
  Chords chords{chord_count(sweep, chord), {}};
  if (chords.too_many()) return chords;
  const int count = static_cast<int>(chords.count);
  chords.ends.reserve(static_cast<std::size_t>(count));
  for (int i = 1; i < count; ++i) {
    const double share = static_cast<double>(i) / count, angle = angle_of(from) + share * sweep;
    const double radius = r0 + share * (r1 - r0);
    Vec3 p = arc.from + share * (arc.to - arc.from);
    p[plane.u] = centre.x() + radius * std::cos(angle);
    p[plane.v] = centre.y() + radius * std::sin(angle);
    chords.ends.push_back(p);
  }
  chords.ends.push_back(arc.to);
  return chords;
}

}  // namespace understudy::toolpath
