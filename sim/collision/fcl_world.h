// Distances between rigid shapes by FCL, its types kept out of sight. Built once, posed at every query.
#pragma once

#include <memory>

#include "core/frames.h"
#include "geometry/shape.h"
#include "sim/collision/separation.h"

namespace understudy::sim {

/// Spheres and capsules are exact (core plus radius); cylinders and frustums are polytopes within 0.5 um of
/// the round shape (mean radius up to 20 mm; 0.03 % of the radius beyond); boxes and meshes are exact.
class FclWorld {
 public:
  FclWorld();
  ~FclWorld();

  /// Index of the shape. Its X_FS is left out: the caller poses the shape's own frame.
  int add(const geometry::Shape& shape);
  /// For struts: the capsule's distance between its cap centres [m].
  void set_capsule_length(int index, double length);

  /// Throws MachineError when FCL finds no answer.
  Separation distance(int first, const Pose& X_W1, int second, const Pose& X_W2) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
