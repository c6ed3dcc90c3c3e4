// A tool on rods: each slide carries one rod on a universal joint, whose other end is tied to the tool. The
// rod stands for its pair, which lets the tool only translate: the tool is on three slides of its own.
#include <fmt/format.h>

#include "core/error.h"
#include "kinematics/chain/rods.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/mujoco/mjcf.h"

namespace understudy::sim {
namespace {

using kinematics::kRods;

std::string number(double value) { return fmt::format("{}", value); }

void add_inertial(XMLElement& body, double mass, const Vec3& centre, const Vec3& moments) {
  add_element(body, "inertial",
              {{"pos", mjcf_text(centre)}, {"mass", number(mass)}, {"diaginertia", mjcf_text(moments)}});
}

void add_hinge(XMLElement& body, const std::string& name, const Vec3& axis) {
  add_element(
      body, "joint",
      {{"name", name}, {"type", "hinge"}, {"axis", mjcf_text(axis)}, {"damping", number(kHingeDamping)}});
}

/// Frame of the rod: origin in its joint on the slide, z along it, x the first axis of the universal joint,
/// across the tower and the rod.
void add_rod(XMLElement& slide, const std::string& name, const Vec3& along, const Vec3& tower, double mass,
             double radius) {
  const Vec3 z = along.normalized(), x = tower.cross(z).norm() > 1e-6 ? Vec3(tower.cross(z).normalized())
                                                                      : Vec3(tower.unitOrthogonal());
  Mat3 R;
  R << x, z.cross(x), z;
  XMLElement& rod = add_element(slide, "body", {{"name", name}, {"quat", mjcf_text(R)}});
  const double length = along.norm(), across = mass * length * length / 12;
  add_inertial(rod, mass, Vec3(0, 0, length / 2), Vec3(across, across, mass * radius * radius / 2));
  add_hinge(rod, name + " lean", Vec3::UnitX());
  add_hinge(rod, name + " side", Vec3::UnitY());
}

void add_carried(XMLElement& world, const Vec3& meet, const kinematics::Chain& chain, double mass) {
  XMLElement& body = add_element(world, "body", {{"name", kPlatformBody}, {"pos", mjcf_text(meet)}});
  // It does not turn: its moments of inertia are of no consequence.
  add_inertial(body, mass, Vec3::Zero(), Vec3::Constant(cube_moment(mass)));
  for (int i = 0; i < 3; ++i)
    add_element(body, "joint",
                {{"name", fmt::format("{} {}", kPlatformBody, "xyz"[i])},
                 {"type", "slide"},
                 {"axis", mjcf_text(Vec3(Vec3::Unit(i)))}});
  add_element(body, "site",
              {{"name", "tip"},
               {"size", "0.0005"},
               {"pos", mjcf_text(Vec3(chain.X_OT_zero.translation()))},
               {"quat", mjcf_text(Mat3(chain.X_OT_zero.linear()))}});
}

}  // namespace

std::string rod_name(const std::string& axis) { return "rod " + axis; }

std::string write_rod_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built,
                           const Pose& X_WT, const MujocoOptions& options) {
  const kinematics::Chain& chain = as_built.chain;
  const machine::ChainModel& model = machine.chain();
  const Pose X_OT = chain.X_OS_zero * machine.X_WB.inverse() * X_WT;
  const Vec3 meet = X_OT.translation() - chain.X_OT_zero.translation();
  AxisVector slides{};
  if (kinematics::slides_of_rods(chain, meet, slides) != kinematics::SolveStatus::ok)
    throw MachineError("the rods of the as-built machine do not reach the pose in which it is assembled");
  const Mat3 rods = kinematics::rod_vectors(chain, slides, meet);

  tinyxml2::XMLDocument document;
  // Closures and drives give 12 rows, play limits at most 6, friction 3.
  XMLElement& root = add_model(document, machine.name, options, 40);
  XMLElement& world = add_element(root, "worldbody");
  XMLElement& equality = add_element(root, "equality");
  add_carried(world, meet, chain, model.rods.carried);
  for (std::size_t i = 0; i < kRods; ++i) {
    const kinematics::ChainAxis& axis = chain.axes[i];
    XMLElement& slide =
        add_element(world, "body",
                    {{"name", axis.name}, {"pos", mjcf_text(Vec3(axis.point + slides[i] * axis.direction))}});
    add_inertial(slide, model.links[i].mass, Vec3::Zero(), model.links[i].inertia_O.diagonal());
    add_driven_joint(slide, {axis.name, false, axis.direction}, machine.drives[i]);
    if (options.play && as_built.axis_play[i] > 0)
      add_play_joint(slide, {chain_play(axis.name), false, axis.direction},
                     {as_built.axis_play[i], kPlayDamping, model.friction[i]});
    add_rod(slide, rod_name(axis.name), rods.row(static_cast<int>(i)).transpose(), axis.direction,
            model.rods.mass, model.rods.radius);
    add_element(equality, "connect",
                {{"name", rod_name(axis.name)},
                 {"body1", kPlatformBody},
                 {"body2", rod_name(axis.name)},
                 {"anchor", mjcf_text(Vec3(Vec3::Zero()))}});
  }
  for (std::size_t i = 0; i < kRods; ++i) add_drive_equality(equality, chain.axes[i].name, machine.drives[i]);
  return to_text(document);
}

}  // namespace understudy::sim
