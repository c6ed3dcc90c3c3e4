#include "sim/collision/body_set.h"

#include <algorithm>
#include <string>
#include <utility>

#include "geometry/printed_clearance.h"
#include "machine/machine_notes.h"
#include "sim/beads/hull_beads.h"
#include "sim/collision/machine_bodies.h"
#include "sim/distance/face_distance.h"
#include "sim/distance/penetration.h"

namespace understudy::sim {
namespace {

double reach_of(const geometry::Shape& shape) {
  if (const auto solid = convex_solid(shape)) return reach(*solid, shape.X_FS);
  double r = 0;
  for (const Vec3& v : std::get<geometry::MeshShape>(shape.form).mesh->vertices()) {
    r = std::max(r, (shape.X_FS * v).norm());
  }
  return r;
}

std::vector<std::array<std::string, 2>> kept_apart_by(const machine::MachineDescription& machine) {
  if (!machine.is_chain() || machine.file.empty()) return {};
  return machine::load_machine_notes(machine.file.string()).apart;
}

/// A block with the top's height and tilt. Where that is bowed, the block touches its highest place.
Pose table_pose(const geometry::TableSurface& top) {
  const Vec3 normal = top.normal({0, 0});
  return make_pose(Quat::FromTwoVectors(Vec3::UnitZ(), normal),
                   Vec3(0, 0, top.height + std::max(0.0, -top.bow)));
}

}  // namespace

BodySet::BodySet(const machine::MachineDescription& machine, const AsBuilt& as_built,
                 std::shared_ptr<const geometry::Mesh> part, const BeadIndex* beads,
                 const std::string& cutter)
    : X_WB_(machine.X_WB),
      geometry_(as_built.hexapod),
      links_(machine, as_built),
      is_chain_(machine.is_chain()),
      beads_(beads),
      apart_(kept_apart_by(machine)) {
  for (const geometry::Shape& shape : machine.tool.bodies) add_body(shape, Owner::tool, 0);
  if (is_chain_) {
    for (std::size_t i = 0; i < links_.items().size(); ++i) add_body(links_.items()[i].shape, Owner::link, i);
  } else {
    const std::size_t tools = machine.tool.bodies.size();
    const auto at_home = hexapod_bodies(machine, geometry_, machine.X_WB * machine.X_BT_home);
    for (std::size_t i = 0; i < kinematics::kStruts; ++i) add_body(at_home[tools + i], Owner::strut, i);
  }
  if (part) {
    part_ = std::make_unique<MeshClearance>(part);
    part_body_ = bodies_.size();
    add_body({"part", geometry::MeshShape{std::move(part)}, Pose::Identity()}, Owner::world, 0);
  }
  geometry::Shape table = machine.table;
  table.name = "table";
  table.X_FS = table_pose(as_built.table) * table.X_FS;
  add_body(table, Owner::world, 0);
  add_pairs(machine.is_chain() ? 0 : machine.hexapod().strut_radius, cutter);
  if (beads_) add_bead_pairs(bodies_.size() - 1);
}

void BodySet::add_body(const geometry::Shape& shape, Owner owner, std::size_t index) {
  Body body;
  body.shape = shape;
  body.owner = owner;
  body.solid = convex_solid(shape);
  if (const auto* mesh = std::get_if<geometry::MeshShape>(&shape.form); mesh && owner == Owner::link)
    body.hull = HullCore{mesh->mesh};
  body.index = index;
  body.nozzle = owner == Owner::tool && geometry::is_nozzle(shape.name);
  if (owner == Owner::tool) body.lever = reach_of(shape);
  // A strut turns about its base joint: no point of it moves farther than its ball joint.
  if (owner == Owner::strut) body.lever = geometry_.platform_joint[index].norm();
  body.fcl = body.hull ? world_.add_hull(body.hull->mesh) : world_.add(shape);
  bodies_.push_back(std::move(body));
}

bool BodySet::carries_joint(const Body& tool, std::size_t strut, double strut_radius) const {
  if (tool.shape.name == "platform") return true;
  const Vec3 p = tool.shape.X_FS.inverse(Eigen::Isometry) * geometry_.platform_joint[strut];
  return tool.solid ? signed_distance(*tool.solid, p) <= strut_radius : contains(tool.shape, p);
}

/// Axis that carries a body of a chain; the table and the part stand on the work's.
int BodySet::axis_of(const Body& body) const {
  if (body.owner == Owner::tool) return links_.tool_axis();
  return body.owner == Owner::world ? links_.work_axis() : links_.items()[body.index].axis;
}

bool BodySet::joined(const Body& a, const Body& b, double strut_radius) const {
  if (is_chain_)
    return (a.owner == Owner::link || b.owner == Owner::link) &&
           (links_.joined(axis_of(a), axis_of(b)) || kept_apart(a, b) || hangs_on_rod(a, b) ||
            hangs_on_rod(b, a));
  return b.owner == Owner::tool && carries_joint(b, a.index, strut_radius);
}

bool BodySet::hangs_on_rod(const Body& tool, const Body& rod) const {
  return tool.owner == Owner::tool && tool.shape.name == "platform" && rod.owner == Owner::link &&
         links_.items()[rod.index].rod >= 0;
}

bool BodySet::kept_apart(const Body& a, const Body& b) const {
  if (a.owner != Owner::link || b.owner != Owner::link) return false;
  return std::ranges::any_of(apart_, [&](const std::array<std::string, 2>& pair) {
    return (pair[0] == a.shape.name && pair[1] == b.shape.name) ||
           (pair[0] == b.shape.name && pair[1] == a.shape.name);
  });
}

void BodySet::add_pairs(double strut_radius, const std::string& cutter) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    for (std::size_t j = 0; j < bodies_.size(); ++j) {
      const Body &body = bodies_[i], &obstacle = bodies_[j];
      if (body.owner == Owner::world || (i == j)) continue;
      const bool tool_again = obstacle.owner == Owner::tool && body.owner == Owner::tool;
      const bool of_machine = obstacle.owner == Owner::strut || obstacle.owner == Owner::link;
      const bool other_way_round = of_machine && (body.owner == Owner::tool || j < i);
      if (tool_again || other_way_round || joined(body, obstacle, strut_radius)) continue;
      const bool cuts = part_ && j == part_body_ && body.owner == Owner::tool && !cutter.empty() &&
                        body.shape.name == cutter;
      if (cuts) continue;
      const bool at_work = body.nozzle && obstacle.owner == Owner::world;
      pairs_.push_back({i, j, at_work, at_work && (!part_ || j == part_body_)});
    }
  }
}

