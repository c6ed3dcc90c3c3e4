// What stands under the nozzle: the table, the inserted object and everything deposited so far.
#pragma once

#include <memory>
#include <optional>

#include "core/frames.h"
#include "geometry/mesh.h"
#include "sim/beads/bead_index.h"
#include "sim/deposition/surface_gap.h"

namespace understudy::sim {

/// Grows while it is printed on. Nothing in it assumes that layers lie along z.
class Workpiece {
 public:
  enum class Body { table, insert, bead };
  struct Hit {
    Body body = Body::table;
    double distance = 0;  ///< [m], along the ray, or from the point (negative inside)
    Vec3 place_W{0, 0, 0}, normal_W{0, 0, 1};
    std::size_t bead = 0;  ///< where it is one
  };

  /// The insert may be null. The table is seen from above.
  explicit Workpiece(std::shared_ptr<const geometry::Mesh> insert, const geometry::TableSurface& table = {});

  void add(const Bead& bead) { beads_.add(bead); }
  const BeadIndex& beads() const { return beads_; }
  const geometry::Mesh* insert() const { return insert_.get(); }

  // `before`: beads from that number on are not there: what was laid last is soft and under the nozzle.
  // Places that are not finite throw MachineError. Where two bodies are met at once, a bead comes before the
  // insert and the insert before the table.

  /// What a ray meets first; at distance 0 from inside a bead.
  std::optional<Hit> ray_hit(const Vec3& origin_W, const Vec3& direction_W, double reach,
                             std::size_t before = BeadIndex::kAll) const;
  /// Nearest surface within `cutoff`; inside, the one below which the point is deepest. An open insert has no
  /// inside.
  std::optional<Hit> nearest(const Vec3& p_W, double cutoff, std::size_t before = BeadIndex::kAll) const;
  /// What lies below the tip along the tool axis: `distance` is the true gap, negative where the tip is
  /// inside: then it is the distance up through everything that lies on one another there, to the top of the
  /// heap. Nothing within kGapReach: none. A roof above the tip is no surface to print on. An open insert is
  /// met from its outside only. `likely`: a bead that may lie there, see BeadIndex. Beads deeper than `reach`
  /// are not looked for.
  std::optional<Hit> below(const Pose& X_WT, std::size_t before = BeadIndex::kAll,
                           std::size_t likely = BeadIndex::kAll, double reach = kGapReach) const;

 private:
  std::optional<Hit> top_of_heap(const Vec3& tip_W, const Vec3& axis_W, std::size_t before) const;

  std::shared_ptr<const geometry::Mesh> insert_;
  geometry::TableSurface table_;
  BeadIndex beads_;
};

}  // namespace understudy::sim
