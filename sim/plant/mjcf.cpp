#include "sim/plant/mjcf.h"

#include <fmt/format.h>

#include <cmath>

#include "core/units.h"
#include "sim/plant/strut_chain.h"

namespace understudy::sim {
namespace {

// Joint clearances are greasy: damping of a play slide (reference I).
constexpr double kPlayDamping = 2.0;  // [N s/m]
// Of the universal joints, small beside gravity: 1 rad/s costs a strut 0.5 mN at its ball.
constexpr double kHingeDamping = 1e-4;  // [N m s/rad]
// The screw turns and does not travel. The inertia of its rotor only keeps the mass matrix regular, because
// the screw's motion is prescribed.
constexpr double kScrewArmature = 0.1;  // [kg]
// Damping ratio of the stops at the ends of play: at 1 a discrete stop rebounds, and an unloaded strut
// rattles on for seconds; at 2 it does not.
constexpr double kStopDamping = 2.0;
// Share of the nut-and-rod mass that sits beyond the ball joint's play.
constexpr double kRodEndShare = 0.5;
// Motor and rod are taken for solid cubes of this density: the description states only their masses.
constexpr double kSteelDensity = 7850;  // [kg/m^3]

std::string text(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string text(const Mat3& R) {
  const Quat q(R);
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

std::string inertial(double mass, const Vec3& centre) {
  const double side = std::cbrt(mass / kSteelDensity);
  const double moment = mass * side * side / 6;
  return fmt::format(R"(<inertial pos="{}" mass="{}" diaginertia="{} {} {}"/>)", text(centre), mass, moment,
                     moment, moment);
}

std::string play_slide(const std::string& name, const Vec3& axis, double travel) {
  return fmt::format(R"(
        <joint name="{}" type="slide" axis="{}" damping="{}" limited="true" range="{} {}"/>)",
                     name, text(axis), kPlayDamping, -travel / 2, travel / 2);
}

struct Clearance {
  double nut = 0;   ///< [m], 0: no joint
  double ball = 0;  ///< [m]
  bool across = false;
};

/// The ball joint's clearance: a slide along the line between the joints, which carries the force, and
/// perhaps two across it.
std::string rod_end(int strut, const Mat3& R_NE, double mass, const Clearance& play) {
  std::string slides;
  if (play.across)
    slides = play_slide(strut_part(strut, "ball play x"), Vec3::UnitX(), play.ball) +
             play_slide(strut_part(strut, "ball play y"), Vec3::UnitY(), play.ball);
  slides += play_slide(strut_part(strut, "ball play z"), Vec3::UnitZ(), play.ball);
  return fmt::format(R"(
        <body name="{}" quat="{}">
          {}{}
        </body>)",
                     strut_part(strut, "rod end"), text(R_NE), inertial(mass, Vec3::Zero()), slides);
}

/// Motor frame: origin in the universal joint, x along the offset, z along the screw.
std::string strut_bodies(int strut, const StrutChain& chain, const machine::Masses& masses,
                         const Clearance& play) {
  Mat3 R_WM;
  R_WM << chain.offset_W, chain.screw_W.cross(chain.offset_W), chain.screw_W;
  const Vec3 d_M = R_WM.transpose() * (chain.ball_W - chain.base_W);
  const double dev = d_M.x();
  const double rod_end_mass = play.ball > 0 ? kRodEndShare * masses.nut : 0.0;

  std::string nut_play, end;
  if (play.nut > 0) nut_play = play_slide(strut_part(strut, "nut play"), Vec3::UnitZ(), play.nut);
  if (play.ball > 0) {
    const Vec3 d_axis = d_M.normalized();
    Mat3 R_ME;
    R_ME << Vec3::UnitY().cross(d_axis), Vec3::UnitY(), d_axis;
    end = rod_end(strut, R_ME, rod_end_mass, play);
  }
  return fmt::format(R"(
    <body name="{motor}" pos="{base}" quat="{R_WM}">
      {motor_inertia}
      <joint name="{alpha}" type="hinge" axis="{tangent}" damping="{hinge_damping}"/>
      <joint name="{beta}" type="hinge" axis="1 0 0" damping="{hinge_damping}"/>
      <body name="{nut}" pos="{ball}">
        {nut_inertia}
        <joint name="{screw}" type="slide" axis="0 0 1" armature="{armature}"/>{nut_play}{end}
      </body>
    </body>)",
                     fmt::arg("motor", strut_part(strut, "motor")), fmt::arg("base", text(chain.base_W)),
                     fmt::arg("R_WM", text(R_WM)),
                     fmt::arg("motor_inertia", inertial(masses.motor, Vec3(dev, 0, 0))),
                     fmt::arg("alpha", strut_part(strut, "alpha")),
                     fmt::arg("tangent", text(Vec3(R_WM.transpose() * chain.tangent_W))),
                     fmt::arg("hinge_damping", kHingeDamping), fmt::arg("beta", strut_part(strut, "beta")),
                     fmt::arg("nut", strut_part(strut, "nut")), fmt::arg("ball", text(d_M)),
                     fmt::arg("nut_inertia", inertial(masses.nut - rod_end_mass, Vec3::Zero())),
                     fmt::arg("screw", strut_part(strut, kScrewPart)), fmt::arg("armature", kScrewArmature),
                     fmt::arg("nut_play", nut_play), fmt::arg("end", end));
}

std::string platform_body(const machine::Masses& masses, const Pose& X_WT, double drag) {
  return fmt::format(R"(
    <body name="{}" pos="{}" quat="{}">
      <joint name="platform" type="free" damping="{}"/>
      <inertial pos="{}" mass="{}" diaginertia="{}"/>
      <site name="tip" size="0.0005"/>
    </body>)",
                     kPlatformBody, text(Vec3(X_WT.translation())), text(Mat3(X_WT.linear())), drag,
                     text(masses.platform_centre_T), masses.platform, text(masses.platform_inertia));
}

