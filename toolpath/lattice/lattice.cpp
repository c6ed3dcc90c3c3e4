#include "toolpath/lattice/lattice.h"

namespace understudy::toolpath {

double Lattice::length(std::size_t strut) const {
  const auto& [a, b] = struts[strut];
  return (nodes[b].position - nodes[a].position).norm();
}

void place_lattice(Lattice& lattice, double scale, const Vec3& place) {
  Eigen::AlignedBox3d box;
  for (const LatticeNode& node : lattice.nodes) box.extend(node.position);
  if (box.isEmpty()) return;
  const Vec3 bottom(box.center().x(), box.center().y(), box.min().z());
  for (LatticeNode& node : lattice.nodes) node.position = place + scale * (node.position - bottom);
}

std::vector<int> hanging_nodes(const Lattice& lattice) {
  std::vector<bool> used(lattice.nodes.size()), reached(lattice.nodes.size());
  std::vector<std::vector<int>> neighbours(lattice.nodes.size());
  for (const auto& [a, b] : lattice.struts) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
    used[a] = used[b] = true;
  }
  std::vector<int> open;
  for (std::size_t i = 0; i < lattice.nodes.size(); ++i)
    if (lattice.nodes[i].grounded && used[i]) {
      reached[i] = true;
      open.push_back(static_cast<int>(i));
    }
  while (!open.empty()) {
    const int node = open.back();
    open.pop_back();
    for (const int next : neighbours[node])
      if (!reached[next]) {
        reached[next] = true;
        open.push_back(next);
      }
  }
  std::vector<int> hanging;
  for (std::size_t i = 0; i < lattice.nodes.size(); ++i)
    if (used[i] && !reached[i]) hanging.push_back(static_cast<int>(i));
  return hanging;
}

}  // namespace understudy::toolpath
