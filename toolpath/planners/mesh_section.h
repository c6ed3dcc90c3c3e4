// Where a plane cuts a mesh.
#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

/// One connected line of a section: its points, and between each two of them the triangle that they cross.
/// The material is on the left, seen from the tip of the plane's normal.
struct SectionLine {
  std::vector<Vec3> points;
  std::vector<int> triangles;
  bool closed() const { return points.size() > 2 && points.front() == points.back(); }
};

/// Every line in which the plane through `point` with unit `normal` cuts the mesh; closed ones end where they
/// begin. Empty when it misses.
std::vector<SectionLine> section_lines(const geometry::Mesh& mesh, const Vec3& point, const Vec3& normal);

}  // namespace understudy::toolpath
