// Contact and clearance between machine and surroundings, adaptive in time so that nothing is stepped over.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "machine/description.h"
#include "sim/as_built/as_built.h"
#include "sim/observer.h"

namespace understudy::sim {

/// The bodies of a hexapod at a pose: tool bodies and platform in W, six strut capsules from base joint to
/// ball joint. Shared by collision checks and pictures. Each shape's X_FS is its pose in W.
std::vector<geometry::Shape> machine_bodies(const machine::MachineDescription& machine,
                                            const kinematics::HexapodGeometry& geometry, const Pose& X_WT);

struct Contact {
  std::string body;       ///< "nozzle", "heater block", "strut 3"
  std::string obstacle;   ///< "part", "table", "strut 4"
  double clearance = 0;   ///< [m]; negative: depth
  Vec3 place_W{0, 0, 0};  ///< nearest point on the obstacle
  double time = 0;        ///< [s]
  int line = 0;
};

struct CollisionOptions {
  double margin = 0.02e-3;    ///< [m]: motion between two checks may use up the clearance but for this
  double near = 0.5e-3;       ///< [m]: below, a body other than the nozzle is a near collision
  double nozzle_contact = 0;  ///< [m]: the nozzle touches when its clearance is at or below this
};

/// Watches every snapshot. Between snapshots the motion is bounded by the swept distance of each body, and
/// the interval is subdivided (poses interpolated) while clearance minus margin is smaller than the bound.
class CollisionObserver : public Observer {
 public:
  CollisionObserver(const machine::MachineDescription& machine, const AsBuilt& as_built,
                    std::shared_ptr<const geometry::Mesh> part, const CollisionOptions& options);
  ~CollisionObserver() override;

  void observe(const Snapshot& snapshot) override;

  /// One entry per pair of bodies and G-code line: the deepest.
  std::vector<Contact> collisions() const;
  std::vector<Contact> near_collisions() const;
  /// Smallest clearance of all pairs but nozzle against part, whose gap is the work itself.
  double min_clearance() const;
  Contact closest() const;
  /// Smallest clearance of the nozzle to the part.
  double min_nozzle_clearance() const;
  std::uint64_t checks() const;
  int pairs() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace understudy::sim
