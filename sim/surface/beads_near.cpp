#include "sim/surface/beads_near.h"

#include <algorithm>

#include "sim/surface/bead_mesh.h"

namespace understudy::sim {
namespace {

double distance_to_middle_line(const Bead& bead, const Vec3& p_W) {
  const Vec3 from(bead.from_W[0], bead.from_W[1], bead.from_W[2]),
      to(bead.to_W[0], bead.to_W[1], bead.to_W[2]);
  const Vec3 along = to - from;
  const double square = along.squaredNorm();
  const double share = square > 0 ? std::clamp((p_W - from).dot(along) / square, 0.0, 1.0) : 0;
  return (p_W - from - share * along).norm();
}

}  // namespace

std::shared_ptr<const geometry::Mesh> beads_near(const BeadIndex& beads, const Vec3& p_W, double reach) {
  BeadMesh mesh;
  for (std::size_t i = 0; i < beads.size(); ++i) {
    const Bead bead = beads.bead(i);
    if (distance_to_middle_line(bead, p_W) <= reach) append_shell(bead, kBeadSides, mesh);
  }
  if (mesh.triangles.empty()) return nullptr;
  return std::make_shared<geometry::Mesh>(std::move(mesh.vertices), std::move(mesh.triangles));
}

}  // namespace understudy::sim
