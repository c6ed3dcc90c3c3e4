// Places along the outlines of a part's sections, with the normals of its surface.
#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

struct OutlinePlace {
  Vec3 position;  ///< [m], on the surface
  Vec3 normal;    ///< unit, outwards: fitted (fitted_normal)
};

struct Outline {
  std::vector<OutlinePlace> places;  ///< the last is followed by the first
  double deviation = 0;              ///< [rad], of fitted normals from the mesh's own, at most
};

/// The closed lines in which the plane z = `height` cuts the part, outlines and holes. Places are `step` [m]
/// apart at most, and stand in every corner; round an edge there are further ones in the same position, by
/// `kCornerTurn` each.
std::vector<Outline> outlines_at(const geometry::Mesh& part, double height, double step, double fit_reach);

constexpr double kCornerTurn = 5 * kDegree;

}  // namespace understudy::toolpath
