#include "geometry/mesh.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "geometry/normals.h"
#include "geometry/topology.h"

namespace understudy::geometry {
namespace {

void check_mesh(const std::vector<Vec3>& vertices, const std::vector<std::array<int, 3>>& triangles) {
  if (triangles.empty()) throw InputError("the mesh has no triangle");
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const Vec3& p = vertices[v];
    if (!p.allFinite())
      throw InputError(fmt::format("vertex {} is ({}, {}, {}), not finite", v, p.x(), p.y(), p.z()));
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const int v : triangles[t])
      if (v < 0 || static_cast<std::size_t>(v) >= vertices.size())
        throw InputError(fmt::format("triangle {} uses vertex {}, and there are {}", t, v, vertices.size()));
    const auto& [a, b, c] = triangles[t];
    if (a == b || b == c || c == a) throw InputError(fmt::format("triangle {} uses a vertex twice", t));
  }
  const auto has_area = [&](const std::array<int, 3>& triangle) {
    const auto at = [&](std::size_t k) -> const Vec3& {
      return vertices[static_cast<std::size_t>(triangle[k])];
    };
    return !face_normal(at(0), at(1), at(2)).isZero(0);
  };
  if (std::none_of(triangles.begin(), triangles.end(), has_area))
    throw InputError("the mesh has no triangle with an area");
}

}  // namespace

Mesh::Mesh(std::vector<Vec3> vertices, std::vector<std::array<int, 3>> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
  check_mesh(vertices_, triangles_);
  Topology topology = find_topology(triangles_);
  neighbours_ = std::move(topology.neighbours);
  open_edges_ = topology.open_edges;
  flipped_edges_ = topology.flipped_edges;

  // Pseudo-normals look across creases, so they come from the mesh before it is split.
  const std::vector<Vec3> around = vertex_pseudo_normals(vertices_, triangles_);
  const std::vector<std::array<int, 3>> joined = triangles_;
  vertex_normals_ = split_creases(vertices_, triangles_, neighbours_, kCreaseAngle);
  pseudo_normals_.assign(vertices_.size(), Vec3::Zero());
  lower_ = upper_ = vertices_[static_cast<std::size_t>(triangles_[0][0])];
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(triangles_[t][k]);
      pseudo_normals_[v] = around[static_cast<std::size_t>(joined[t][k])];
      lower_ = lower_.cwiseMin(vertices_[v]);
      upper_ = upper_.cwiseMax(vertices_[v]);
    }
  }
}

Mesh::~Mesh() = default;

double Mesh::volume() const {
  // Tetrahedra to the middle of the box: a far origin would cost digits.
  const Vec3 middle = 0.5 * (lower_ + upper_);
  double sum = 0;
  for (const auto& [a, b, c] : triangles_) {
    const Vec3 p = vertices_[static_cast<std::size_t>(a)] - middle;
    const Vec3 q = vertices_[static_cast<std::size_t>(b)] - middle;
    const Vec3 r = vertices_[static_cast<std::size_t>(c)] - middle;
    sum += p.dot(q.cross(r)) / 6;
  }
  return sum;
}

}  // namespace understudy::geometry
