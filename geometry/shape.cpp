#include "geometry/shape.h"

namespace understudy::geometry {

Shape capsule_between(std::string name, const Vec3& a, const Vec3& b, double radius) {
  const Vec3 along = b - a;
  const double length = along.norm();
  const Quat turn = length > 0 ? shortest_arc_from_z(along / length) : Quat::Identity();
  return {std::move(name), Capsule{radius, length}, make_pose(turn, 0.5 * (a + b))};
}

}  // namespace understudy::geometry
