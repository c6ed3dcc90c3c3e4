// Distances between rigid shapes by FCL, its types kept out of sight. A shape is built when it is first asked
// for, and posed at every query; two threads must not ask at once.
#pragma once

#include <memory>

#include "core/frames.h"
#include "geometry/shape.h"
#include "sim/distance/separation.h"

namespace understudy::sim {

/// Spheres and capsules are exact (core plus radius), so are boxes and meshes. Cylinders and frustums are
/// polytopes that leave the round shape by at most 0.25 um or 0.01 % of its radius, whichever is more.
class FclWorld {
 public:
  FclWorld();
  ~FclWorld();

  /// Index of the shape. Its X_FS is left out: the caller poses the shape's own frame.
  int add(const geometry::Shape& shape);
  /// The same of a mesh that is its own convex hull: a solid body, where add() takes its surface.
  int add_hull(std::shared_ptr<const geometry::Mesh> mesh);
  /// For struts: the capsule's distance between its cap centres [m].
  void set_capsule_length(int index, double length);

  /// Throws MachineError when FCL finds no answer.
  Separation distance(int first, const Pose& X_W1, int second, const Pose& X_W2) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
