// Frames of struts (Ishak 2018).
#pragma once

#include <array>
#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

struct LatticeNode {
  Vec3 position;          ///< [m]
  bool grounded = false;  ///< stands on the table from the start
};

struct Lattice {
  std::vector<LatticeNode> nodes;
  std::vector<std::array<int, 2>> struts;  ///< indices of two nodes

  double length(std::size_t strut) const;  ///< [m]
};

/// Scales by `scale` about the origin, then shifts so that the middle of the bounding box's lower side comes
/// to `place` [m].
void place_lattice(Lattice& lattice, double scale, const Vec3& place);

/// Node indices that no strut connects to a grounded node, of those that struts use.
std::vector<int> hanging_nodes(const Lattice& lattice);

}  // namespace understudy::toolpath
