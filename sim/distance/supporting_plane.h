// A plane that touches a convex core: how far what lies beyond it is away at least, for the price of a
// product.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/frames.h"

namespace understudy::sim {

/// The core lies where normal . x <= offset, and a point x is at least normal . x - offset away from it [m].
/// As it is made there is no plane: every bound is minus infinity. In the frame that its maker states.
struct SupportingPlane {
  Vec3 normal{0, 0, 0};  ///< unit
  double offset = std::numeric_limits<double>::infinity();

  /// Of a triangle.
  double bound(const std::array<Vec3, 3>& corners) const {
    return std::min({normal.dot(corners[0]), normal.dot(corners[1]), normal.dot(corners[2])}) - offset;
  }
  /// Of a box along the frame's axes.
  double bound(const Vec3& centre, const Vec3& half) const {
    return normal.dot(centre) - normal.cwiseAbs().dot(half) - offset;
  }
};

/// The plane across the shortest line from the core to `p`, in W; both in the core's frame S. No plane where
/// that line is too short to point anywhere.
template <typename Core>
SupportingPlane supporting_plane(const Core& core, const Pose& X_WS, const Vec3& p) {
  constexpr double kDirected = 1e-9;  // [m]: a shorter difference of places is rounding
  const Vec3 away = p - core.nearest(p);
  const double distance = away.norm();
  if (distance < kDirected) return {};
  const Vec3 normal = away / distance, normal_W = X_WS.linear() * normal;
  return {normal_W, normal.dot(core.farthest(normal)) + normal_W.dot(X_WS.translation())};
}

}  // namespace understudy::sim
