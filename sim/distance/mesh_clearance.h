// Exact distance of convex solids to a triangle mesh: the nozzle at its working gap of 0.1 mm, where a
// polytope's facets and a library's tolerance would show, and bodies that hang low over thousands of
// triangles.
#pragma once

#include <memory>
#include <vector>

#include "geometry/mesh.h"
#include "sim/distance/convex_solid.h"
#include "sim/distance/separation.h"

namespace understudy::sim {

class MeshClearance {
 public:
  /// The mesh is fixed in W.
  explicit MeshClearance(std::shared_ptr<const geometry::Mesh> mesh);

  /// To the surface, within 2 nm; negative by at most the solid's radius. A solid wholly inside a closed mesh
  /// is a positive distance away from its surface: ask the mesh for the side.
  Separation distance(const ConvexSolid& solid, const Pose& X_WS) const;

 private:
  struct Node {
    Vec3 centre{0, 0, 0}, half{0, 0, 0};  // box around all triangles below
    int first = 0, count = 0;  // triangles of a leaf; count 0: the children are `first` and `first + 1`
  };
  struct Extent {  // of a triangle
    Vec3 lower, upper, corner_sum;
  };
  void build(int node, int first, int count, const std::vector<Extent>& extents);
  template <typename Core>
  Separation search(const Core& core, const Pose& X_WS) const;

  std::shared_ptr<const geometry::Mesh> mesh_;
  std::vector<Node> nodes_;
  std::vector<int> order_;  // triangles, leaf by leaf
};

}  // namespace understudy::sim
