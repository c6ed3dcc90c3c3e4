#include "toolpath/robot/robot_frames.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::toolpath {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLongestChord = kTurn / 16;  // [rad]
constexpr double kShortestSide = 1e-6;        // [m], of the triangle of the three points
constexpr double kFlattest = 1e-6;            // of that triangle: sine of the angle between two sides

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

std::optional<std::vector<Vec3>> arc_through(const std::array<Vec3, 3>& start_via_end,
                                             std::optional<double> angle, double tolerance) {
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
  const double radius = first.norm();
  const double sweep = angle ? *angle : turn_about(axis, first, end - centre);
  const double chord =
      radius > tolerance ? std::min(kLongestChord, 2 * std::acos(1 - tolerance / radius)) : kLongestChord;
  const int count = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / chord - 1e-9)));
  std::vector<Vec3> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 1; i <= count; ++i)
    points.push_back(centre + Eigen::AngleAxisd(sweep * i / count, axis) * first);
  if (!angle) points.back() = end;
  return points;
}

}  // namespace understudy::toolpath
