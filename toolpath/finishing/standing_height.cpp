#include "toolpath/finishing/standing_height.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace understudy::toolpath {
namespace {

/// Corners of a triangle seen along the axis: across it, and the height along it.
struct Corner {
  Vec2 at;
  double height;
};
using Corners = std::array<Corner, 3>;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Where the edge enters and leaves the circle around the origin: the height is linear, so that its largest
/// is at an end of that piece.
void add_edge(const Corner& a, const Corner& b, double radius, double& highest) {
  const Vec2 way = b.at - a.at;
  const double q = way.squaredNorm(), half = a.at.dot(way), c = a.at.squaredNorm() - radius * radius;
  double from = 0, to = 1;
  if (q > 0) {
    const double root = half * half - q * c;
    if (root < 0) return;
    from = std::max(from, (-half - std::sqrt(root)) / q);
    to = std::min(to, (-half + std::sqrt(root)) / q);
  } else if (c > 0) {
    return;
  }
  if (from > to) return;
  for (const double t : {from, to}) highest = std::max(highest, a.height + t * (b.height - a.height));
}

/// On the rim, uphill, where that is within the triangle.
void add_inside(const Corners& k, double radius, double& highest) {
  const Vec2 u = k[1].at - k[0].at, v = k[2].at - k[0].at;
  const double area = cross(u, v);
  if (std::abs(area) < 1e-12 * std::max(u.squaredNorm(), v.squaredNorm())) return;  // seen edge on
  const double hu = k[1].height - k[0].height, hv = k[2].height - k[0].height;
  const Vec2 slope = Vec2(hu * v.y() - hv * u.y(), hv * u.x() - hu * v.x()) / area;
  const Vec2 uphill = slope.norm() > 0 ? Vec2(radius * slope.normalized()) : Vec2(0, 0);
  const Vec2 from = uphill - k[0].at;
  const double s = cross(from, v) / area, t = cross(u, from) / area;
  if (s < 0 || t < 0 || s + t > 1) return;
  highest = std::max(highest, k[0].height + slope.dot(from));
}

}  // namespace

StandingHeight::StandingHeight(const geometry::Mesh& mesh) : mesh_(mesh) {
  balls_.reserve(mesh.triangles().size());
  for (const auto& t : mesh.triangles()) {
    const auto at = [&](std::size_t k) { return mesh.vertices()[static_cast<std::size_t>(t[k])]; };
    const Vec3 centre = (at(0) + at(1) + at(2)) / 3;
    balls_.push_back(
        {centre, std::max({(at(0) - centre).norm(), (at(1) - centre).norm(), (at(2) - centre).norm()})});
  }
}

double StandingHeight::of(const Vec3& p, const Vec3& axis, double radius, double least) const {
  const Mat3 across = shortest_arc_from_z(axis).toRotationMatrix();
  double highest = least;
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Vec3 way = balls_[i].centre - p;
    const double along = way.dot(axis), reach = radius + balls_[i].radius;
    if (along + balls_[i].radius <= highest || way.squaredNorm() - along * along > reach * reach) continue;
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 q =
          across.transpose() * (mesh_.vertices()[static_cast<std::size_t>(mesh_.triangles()[i][k])] - p);
      corners[k] = {q.head<2>(), q.z()};
    }
    for (std::size_t k = 0; k < 3; ++k) add_edge(corners[k], corners[(k + 1) % 3], radius, highest);
    add_inside(corners, radius, highest);
  }
  return highest;
}

}  // namespace understudy::toolpath
