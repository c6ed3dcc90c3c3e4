#include "sim/collision/chain_bodies.h"

#include <algorithm>
#include <cmath>

#include "kinematics/chain/rods.h"
#include "sim/distance/convex_solid.h"
#include "sim/distance/hull_core.h"

namespace understudy::sim {
namespace {

/// [m], that a slide can put between what it carries and where it was at 0. An endless slide has no bound.
double slide_travel(const kinematics::ChainAxis& axis) {
  return axis.angle ? 0 : std::max(std::abs(axis.lower), std::abs(axis.upper));
}

}  // namespace

ChainBodies::ChainBodies(const machine::MachineDescription& machine, const AsBuilt& as_built)
    : chain_(as_built.chain), zero_(as_built.axis_zero), X_WB_(machine.X_WB) {
  if (!machine.is_chain()) return;
  for (const geometry::Shape& shape : machine.chain().frame_bodies) items_.push_back({shape, -1});
  for (int i = 0; i < chain_.size(); ++i)
    for (const geometry::Shape& shape : machine.chain().links[i].bodies) items_.push_back({shape, i});
  if (!chain_.rods.empty()) add_rods(machine.chain().rods);
  X_OL_.resize(chain_.axes.size(), Pose::Identity());
  for (const Item& item : items_) {
    kinematics::AxisVector lever{};
    const auto add = [&](int last, bool work) {
      for (int i = last; i >= 0; i = axis(i).parent)
        lever[i] += axis(i).angle ? reach_from(work ? -1 : i, item) + (work ? way_to(i) : 0) : 1;
    };
    add(item.axis, false);
    add(chain_.work_axis, true);  // seen from the work, everything else moves when the work does
    levers_.push_back(lever);
  }
}

void ChainBodies::add_rods(const machine::Rods& rods) {
  tool_offset_ = rods.tool_offset;
  for (int i = 0; i < kinematics::kRods; ++i)
    for (const double side : {-0.5, 0.5}) {
      geometry::Shape rod = geometry::capsule_between("rod " + axis(i).name, Vec3(0, 0, 0),
                                                      Vec3(0, 0, chain_.rods[std::size_t(i)]), rods.radius);
      items_.push_back({std::move(rod), i, i, side * rods.spacing});
    }
}

/// In O, of the shape's own frame: from the joint on the tool to that on the slide. Both stand off from where
/// the rods meet in kinematics, towards the slide's tower and to the side within the pair.
Pose ChainBodies::rod_place(const Item& rod) const {
  const kinematics::ChainAxis& tower = axis(rod.rod);
  const Vec3 slide = tower.point + posed_[std::size_t(rod.rod)] * tower.direction;
  const Vec3 out = tower.point - tower.point.dot(tower.direction) * tower.direction;
  const Vec3 to_tower = out.norm() > 0 ? Vec3(out.normalized()) : tower.direction.unitOrthogonal();
  const Vec3 off = tool_offset_ * to_tower + rod.side * tower.direction.cross(to_tower);
  return make_pose(shortest_arc_from_z((slide - rods_meet_O_).normalized()),
                   Vec3(0.5 * (slide + rods_meet_O_) + off));
}

/// Of the item's farthest point from a point of the axis (-1: from the frame's origin), in any configuration:
/// along the chain between them.
double ChainBodies::reach_from(int from, const Item& item) const {
  const auto* mesh = std::get_if<geometry::MeshShape>(&item.shape.form);
  const Vec3 anchor = item.axis < 0 ? Vec3(0, 0, 0) : axis(item.axis).point;
  Pose X_AF = item.shape.X_FS;
  X_AF.translation() -= anchor;
  double length = mesh ? reach(HullCore{mesh->mesh}, X_AF) : reach(*convex_solid(item.shape), X_AF);
  for (int i = item.axis; i >= 0 && i != from; i = axis(i).parent) {
    const Vec3 parent = axis(i).parent < 0 ? Vec3(0, 0, 0) : axis(axis(i).parent).point;
    length += (axis(i).point - parent).norm() + slide_travel(axis(i));
  }
  return length;
}

/// From the frame's origin to a point of the axis, in any configuration of what carries it.
double ChainBodies::way_to(int last) const {
  double length = 0;
  for (int i = last; i >= 0; i = axis(i).parent) {
    const Vec3 parent = axis(i).parent < 0 ? Vec3(0, 0, 0) : axis(axis(i).parent).point;
    length += (axis(i).point - parent).norm() + slide_travel(axis(i));
  }
  return length;
}

void ChainBodies::pose(const kinematics::AxisVector& axes) {
  if (chain_.axes.empty()) return;
  kinematics::AxisVector built = axes;
  for (std::size_t i = 0; i < built.size(); ++i) built[i] += zero_[i];
  kinematics::link_poses(chain_, built, X_OL_);
  posed_ = built;
  // Where they do not meet, the plant has failed.
  if (!chain_.rods.empty()) static_cast<void>(kinematics::rods_meet(chain_, posed_, rods_meet_O_));
  X_WO_ = chain_.work_axis < 0 ? Pose(X_WB_ * chain_.X_OS_zero.inverse())
                               : Pose((X_OL_[chain_.work_axis] * chain_.X_OS_zero).inverse());
}

Pose ChainBodies::place(std::size_t item) const {
  const Item& body = items_[item];
  if (body.rod >= 0) return X_WO_ * rod_place(body);
  const Pose X_WL = body.axis < 0 ? X_WO_ : Pose(X_WO_ * X_OL_[body.axis]);
  return X_WL * body.shape.X_FS;
}

double ChainBodies::motion(std::size_t item, const kinematics::AxisVector& travel, double path) const {
  double sum = items_[item].rod >= 0 ? path : 0;  // one end goes with its slide, the other with the tool
  for (std::size_t i = 0; i < travel.size(); ++i) sum += levers_[item][i] * travel[i];
  return sum;
}

bool ChainBodies::joined(int a, int b) const {
  if (a == b) return true;
  return (a >= 0 && axis(a).parent == b) || (b >= 0 && axis(b).parent == a);
}

}  // namespace understudy::sim
