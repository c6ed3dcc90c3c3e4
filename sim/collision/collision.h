// Contact and clearance between machine and surroundings, adaptive in time so that nothing is stepped over.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "sim/beads/bead_index.h"
#include "sim/collision/configuration.h"
#include "sim/observer.h"

namespace understudy::sim {

struct Contact {
  std::string body;       ///< "nozzle", "heater block", "strut 3"
  std::string obstacle;   ///< "part", "table", "strut 4", "bead of line 812"
  double clearance = 0;   ///< [m]; negative: depth of the deepest point of either surface in the other body
  Vec3 place_W{0, 0, 0};  ///< nearest point on the obstacle; the deepest point where they overlap
  double time = 0;        ///< [s]
  int line = 0;
  int bead_line = 0;  ///< of a bead: the line that laid it
};

struct CollisionOptions {
  double margin = 0.02e-3;  ///< [m], above 0: motion between two checks may use up the clearance but for this
  double near = 0.5e-3;     ///< [m]: below, a body other than the nozzle is a near collision
  double nozzle_contact = 0;  ///< [m]: the nozzle touches when its clearance is at or below this
  /// The beads printed so far, growing between snapshots; nullptr: they are not checked.
  const BeadIndex* beads = nullptr;
  /// Number of the first bead that is still under the nozzle, which presses it by design; asked at every
  /// snapshot. Without it no bead is fresh.
  std::function<std::size_t()> fresh_from;
  /// [m]: the nozzle runs level with the beads of its own layer and presses into them by half a usual layer
  /// and a machine's play; deeper is a contact.
  double bead_press = 0.10e-3;
  /// Name of the tool's body that cuts the part: it may touch that.
  std::string cutter = {};
};

/// Watches every snapshot. Between snapshots the motion is bounded by the swept distance of each body, and
/// the interval is subdivided (poses interpolated) while clearance minus margin is smaller than the bound.
///
/// Each pair has its own budget of motion, so that a pair is looked at again only when it could have reached
/// something that matters. What this promises of the interpolated motion:
/// - a contact deeper than margin / 2 is never missed (nozzle against the part: margin / 8), and nothing is
///   reported that was not measured at some pose between the snapshots;
/// - min_clearance() is at most max(0.05 mm, 1 %), min_nozzle_clearance() at most max(margin / 8, 1 %) above
///   the least that was passed, and never below it; margin / 4 where the motion ends at the least;
/// - the depth of a contact is within max(margin, 5 %) of the deepest of its line.
/// Beads are obstacles from the moment they are in the index, for the nozzle once they are no longer fresh;
/// they are not followed between two snapshots. A nozzle deeper in beads than bead_press is found within as
/// much motion, its depth within bead_press; that pair counts in min_nozzle_clearance() only there.
/// A body named "nozzle..." is the nozzle; struts are not checked against the tool body that carries their
/// ball joint ("platform", or any within a strut's radius of the joint). Distances to the part are exact to
/// 2 nm, as are those over a face of a box, such as the table; all others to 0.5 um or 0.01 % of a round
/// body's radius, and of meshes to 0.002 % of the distance (FCL). Depths need a closed part; without
/// one a contact has clearance 0.
class CollisionObserver : public Observer {
 public:
  /// The part may be null. Throws InputError for a margin that is not positive; observe() throws MachineError
  /// for a pose that is not finite.
  CollisionObserver(const machine::MachineDescription& machine, const AsBuilt& as_built,
                    std::shared_ptr<const geometry::Mesh> part, const CollisionOptions& options);
  ~CollisionObserver() override;

  void observe(const Snapshot& snapshot) override;

  /// One entry per pair of bodies and G-code line, the deepest; ordered by time. A pair that collides on a
  /// line is not near on it.
  std::vector<Contact> collisions() const;
  std::vector<Contact> near_collisions() const;
  /// Smallest clearance of all pairs but nozzle against part, whose gap is the work itself. Without a part,
  /// that against the table is left out instead.
  double min_clearance() const;
  Contact closest() const;
  /// Smallest clearance of the nozzle to the part, or to the table where there is no part, and to beads that
  /// it is pressed into deeper than bead_press; infinity before the first snapshot.
  double min_nozzle_clearance() const;
  /// [m], the least distance of the nozzle to the part, or to the table where there is no part, that was
  /// measured since the snapshot before the last; infinity: none was, since between the looks before and
  /// after nothing that min_nozzle_clearance() or a contact depends on could be missed.
  double nozzle_clearance_seen() const;
  std::uint64_t checks() const;  ///< distances measured
  int pairs() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