// Beads stand on the table: what cannot meet the one cannot meet the other.
void BodySet::add_bead_pairs(std::size_t table) {
  for (const BodyPair& pair : std::vector<BodyPair>(pairs_)) {
    const Body& body = bodies_[pair.body];
    if (pair.obstacle == table && (body.solid || body.hull))
      pairs_.push_back({pair.body, table, body.nozzle, false, true});
  }
}

double BodySet::motion(const BodyPair& pair, const Travel& travel) const {
  double sum = 0;
  for (const std::size_t i : {pair.body, pair.obstacle}) {
    const Body& body = bodies_[i];
    if (body.owner == Owner::link)
      sum += links_.motion(body.index, travel.axes, travel.path);
    else if (body.owner != Owner::world)
      sum += travel.path + travel.turn * body.lever;
  }
  return sum;
}

Pose BodySet::place(Body& body, const Pose& X_WT) {
  if (body.owner == Owner::world) return body.shape.X_FS;
  if (body.owner == Owner::tool) return X_WT * body.shape.X_FS;
  if (body.owner == Owner::link) return links_.place(body.index);
  const Vec3 base = X_WB_ * geometry_.base_joint[body.index],
             ball = X_WT * geometry_.platform_joint[body.index];
  const double length = (ball - base).norm();
  std::get<geometry::Capsule>(body.shape.form).length = length;
  std::get<SegmentCore>(body.solid->core).half = length / 2;
  world_.set_capsule_length(body.fcl, length);
  return make_pose(shortest_arc_from_z((ball - base) / length), Vec3(0.5 * (base + ball)));
}

Separation BodySet::surfaces(const Body& body, const Pose& X_W1, const Body& obstacle,
                             const Pose& X_W2) const {
  if (part_ && &obstacle == &bodies_[part_body_] && body.solid) return part_->distance(*body.solid, X_W1);
  if (const auto* box = std::get_if<geometry::Box>(&obstacle.shape.form); box && (body.solid || body.hull)) {
    const Pose X_BS = X_W2.inverse(Eigen::Isometry) * X_W1;
    const auto over = body.solid ? distance_over_face(*body.solid, X_BS, 0.5 * box->size)
                                 : distance_over_face(*body.hull, X_BS, 0.5 * box->size);
    if (over) return {over->distance, X_W2 * over->place_W};
  }
  return world_.distance(body.fcl, X_W1, obstacle.fcl, X_W2);
}

Separation BodySet::separation(const BodyPair& pair, const Configuration& configuration, bool check_inside) {
  Body &body = bodies_[pair.body], &obstacle = bodies_[pair.obstacle];
  if (body.owner == Owner::link || obstacle.owner == Owner::link) links_.pose(configuration.axes);
  const Pose X_W1 = place(body, configuration.X_WT), X_W2 = place(obstacle, configuration.X_WT);
  Separation result = surfaces(body, X_W1, obstacle, X_W2);
  bool overlap = result.distance <= 0;
  if (!overlap && check_inside) {
    overlap = contains(obstacle.shape, X_W2.inverse(Eigen::Isometry) * (X_W1 * point_of(body.shape)));
  }
  if (!overlap) return result;
  const Penetration deepest = penetration(body.shape, X_W1, obstacle.shape, X_W2);
  result.distance = -deepest.depth;
  if (deepest.depth > 0) result.place_W = deepest.place_W;
  return result;
}

std::optional<BeadIndex::Near> BodySet::nearest_bead(const BodyPair& pair, const Configuration& configuration,
                                                     double reach, std::size_t before, std::size_t likely) {
  Body& body = bodies_[pair.body];
  if (body.owner == Owner::link) links_.pose(configuration.axes);
  const Pose X_WS = place(body, configuration.X_WT);
  if (body.hull) return sim::nearest_bead(*beads_, *body.hull, X_WS, reach, before);
  return beads_->nearest(*body.solid, X_WS, reach, before, likely);
}

double BodySet::bead_clearance(const BodyPair& pair, const Configuration& configuration, const Bead& bead) {
  Body& body = bodies_[pair.body];
  if (body.owner == Owner::link) links_.pose(configuration.axes);
  const Vec3 from(bead.from_W[0], bead.from_W[1], bead.from_W[2]),
      to(bead.to_W[0], bead.to_W[1], bead.to_W[2]);
  const Vec3 middle_S = place(body, configuration.X_WT).inverse(Eigen::Isometry) * (0.5 * (from + to));
  const double middle =
      body.hull ? body.hull->mesh->signed_distance(middle_S) : signed_distance(*body.solid, middle_S);
  return middle - 0.5 * ((to - from).norm() + double(bead.width));
}

}  // namespace understudy::sim
