#include "sim/distance/hull_core.h"

#include <algorithm>

namespace understudy::sim {

Vec3 HullCore::farthest(const Vec3& direction) const {
  const Vec3* best = &mesh->vertices().front();
  for (const Vec3& v : mesh->vertices())
    if (v.dot(direction) > best->dot(direction)) best = &v;
  return *best;
}

Vec3 HullCore::nearest(const Vec3& p) const { return depth(p) > 0 ? p : mesh->nearest(p).position; }

double HullCore::depth(const Vec3& p) const { return std::max(0.0, -mesh->signed_distance(p)); }

double reach(const HullCore& hull, const Pose& X_FS) {
  double r = 0;
  for (const Vec3& v : hull.mesh->vertices()) r = std::max(r, (X_FS * v).norm());
  return r;
}

}  // namespace understudy::sim
