#include "geometry/normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace understudy::geometry {
namespace {

using Triangle = std::array<int, 3>;

const Vec3& corner(const std::vector<Vec3>& vertices, const Triangle& triangle, std::size_t k) {
  return vertices[static_cast<std::size_t>(triangle[k % 3])];
}

double corner_angle(const std::vector<Vec3>& vertices, const Triangle& triangle, std::size_t k) {
  const Vec3 u = corner(vertices, triangle, k + 1) - corner(vertices, triangle, k);
  const Vec3 v = corner(vertices, triangle, k + 2) - corner(vertices, triangle, k);
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

std::vector<Vec3> face_normals(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  std::vector<Vec3> normals;
  normals.reserve(triangles.size());
  for (const Triangle& t : triangles)
    normals.push_back(face_normal(corner(vertices, t, 0), corner(vertices, t, 1), corner(vertices, t, 2)));
  return normals;
}

// Corners (3 t + k) that share a vertex and are joined by smooth edges.
class CornerGroups {
 public:
  explicit CornerGroups(std::size_t corners) : parent_(corners) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t c) {
    while (parent_[c] != c) c = parent_[c] = parent_[parent_[c]];
    return c;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

std::size_t position_of(const Triangle& triangle, int vertex) {
  return static_cast<std::size_t>(std::find(triangle.begin(), triangle.end(), vertex) - triangle.begin());
}

CornerGroups smooth_groups(const std::vector<Triangle>& triangles, const std::vector<Triangle>& neighbours,
                           const std::vector<Vec3>& normals, double crease_angle) {
  CornerGroups groups(3 * triangles.size());
  const double smooth_cosine = std::cos(crease_angle);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (neighbours[t][k] < static_cast<int>(t)) continue;  // open, or already seen from the other side
      const auto other = static_cast<std::size_t>(neighbours[t][k]);
      if (normals[t].dot(normals[other]) < smooth_cosine) continue;
      for (const std::size_t end : {k, (k + 1) % 3})
        groups.join(3 * t + end, 3 * other + position_of(triangles[other], triangles[t][end]));
    }
  }
  return groups;
}

}  // namespace

Vec3 face_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, w = c - b;
  const Vec3 n = u.cross(v);
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm()});
  // Thinner than 1e-12 of its length, a triangle is a line in double precision and its normal is noise.
  if (!(n.norm() > 1e-12 * longest)) return Vec3::Zero();
  return n.normalized();
}

std::vector<Vec3> split_creases(std::vector<Vec3>& vertices, std::vector<Triangle>& triangles,
                                const std::vector<Triangle>& neighbours, double crease_angle) {
  const std::vector<Vec3> normals = face_normals(vertices, triangles);
  CornerGroups groups = smooth_groups(triangles, neighbours, normals, crease_angle);

  constexpr int kUnused = -1;
  std::vector<int> vertex_of_group(3 * triangles.size(), kUnused);
  std::vector<bool> taken(vertices.size(), false);
  std::vector<Vec3> smooth(vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle original = triangles[t];
    const double area = 0.5 * (corner(vertices, original, 1) - corner(vertices, original, 0))
                                  .cross(corner(vertices, original, 2) - corner(vertices, original, 0))
                                  .norm();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(original[k]);
      const double weight = area * corner_angle(vertices, original, k);
      int& target = vertex_of_group[groups.find(3 * t + k)];
      if (target == kUnused && !taken[vertex]) {
        taken[vertex] = true;
        target = original[k];
      } else if (target == kUnused) {
        target = static_cast<int>(vertices.size());
        vertices.push_back(Vec3(vertices[vertex]));
        smooth.emplace_back(Vec3::Zero());
      }
      triangles[t][k] = target;
      smooth[static_cast<std::size_t>(target)] += weight * normals[t];
    }
  }
  for (Vec3& n : smooth) n = n.norm() > 0 ? Vec3(n.normalized()) : Vec3(Vec3::UnitZ());
  return smooth;
}

std::vector<Vec3> vertex_pseudo_normals(const std::vector<Vec3>& vertices,
                                        const std::vector<Triangle>& triangles) {
  const std::vector<Vec3> normals = face_normals(vertices, triangles);
  std::vector<Vec3> pseudo(vertices.size(), Vec3::Zero());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      pseudo[static_cast<std::size_t>(triangles[t][k])] +=
          corner_angle(vertices, triangles[t], k) * normals[t];
  return pseudo;
}

}  // namespace understudy::geometry
