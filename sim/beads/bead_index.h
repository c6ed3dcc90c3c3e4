// Everything printed so far, to ask how near a body is: a sparse grid tree.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "sim/beads/bead.h"
#include "sim/distance/convex_solid.h"
#include "sim/distance/separation.h"

namespace understudy::sim {

/// Questions may come from many threads while nothing is added. They throw MachineError for a place that is
/// not finite. Of beads that answer alike within 2 nm the lowest number is named, whatever the order of
/// looking.
class BeadIndex {
 public:
  static constexpr std::size_t kAll = static_cast<std::size_t>(-1);

  BeadIndex();
  ~BeadIndex();
  BeadIndex(BeadIndex&&) noexcept;
  BeadIndex& operator=(BeadIndex&&) noexcept;

  /// Beads keep the order in which they were laid; throws InputError, naming the bead's line, for one that is
  /// not finite, has no section, is higher than wide, lies more than 100 m from the origin, or whose up_W is
  /// not a unit vector.
  void add(const Bead& bead);
  std::size_t size() const;
  Bead bead(std::size_t index) const;
  std::size_t bytes() const;  ///< all memory held, beads and tree

  struct Near {
    /// Distance of the two surfaces, within 2 nm; 0 or less: minus the depth of the overlap (bead_shape.h).
    Separation separation;
    std::size_t bead = 0;
  };
  /// The nearest of the first `before` beads to a convex solid at X_WS, the deepest where it overlaps some;
  /// nothing where none is within `cutoff` [m]. `likely`: a bead that may be it, such as that of the pose
  /// before; it is looked at first, which changes the time alone.
  std::optional<Near> nearest(const ConvexSolid& solid, const Pose& X_WS, double cutoff,
                              std::size_t before = kAll, std::size_t likely = kAll) const;

  struct Hit {
    double distance = 0;                       ///< [m], along the ray or from the point (negative inside)
    Vec3 place_W{0, 0, 0}, normal_W{0, 0, 1};  ///< outward of the bead
    std::size_t bead = 0;
  };
  /// Where a ray from `origin` along the unit vector `direction` first enters a bead, at most `reach` away;
  /// the origin itself where it lies in one. `likely` as in nearest().
  std::optional<Hit> ray_hit(const Vec3& origin_W, const Vec3& direction_W, double reach,
                             std::size_t before = kAll, std::size_t likely = kAll) const;
  /// Nearest surface to a point, within `cutoff`. Outside exact; inside, the surface of the bead in which the
  /// point is deepest, which other beads may cover.
  std::optional<Hit> nearest_surface(const Vec3& p_W, double cutoff, std::size_t before = kAll) const;
  /// From a point inside a bead, or no more than `slack` from one [m], along the unit vector `direction` to
  /// the end of the heap: through every bead that the one before it meets, with at most `slack` of air
  /// between them. Nothing where the point is in none or the path ends.
  std::optional<Hit> way_out(const Vec3& p_W, const Vec3& direction_W, double slack,
                             std::size_t before = kAll) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
