// The one translation unit that sees Eigen's bounding-volume tree.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include <unsupported/Eigen/BVH>

#include "core/error.h"
#include "geometry/mesh.h"
#include "geometry/normals.h"
#include "geometry/triangle.h"

namespace understudy::geometry {
namespace {

struct Facet {
  Vec3 a, b, c;
  int triangle;
};

// Boxes in single precision, rounded outwards, halve the memory that a search touches and stay conservative.
Eigen::AlignedBox3f bounding_box(const Facet& f) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Eigen::AlignedBox3f box;
  for (int i = 0; i < 3; ++i) {
    const auto [low, high] = std::minmax({f.a[i], f.b[i], f.c[i]});
    box.min()[i] = std::nextafter(static_cast<float>(low), -kInfinity);
    box.max()[i] = std::nextafter(static_cast<float>(high), kInfinity);
  }
  return box;
}

using FacetTree = Eigen::KdBVH<float, 3, Facet>;

double squared_distance(const Eigen::AlignedBox3f& box, const Vec3& p) {
  const Vec3 below = box.min().cast<double>() - p, above = p - box.max().cast<double>();
  return below.cwiseMax(above).cwiseMax(0.0).squaredNorm();
}

// Depth first, the nearer child first, skipping what lies beyond the best so far. Eigen's own walkers keep a
// heap on the free store; this one allocates nothing. `bound` gives a box's least cost, `visit` a facet.
template <typename Bound, typename Visit>
void walk(const FacetTree& tree, const double& best, const Bound& bound, const Visit& visit) {
  struct Pending {
    int node;
    double cost;
  };
  // The tree halves at every level: 64 pending nodes hold more than 2^60 facets.
  std::array<Pending, 64> stack;
  std::size_t top = 0;
  stack[top++] = {tree.getRootIndex(), 0};
  while (top > 0) {
    const Pending next = stack[--top];
    if (next.cost > best) continue;
    FacetTree::VolumeIterator node = nullptr, nodes_end = nullptr;
    FacetTree::ObjectIterator facet = nullptr, facets_end = nullptr;
    tree.getChildren(next.node, node, nodes_end, facet, facets_end);
    for (; facet != facets_end; ++facet) visit(*facet);
    if (node == nodes_end) continue;
    Pending near{node[0], bound(tree.getVolume(node[0]))};
    if (nodes_end - node == 2) {
      Pending far{node[1], bound(tree.getVolume(node[1]))};
      if (far.cost < near.cost) std::swap(near, far);
      if (far.cost <= best) stack[top++] = far;
    }
    if (near.cost <= best) stack[top++] = near;
  }
}

struct Nearest {
  int triangle = -1;
  TrianglePoint point;
};

Nearest find_nearest(const FacetTree& tree, const Vec3& p) {
  Nearest found;
  double best = std::numeric_limits<double>::infinity();
  walk(
      tree, best, [&](const Eigen::AlignedBox3f& box) { return squared_distance(box, p); },
      [&](const Facet& f) {
        const TrianglePoint q = nearest_on_triangle(p, f.a, f.b, f.c);
        const Vec3 position = q.barycentric[0] * f.a + q.barycentric[1] * f.b + q.barycentric[2] * f.c;
        const double squared = (position - p).squaredNorm();
        if (squared < best) {
          best = squared;
          found = {f.triangle, q};
        }
      });
  return found;
}

}  // namespace

struct Mesh::Tree {
  FacetTree facets;
};

std::shared_ptr<const Mesh::Tree> Mesh::make_tree(const Mesh& mesh) {
  std::vector<Facet> facets;
  facets.reserve(mesh.triangles_.size());
  for (std::size_t t = 0; t < mesh.triangles_.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles_[t];
    const Vec3& a = mesh.vertices_[static_cast<std::size_t>(i)];
    const Vec3& b = mesh.vertices_[static_cast<std::size_t>(j)];
    const Vec3& c = mesh.vertices_[static_cast<std::size_t>(k)];
    // A triangle without area covers nothing that its neighbours' edges do not, and has no normal.
    if (!face_normal(a, b, c).isZero(0)) facets.push_back({a, b, c, static_cast<int>(t)});
  }
  auto tree = std::make_shared<Tree>();
  tree->facets.init(facets.begin(), facets.end());
  return tree;
}

const Mesh::Tree& Mesh::tree() const {
  std::call_once(tree_made_, [&] { tree_ = make_tree(*this); });
  return *tree_;
}

SurfacePoint Mesh::surface_point(int triangle, const Vec3& barycentric) const {
  SurfacePoint point;
  point.triangle = triangle;
  point.position = point.normal = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto v = static_cast<std::size_t>(triangles_[static_cast<std::size_t>(triangle)][k]);
    const double weight = barycentric[static_cast<Eigen::Index>(k)];
    point.position += weight * vertices_[v];
    point.normal += weight * vertex_normals_[v];
  }
  point.normal.normalize();
  return point;
}

SurfacePoint Mesh::nearest(const Vec3& p) const {
  assert(p.allFinite());
  const Nearest found = find_nearest(tree().facets, p);
  SurfacePoint point = surface_point(found.triangle, found.point.barycentric);
  point.distance = (point.position - p).norm();
  return point;
}

std::optional<SurfacePoint> Mesh::ray_hit(const Vec3& origin, const Vec3& direction, double reach) const {
  assert(std::abs(direction.norm() - 1) < 1e-6);
  const WatertightRay ray(origin, direction);
  // Finite, so that a box the ray misses (entry at infinity) is never walked into.
  double best = std::min(reach, std::numeric_limits<double>::max());
  int triangle = -1;
  Vec3 barycentric;
  walk(
      tree().facets, best,
      [&](const Eigen::AlignedBox3f& box) {
        return ray.entry(box.min().cast<double>(), box.max().cast<double>(), best);
      },
      [&](const Facet& f) {
        const auto hit = ray.hit(f.a, f.b, f.c);
        if (!hit || hit->distance > best || (triangle >= 0 && hit->distance == best)) return;
        best = hit->distance;
        triangle = f.triangle;
        barycentric = hit->barycentric;
      });
  if (triangle < 0) return std::nullopt;
  SurfacePoint point = surface_point(triangle, barycentric);
  point.distance = best;
  return point;
}

double Mesh::signed_distance(const Vec3& p) const {
  const Nearest found = find_nearest(tree().facets, p);
  const auto t = static_cast<std::size_t>(found.triangle);
  const auto normal_of = [&](std::size_t triangle) {
    const auto& [i, j, k] = triangles_[triangle];
    return face_normal(vertices_[static_cast<std::size_t>(i)], vertices_[static_cast<std::size_t>(j)],
                       vertices_[static_cast<std::size_t>(k)]);
  };
  const auto feature = static_cast<std::size_t>(found.point.feature);
  Vec3 pseudo = normal_of(t);
  if (feature < 3) {
    pseudo = pseudo_normals_[static_cast<std::size_t>(triangles_[t][feature])];
  } else if (feature < 6 && neighbours_[t][feature - 3] >= 0) {
    pseudo += normal_of(static_cast<std::size_t>(neighbours_[t][feature - 3]));
  }
  const Vec3 away = p - surface_point(found.triangle, found.point.barycentric).position;
  return away.dot(pseudo) < 0 ? -away.norm() : away.norm();
}

}  // namespace understudy::geometry
