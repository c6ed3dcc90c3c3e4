// Distance of a convex core to a triangle or a bead by the algorithm of Gilbert, Johnson and Keerthi on exact
// support functions, ended by its duality gap: |v| is an upper and v.w/|v| a lower bound of the distance.
#pragma once

#include <array>

#include "core/frames.h"

namespace understudy::sim {

using Triangle = std::array<Vec3, 3>;

struct BeadCore;

struct GjkResult {
  double distance = 0;  ///< [m]; 0 where they meet
  Vec3 on_other{0, 0,
                0};  ///< nearest point of the triangle or bead, or one that both share, in the core's frame
  int iterations = 0;
};

/// Corners in the core's frame. The distance is within 1 nm. Stops early, with any distance at or above
/// `enough`, once it is known not to be below `enough`. Defined for the cores of convex_solid.h.
template <typename Core>
GjkResult distance_to_triangle(const Core& core, const Triangle& corners, double enough);
/// The same to what a bead is rounded around, without its radius.
template <typename Core>
GjkResult distance_to_bead_core(const Core& core, const BeadCore& bead, double enough);

}  // namespace understudy::sim
