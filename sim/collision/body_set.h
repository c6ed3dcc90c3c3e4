// The bodies that may meet, posed by the tool: which pairs to check, how far apart they are, how far each can
// move for a given motion of the tool.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/beads/bead_index.h"
#include "sim/collision/chain_bodies.h"
#include "sim/collision/collision.h"
#include "sim/collision/fcl_world.h"
#include "sim/distance/convex_solid.h"
#include "sim/distance/hull_core.h"
#include "sim/distance/mesh_clearance.h"

namespace understudy::sim {

struct BodyPair {
  std::size_t body = 0, obstacle = 0;
  bool nozzle_at_work = false;  ///< nozzle against part or table: nearness is its work
  bool nozzle_gap = false;      ///< the gap of the work itself: to the part, or the table without one
  bool printed = false;         ///< the obstacle is everything printed so far
};

class BodySet {
 public:
  /// The part and the beads may be null. Struts and links have the as-built geometry; a link that is a mesh
  /// is its own convex hull. Pairs of links that the machine's file keeps apart (machine/machine_notes.h) are
  /// left out: it is read again for them, where the description came from a file.
  /// So are those of the tool body `cutter` with the part.
  BodySet(const machine::MachineDescription& machine, const AsBuilt& as_built,
          std::shared_ptr<const geometry::Mesh> part, const BeadIndex* beads, const std::string& cutter = "");

  /// Tool bodies, struts and links against part and table, struts and links against each other and against
  /// the tool bodies; without those that a joint holds together.
  const std::vector<BodyPair>& pairs() const { return pairs_; }
  const std::string& name(std::size_t body) const { return bodies_[body].shape.name; }

  /// How much a machine moves from one configuration to another.
  struct Travel {
    double path = 0;                ///< [m], of the tip
    double turn = 0;                ///< [rad], of the tool
    kinematics::AxisVector axes{};  ///< [m] or [rad], without sign
  };
  /// [m], at most, by which the two can approach.
  double motion(const BodyPair& pair, const Travel& travel) const;

  /// Distance of the two surfaces at a pose of the tool; where they overlap, minus the depth. `check_inside`
  /// also finds a body that lies wholly inside a closed part, which no surface shows.
  Separation separation(const BodyPair& pair, const Configuration& configuration, bool check_inside);

  /// The nearest of the first `before` beads; nothing where none is within `reach` [m]. `likely`: one that
  /// may be it, see BeadIndex.
  std::optional<BeadIndex::Near> nearest_bead(const BodyPair& pair, const Configuration& configuration,
                                              double reach, std::size_t before,
                                              std::size_t likely = BeadIndex::kAll);
  /// [m], at least, between the pair's body and one bead.
  double bead_clearance(const BodyPair& pair, const Configuration& configuration, const Bead& bead);

 private:
  enum class Owner { tool, strut, link, world };
  struct Body {
    geometry::Shape shape;  // X_FS in T for the tool's, in W for the world's
    Owner owner = Owner::world;
    std::optional<ConvexSolid> solid;  // nothing for a mesh
    std::optional<HullCore> hull;      // of a link that is one
    std::size_t index = 0;             // of the strut or link
    bool nozzle = false;
    double lever = 0;  // [m], from the tip to the farthest point that turns with the tool
    int fcl = -1;
  };
  void add_body(const geometry::Shape& shape, Owner owner, std::size_t index);
  void add_pairs(double strut_radius, const std::string& cutter);
  void add_bead_pairs(std::size_t table);
  bool carries_joint(const Body& tool, std::size_t strut, double strut_radius) const;
  bool joined(const Body& a, const Body& b, double strut_radius) const;
  bool hangs_on_rod(const Body& tool, const Body& rod) const;
  bool kept_apart(const Body& a, const Body& b) const;
  int axis_of(const Body& body) const;
  Pose place(Body& body, const Pose& X_WT);
  Separation surfaces(const Body& body, const Pose& X_W1, const Body& obstacle, const Pose& X_W2) const;

  Pose X_WB_;
  kinematics::HexapodGeometry geometry_;
  ChainBodies links_;
  bool is_chain_ = false;
  const BeadIndex* beads_ = nullptr;
  std::unique_ptr<MeshClearance> part_;
  std::size_t part_body_ = 0;
  FclWorld world_;
  std::vector<std::array<std::string, 2>> apart_;
  std::vector<Body> bodies_;
  std::vector<BodyPair> pairs_;
};

}  // namespace understudy::sim
