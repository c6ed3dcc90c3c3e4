#include "toolpath/robot/robot_frames.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::toolpath {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kShortestSide = 1e-6;  // [m], of the triangle of the three points
constexpr double kFlattest = 1e-6;      // of that triangle: sine of the angle between two sides

/// Above 0 and at most a turn, about `axis`.
double turn_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  double turn = std::atan2(axis.dot(from.cross(to)), from.dot(to));
  if (turn <= 1e-12) turn += kTurn;
  return turn;
}

}  // namespace

Mat3 rotation_abc(double a, double b, double c) {
  return (Eigen::AngleAxisd(a, Vec3::UnitZ()) * Eigen::AngleAxisd(b, Vec3::UnitY()) *
          Eigen::AngleAxisd(c, Vec3::UnitX()))
      .toRotationMatrix();
}

Vec3 abc_of(const Mat3& R) {
  const double cos_b = std::hypot(R(0, 0), R(1, 0)), b = std::atan2(-R(2, 0), cos_b);
  if (cos_b < 1e-9) return {std::atan2(-R(0, 1), R(1, 1)), b, 0};
  return {std::atan2(R(1, 0), R(0, 0)), b, std::atan2(R(2, 1), R(2, 2))};
}

std::optional<Chords> arc_through(const std::array<Vec3, 3>& start_via_end, std::optional<double> angle,
                                  double tolerance) {
  const auto& [start, via, end] = start_via_end;
  const Vec3 u = via - start, v = end - start;
  const Vec3 cross = u.cross(v);
  if (u.norm() < kShortestSide || v.norm() < kShortestSide || (end - via).norm() < kShortestSide ||
      cross.norm() < kFlattest * u.norm() * v.norm())
    return std::nullopt;
  // The centre of the circle about the triangle, from `start`.
  const Vec3 to_centre =
      (u.squaredNorm() * v.cross(cross) + v.squaredNorm() * cross.cross(u)) / (2 * cross.squaredNorm());
  const Vec3 centre = start + to_centre, axis = cross.normalized(), first = -to_centre;
  const double sweep = angle ? *angle : turn_about(axis, first, end - centre);
  Chords chords{chord_count(sweep, chord_angle(first.norm(), tolerance)), {}};
  if (chords.too_many()) return chords;
  const int count = static_cast<int>(chords.count);
  chords.ends.reserve(static_cast<std::size_t>(count));
  for (int i = 1; i <= count; ++i)
    chords.ends.push_back(centre + Eigen::AngleAxisd(sweep * i / count, axis) * first);
  if (!angle) chords.ends.back() = end;
  return chords;
}

}  // namespace understudy::toolpath
