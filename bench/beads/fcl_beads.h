// The peer of the bead index: one FCL object a bead in a dynamic tree of boxes.
#pragma once

#include <memory>
#include <vector>

#include "core/frames.h"
#include "geometry/shape.h"
#include "sim/beads/bead.h"

namespace understudy::sim {

class FclBeads {
 public:
  /// Capsules of the beads' height.
  explicit FclBeads(const std::vector<Bead>& beads);
  ~FclBeads();
  /// [m], of the solid frustum's convex hull of 64 corners; at most `cutoff`.
  double distance(const geometry::Frustum& solid, const Pose& X_WS, double cutoff) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
