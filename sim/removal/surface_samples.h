// Samples of a part's surface, each for a small cell of it.
#pragma once

#include <array>
#include <vector>

#include "geometry/mesh.h"

namespace understudy::sim {

struct SurfaceSample {
  Vec3 position{0, 0, 0};  ///< [m], middle of its cell
  Vec3 normal{0, 0, 1};    ///< unit, outwards, smooth but for edges
  double area = 0;         ///< [m^2]
  /// [m], counter-clockwise seen from outside; two are the same at a corner of the mesh's triangle.
  std::array<Vec3, 4> corners{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

constexpr std::size_t kMostSamples = 400'000;

/// Every triangle in strips along its shortest side, the strips in cells, both no wider than `spacing` [m];
/// without the faces that the part stands on (at its lowest z, facing down). Where these would be more than
/// kMostSamples, the spacing is doubled until they are not. Throws InputError for a spacing that is not above
/// 0.
std::vector<SurfaceSample> sample_surface(const geometry::Mesh& part, double& spacing);

}  // namespace understudy::sim
