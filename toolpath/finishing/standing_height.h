// How far out along its axis a round tool must stand so as not to cut into a part.
#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

/// The triangles of a part, ready to be asked by many poses. The mesh must outlive it.
class StandingHeight {
 public:
  explicit StandingHeight(const geometry::Mesh& mesh);

  /// [m]: the farthest along the unit vector `axis`, from `p` on, of everything within `radius` of the line
  /// through p along axis. A flat face of that radius, across the axis, touches there. At least `least`,
  /// also where nothing is. Exact to rounding.
  double of(const Vec3& p, const Vec3& axis, double radius, double least) const;

 private:
  struct Ball {
    Vec3 centre;
    double radius;
  };
  const geometry::Mesh& mesh_;
  std::vector<Ball> balls_;  // around the triangles
};

}  // namespace understudy::toolpath
