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

}  // namespace

std::string strut_part(int strut, const char* part) { return fmt::format("strut {} {}", strut + 1, part); }

std::string mjcf_text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string mjcf_text(const Mat3& R) {
  const Quat q(R);
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

std::string driven_joint(const std::string& name, const std::string& type, const Vec3& axis,
                         const machine::Drive& drive) {
  std::string spring;
  if (drive.stiffness > 0)
    spring = fmt::format(R"( stiffness="{}" damping="{}")", drive.stiffness,
                         2 * drive.damping_ratio * std::sqrt(drive.stiffness * drive.rotor()));
  return fmt::format(R"(<joint name="{}" type="{}" axis="{}" armature="{}"{}/>)", name, type, mjcf_text(axis),
                     drive.stiffness > 0 ? drive.rotor() : kRotor, spring);
}

std::string play_joint(const std::string& name, const std::string& type, const Vec3& axis, double travel,
                       double damping, double friction) {
  return fmt::format(R"(
        <joint name="{}" type="{}" axis="{}" damping="{}" limited="true" range="{} {}"{}/>)",
                     name, type, mjcf_text(axis), damping, -travel / 2, travel / 2,
                     friction > 0 ? fmt::format(R"( frictionloss="{}")", friction) : "");
}

std::string drive_equality(const std::string& name, const machine::Drive& drive) {
  if (drive.stiffness > 0) return "";
  return fmt::format(R"(
    <joint name="{0}" joint1="{0}"/>)",
                     name);
}

std::string mjcf_settings(const MujocoOptions& options, int rows) {
  return fmt::format(R"(
  <compiler angle="radian" inertiafromgeom="false"/>
  <size njmax="{rows}" nconmax="0" nstack="60000"/>
  <option timestep="{dt}" gravity="0 0 {g}" integrator="Euler" solver="Newton" tolerance="1e-10"
          jacobian="dense">
    <flag contact="disable" actuation="disable"/>
  </option>
  <default>
    <joint solreflimit="{tc} {stop}" solimplimit="{d} {d} 0.001"/>
    <equality solref="{tc} 1" solimp="{d} {d} 0.001"/>
  </default>)",
                     fmt::arg("rows", rows), fmt::arg("dt", options.timestep),
                     fmt::arg("g", options.gravity ? -kGravity : 0.0),
                     fmt::arg("tc", kConstraintSteps * options.timestep), fmt::arg("stop", kStopDamping),
                     fmt::arg("d", kImpedance));
}

std::string write_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built, const Pose& X_WT,
                       const MujocoOptions& options) {
  return machine.is_chain() ? write_chain_mjcf(machine, as_built, options)
                            : write_hexapod_mjcf(machine, as_built, X_WT, options);
}

std::unique_ptr<Plant> make_mujoco_plant(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const MujocoOptions& options) {
  return machine.is_chain() ? make_mujoco_chain(machine, as_built, options)
                            : make_mujoco_hexapod(machine, as_built, options);
}

}  // namespace understudy::sim
