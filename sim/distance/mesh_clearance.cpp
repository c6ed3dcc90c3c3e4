#include "sim/distance/mesh_clearance.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "sim/distance/gjk.h"
#include "sim/distance/supporting_plane.h"

namespace understudy::sim {
namespace {
constexpr int kLeafTriangles = 2;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
}  // namespace

MeshClearance::MeshClearance(std::shared_ptr<const geometry::Mesh> mesh)
    : mesh_(std::move(mesh)), order_(mesh_->triangles().size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.emplace_back();
  std::vector<Extent> extents;
  extents.reserve(order_.size());
  for (const auto& triangle : mesh_->triangles()) {
    const Vec3 &a = mesh_->vertices()[triangle[0]], &b = mesh_->vertices()[triangle[1]],
               &c = mesh_->vertices()[triangle[2]];
    extents.push_back({a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c), a + b + c});
  }
  build(0, 0, static_cast<int>(order_.size()), extents);
}

void MeshClearance::build(int node, int first, int count, const std::vector<Extent>& extents) {
  Vec3 lower = Vec3::Constant(kInfinity), upper = -lower;
  for (int i = first; i < first + count; ++i) {
    lower = lower.cwiseMin(extents[order_[i]].lower);
    upper = upper.cwiseMax(extents[order_[i]].upper);
  }
  Node result;
  result.centre = 0.5 * (lower + upper);
  result.half = 0.5 * (upper - lower);
  if (count <= kLeafTriangles) {
    result.first = first;
    result.count = count;
    nodes_[node] = result;
    return;
  }
  Eigen::Index axis = 0;
  result.half.maxCoeff(&axis);
  const auto middle = [&](int triangle) { return extents[triangle].corner_sum[axis]; };
  const int half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
    const double ma = middle(a), mb = middle(b);
    return ma < mb || (ma == mb && a < b);
  });
  result.first = static_cast<int>(nodes_.size());
  nodes_[node] = result;
  nodes_.resize(nodes_.size() + 2);
  build(result.first, first, half, extents);
  build(result.first + 1, first + half, count - half, extents);
}

template <typename Core>
Separation MeshClearance::search(const Core& core, const Pose& X_WS) const {
  const Pose X_SW = X_WS.inverse(Eigen::Isometry);
  // The distance is convex: over a box it is at least its tangent at the centre.
  const auto bound = [&](int node) {
    const Node& n = nodes_[node];
    const Vec3 p = X_SW * n.centre;
    const Vec3 away = p - core.nearest(p);
    const double distance = away.norm();
    if (distance == 0) return 0.0;
    return distance - (X_WS.linear() * away).cwiseAbs().dot(n.half) / distance;
  };
  Separation best{kInfinity, Vec3::Zero()};
  // A plane between the solid and the nearest triangle so far: all of a bulging part lies behind it.
  SupportingPlane plane;
  const auto behind = [&](int node) {
    return plane.bound(nodes_[node].centre, nodes_[node].half) >= best.distance;
  };
  struct Entry {
    int node;
    double bound;
  };
  std::array<Entry, 128> stack;  // one more a level, and the count of triangles halves at each
  std::size_t size = 0;
  stack[size++] = {0, bound(0)};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.bound >= best.distance || behind(entry.node)) continue;
    const Node& node = nodes_[entry.node];
    if (node.count == 0) {
      std::array<Entry, 2> children{{{node.first, kInfinity}, {node.first + 1, kInfinity}}};
      for (Entry& child : children)
        if (!behind(child.node)) child.bound = bound(child.node);
      if (children[0].bound <= children[1].bound) std::swap(children[0], children[1]);
      for (const Entry& child : children) stack[size++] = child;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      const auto& t = mesh_->triangles()[order_[i]];
      const auto& v = mesh_->vertices();
      const Triangle corners_W{v[t[0]], v[t[1]], v[t[2]]};
      if (plane.bound(corners_W) >= best.distance) continue;
      Triangle corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = X_SW * corners_W[k];
      const GjkResult result = distance_to_triangle(core, corners, best.distance);
      if (!(result.distance < best.distance)) continue;
      best = {result.distance, X_WS * result.on_other};
      plane = supporting_plane(core, X_WS, result.on_other);
    }
  }
  return best;
}

Separation MeshClearance::distance(const ConvexSolid& solid, const Pose& X_WS) const {
  Separation result = std::visit([&](const auto& core) { return search(core, X_WS); }, solid.core);
  result.distance -= solid.radius;
  return result;
}

}  // namespace understudy::sim