std::string closures_and_drives(const AsBuilt& as_built, const std::array<const char*, 6>& end_parts) {
  std::string xml;
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    xml += fmt::format(R"(
    <connect name="{}" body1="{}" body2="{}" anchor="{}"/>)",
                       strut_part(i, kClosurePart), kPlatformBody, strut_part(i, end_parts[s]),
                       text(as_built.hexapod.platform_joint[s]));
  }
  for (int i = 0; i < kinematics::kStruts; ++i)
    xml += fmt::format(R"(
    <joint name="{0}" joint1="{0}"/>)",
                       strut_part(i, kScrewPart));
  return xml;
}

}  // namespace

std::string strut_part(int strut, const char* part) { return fmt::format("strut {} {}", strut + 1, part); }

std::string write_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built, const Pose& X_WT,
                       const MujocoOptions& options) {
  std::string struts;
  std::array<const char*, 6> end_parts{};
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    Clearance play;
    if (options.play) play = {as_built.nut_play[s], as_built.ball_play[s], options.play_across_struts};
    const StrutChain chain = assemble_strut(as_built.hexapod, machine.joints, machine.X_WB, X_WT, i);
    struts += strut_bodies(i, chain, machine.masses, play);
    end_parts[s] = play.ball > 0 ? "rod end" : "nut";
  }
  const double time_constant = kConstraintSteps * options.timestep;
  // Closures and drives give 24 rows, play limits at most 24 more.
  return fmt::format(R"(<mujoco model="{name}">
  <compiler angle="radian" inertiafromgeom="false"/>
  <size njmax="100" nconmax="0" nstack="60000"/>
  <option timestep="{dt}" gravity="0 0 {g}" integrator="Euler" solver="Newton" tolerance="1e-10"
          jacobian="dense">
    <flag contact="disable" actuation="disable"/>
  </option>
  <default>
    <joint solreflimit="{tc} {stop}" solimplimit="{d} {d} 0.001"/>
    <equality solref="{tc} 1" solimp="{d} {d} 0.001"/>
  </default>
  <worldbody>{platform}{struts}
  </worldbody>
  <equality>{equalities}
  </equality>
</mujoco>
)",
                     fmt::arg("name", machine.name), fmt::arg("dt", options.timestep),
                     fmt::arg("g", options.gravity ? -kGravity : 0.0), fmt::arg("tc", time_constant),
                     fmt::arg("d", kImpedance), fmt::arg("stop", kStopDamping),
                     fmt::arg("platform", platform_body(machine.masses, X_WT, options.platform_drag)),
                     fmt::arg("struts", struts),
                     fmt::arg("equalities", closures_and_drives(as_built, end_parts)));
}

}  // namespace understudy::sim
