#include "sim/plant/mujoco/mjcf.h"

#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::sim {
namespace {

// The screw turns and does not travel. The inertia of its rotor only keeps the mass matrix regular, because
// the motion of a rigid drive is prescribed.
constexpr double kRotor = 0.1;  // [kg] or [kg m^2]
// Damping ratio of the stops at the ends of play: at 1 a discrete stop rebounds, and an unloaded strut
// rattles on for seconds; at 2 it does not.
constexpr double kStopDamping = 2.0;

std::string number(double value) { return fmt::format("{}", value); }

XMLElement& add_joint(XMLElement& body, const MjcfJoint& joint) {
  return add_element(
      body, "joint",
      {{"name", joint.name}, {"type", joint.hinge ? "hinge" : "slide"}, {"axis", mjcf_text(joint.axis)}});
}

}  // namespace

std::string strut_part(int strut, const char* part) { return fmt::format("strut {} {}", strut + 1, part); }

std::string mjcf_text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string mjcf_text(const Mat3& R) {
  const Quat q(R);
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

void add_driven_joint(XMLElement& body, const MjcfJoint& joint, const machine::Drive& drive) {
  XMLElement& element = add_joint(body, joint);
  element.SetAttribute("armature", number(drive.stiffness > 0 ? drive.rotor() : kRotor).c_str());
  if (!(drive.stiffness > 0)) return;
  element.SetAttribute("stiffness", number(drive.stiffness).c_str());
  const double damping = 2 * drive.damping_ratio * std::sqrt(drive.stiffness * drive.rotor());
  element.SetAttribute("damping", number(damping).c_str());
}

void add_drive_equality(XMLElement& equality, const std::string& name, const machine::Drive& drive) {
  if (drive.stiffness > 0) return;
  add_element(equality, "joint", {{"name", name}, {"joint1", name}});
}

void add_play_joint(XMLElement& body, const MjcfJoint& joint, const MjcfPlay& play) {
  XMLElement& element = add_joint(body, joint);
  element.SetAttribute("damping", number(play.damping).c_str());
  element.SetAttribute("limited", "true");
  element.SetAttribute("range", fmt::format("{} {}", -play.travel / 2, play.travel / 2).c_str());
  if (play.friction > 0) element.SetAttribute("frictionloss", number(play.friction).c_str());
}

XMLElement& add_model(tinyxml2::XMLDocument& document, const std::string& name, const MujocoOptions& options,
                      int rows) {
  XMLElement& model = add_element(document, "mujoco", {{"model", name}});
  add_element(model, "compiler", {{"angle", "radian"}, {"inertiafromgeom", "false"}});
  add_element(model, "size", {{"njmax", fmt::format("{}", rows)}, {"nconmax", "0"}, {"nstack", "60000"}});
  XMLElement& option = add_element(model, "option",
                                   {{"timestep", number(options.timestep)},
                                    {"gravity", fmt::format("0 0 {}", options.gravity ? -kGravity : 0.0)},
                                    {"integrator", "Euler"},
                                    {"solver", "Newton"},
                                    {"tolerance", "1e-10"},
                                    {"jacobian", "dense"}});
  add_element(option, "flag", {{"contact", "disable"}, {"actuation", "disable"}});
  const double time_constant = kConstraintSteps * options.timestep;
  const std::string impedance = fmt::format("{0} {0} 0.001", kImpedance);
  XMLElement& defaults = add_element(model, "default");
  add_element(
      defaults, "joint",
      {{"solreflimit", fmt::format("{} {}", time_constant, kStopDamping)}, {"solimplimit", impedance}});
  add_element(defaults, "equality", {{"solref", fmt::format("{} 1", time_constant)}, {"solimp", impedance}});
  return model;
}

std::string write_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built, const Pose& X_WT,
                       const MujocoOptions& options) {
  return machine.visit(
      [&](const machine::HexapodModel&) { return write_hexapod_mjcf(machine, as_built, X_WT, options); },
      [&](const machine::ChainModel&) {
        return as_built.chain.rods.empty() ? write_chain_mjcf(machine, as_built, options)
                                           : write_rod_mjcf(machine, as_built, X_WT, options);
      });
}

std::unique_ptr<Plant> make_mujoco_plant(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const MujocoOptions& options) {
  return machine.visit(
      [&](const machine::HexapodModel&) { return make_mujoco_hexapod(machine, as_built, options); },
      [&](const machine::ChainModel&) {
        return as_built.chain.rods.empty() ? make_mujoco_chain(machine, as_built, options)
                                           : make_mujoco_rods(machine, as_built, options);
      });
}

}  // namespace understudy::sim
