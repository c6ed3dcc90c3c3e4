#include "geometry/box_mesh.h"

namespace understudy::geometry {

std::vector<Vec3> box_corners(const Vec3& lower, const Vec3& upper) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(),
                         i & 4 ? upper.z() : lower.z());
  return corners;
}

const std::vector<std::array<int, 3>>& box_triangles() {
  static const std::vector<std::array<int, 3>> triangles{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                                         {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                                         {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return triangles;
}

std::shared_ptr<const Mesh> box_mesh(const Vec3& lower, const Vec3& upper, const Pose& X) {
  std::vector<Vec3> corners = box_corners(lower, upper);
  for (Vec3& corner : corners) corner = X * corner;
  return std::make_shared<Mesh>(std::move(corners), box_triangles());
}

}  // namespace understudy::geometry
