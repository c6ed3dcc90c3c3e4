// Parts of known axis: a convex outline swept along straight pieces and arcs.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/units.h"
#include "geometry/mesh.h"

namespace understudy {

/// [rad], of two directions.
inline double turn_between(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// A straight piece of `length`, or an arc of `radius` that bends by `angle` towards `azimuth` of the frame
/// by then.
struct SweptPiece {
  double length = 0, radius = 0, angle = 0, azimuth = 0;  // [m], [m], [rad], [rad]
};
inline SweptPiece straight_mm(double length) { return {from_mm(length)}; }
inline SweptPiece arc_mm(double radius, double angle_deg, double azimuth_deg = 0) {
  return {from_mm(radius) * from_deg(angle_deg), from_mm(radius), from_deg(angle_deg), from_deg(azimuth_deg)};
}

/// Where the middle of the outline is after `s` [m] from the foot at the origin, z upwards.
inline Pose swept_pose(const std::vector<SweptPiece>& pieces, double s) {
  Pose at = Pose::Identity();
  for (const SweptPiece& piece : pieces) {
    const double run = std::min(s, piece.length);
    s -= run;
    if (piece.radius == 0) {
      at.translation() += run * at.linear().col(2);
    } else {
      const Vec3 towards = at.linear() * Vec3(std::cos(piece.azimuth), std::sin(piece.azimuth), 0);
      const Vec3 centre = at.translation() + piece.radius * towards;
      const Mat3 turn =
          Eigen::AngleAxisd(run / piece.radius, at.linear().col(2).cross(towards)).toRotationMatrix();
      at.translation() = centre + turn * (at.translation() - centre);
      at.linear() = turn * at.linear();
    }
    if (s <= 0) break;
  }
  return at;
}

inline double swept_length(const std::vector<SweptPiece>& pieces) {
  double length = 0;
  for (const SweptPiece& piece : pieces) length += piece.length;
  return length;
}

inline std::vector<Vec2> circle_mm(double radius, int facets = 180) {
  std::vector<Vec2> outline;
  for (int i = 0; i < facets; ++i) {
    const double a = 2 * std::numbers::pi * i / facets;
    outline.emplace_back(from_mm(radius) * std::cos(a), from_mm(radius) * std::sin(a));
  }
  return outline;
}
inline std::vector<Vec2> oval_mm(double a, double b, int facets = 180) {
  std::vector<Vec2> outline = circle_mm(a, facets);
  for (Vec2& p : outline) p.y() *= b / a;
  return outline;
}
inline std::vector<Vec2> rectangle_mm(double x, double y) {
  const double a = from_mm(x) / 2, b = from_mm(y) / 2;
  return {{-a, -b}, {a, -b}, {a, b}, {-a, b}};
}

inline std::shared_ptr<geometry::Mesh> swept_part(const std::vector<Vec2>& outline,
                                                  const std::vector<SweptPiece>& pieces, double step = 0.5e-3,
                                                  const Vec3& foot_W = Vec3::Zero()) {
  const double length = swept_length(pieces);
  const int rings = static_cast<int>(std::ceil(length / step)), n = static_cast<int>(outline.size());
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int k = 0; k <= rings; ++k) {
    const Pose at = swept_pose(pieces, length * k / rings);
    for (const Vec2& p : outline) vertices.push_back(at * Vec3(p.x(), p.y(), 0) + foot_W);
  }
  for (int k = 0; k < rings; ++k)
    for (int i = 0; i < n; ++i) {
      const int a = k * n + i, b = k * n + (i + 1) % n;
      triangles.push_back({a, b, b + n});
      triangles.push_back({a, b + n, a + n});
    }
  const int foot = static_cast<int>(vertices.size()), head = foot + 1, top = rings * n;
  vertices.push_back(foot_W);
  vertices.push_back(swept_pose(pieces, length).translation() + foot_W);
  for (int i = 0; i < n; ++i) {
    triangles.push_back({foot, (i + 1) % n, i});
    triangles.push_back({head, top + i, top + (i + 1) % n});
  }
  return std::make_shared<geometry::Mesh>(std::move(vertices), std::move(triangles));
}

/// The parts of Han 2024 as far as the paper describes them (4.2 and figure 12): a round section of 12 mm in
/// a part 46 mm high that overhangs by more than 45 degrees, a rectangular section, and an S. The bends are
/// ours.
inline std::vector<SweptPiece> one_bend() { return {straight_mm(10), arc_mm(30, 60), straight_mm(9.65)}; }
inline std::vector<SweptPiece> s_bend() {
  return {straight_mm(6), arc_mm(25, 50), arc_mm(25, 50, 180), straight_mm(5)};
}
/// Ours, small: two bends one after the other in one plane, one that turns back, and one across the other.
inline std::vector<SweptPiece> bends_to_one_side() {
  return {straight_mm(10), arc_mm(14, 40), straight_mm(2), arc_mm(14, 40), straight_mm(8)};
}
inline std::vector<SweptPiece> bends_to_both_sides() {
  return {straight_mm(3), arc_mm(15, 55, 45), straight_mm(2), arc_mm(15, 80, 225), straight_mm(3)};
}
inline std::vector<SweptPiece> bends_across_each_other() {
  return {straight_mm(3), arc_mm(16, 45), straight_mm(2), arc_mm(16, 45, 90), straight_mm(3)};
}
inline std::vector<SweptPiece> bends_in_two_planes() {
  return {straight_mm(6), arc_mm(30, 40), straight_mm(5), arc_mm(30, 40, 90), straight_mm(5)};
}

}  // namespace understudy
