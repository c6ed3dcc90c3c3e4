#include "sim/plant/joint_constants.h"
#include "sim/plant/mujoco/mjcf.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "core/units.h"
#include "sim/plant/strut_chain.h"

namespace understudy::sim {
namespace {

std::string inertial(double mass, const Vec3& centre) {
  const double moment = cube_moment(mass);
  return fmt::format(R"(<inertial pos="{}" mass="{}" diaginertia="{} {} {}"/>)", mjcf_text(centre), mass,
                     moment, moment, moment);
}

struct Clearance {
  double nut = 0;       ///< [m], 0: no joint
  double ball = 0;      ///< [m]
  double friction = 0;  ///< [N], along the strut
  bool across = false;
};

std::string play_slide(const std::string& name, const Vec3& axis, double travel, double friction = 0) {
  return play_joint(name, "slide", axis, travel, kPlayDamping, friction);
}

/// The ball joint's clearance: a slide along the line between the joints, which carries the force, and
/// perhaps two across it.
std::string rod_end(int strut, const Mat3& R_NE, double mass, const Clearance& play) {
  std::string slides;
  if (play.across)
    slides = play_slide(strut_part(strut, "ball play x"), Vec3::UnitX(), play.ball) +
             play_slide(strut_part(strut, "ball play y"), Vec3::UnitY(), play.ball);
  slides += play_slide(strut_part(strut, kBallPlayPart), Vec3::UnitZ(), play.ball, play.friction);
  return fmt::format(R"(
        <body name="{}" quat="{}">
          {}{}
        </body>)",
                     strut_part(strut, "rod end"), mjcf_text(R_NE), inertial(mass, Vec3::Zero()), slides);
}

/// Motor frame: origin in the universal joint, x along the offset, z along the screw.
std::string strut_bodies(int strut, const StrutChain& chain, const machine::Masses& masses,
                         const machine::Drive& drive, const Clearance& play) {
  Mat3 R_WM;
  R_WM << chain.offset_W, chain.screw_W.cross(chain.offset_W), chain.screw_W;
  const Vec3 d_M = R_WM.transpose() * (chain.ball_W - chain.base_W);
  const double dev = d_M.x();
  const double rod_end_mass = play.ball > 0 ? kRodEndShare * masses.nut : 0.0;

  std::string nut_play, end;
  if (play.nut > 0)
    nut_play = play_slide(strut_part(strut, kNutPlayPart), Vec3::UnitZ(), play.nut, play.friction);
  if (play.ball > 0) {
    const Vec3 d_axis = d_M.normalized();
    Mat3 R_ME;
    R_ME << Vec3::UnitY().cross(d_axis), Vec3::UnitY(), d_axis;
    end = rod_end(strut, R_ME, rod_end_mass, play);
  }
  return fmt::format(
      R"(
    <body name="{motor}" pos="{base}" quat="{R_WM}">
      {motor_inertia}
      <joint name="{alpha}" type="hinge" axis="{tangent}" damping="{hinge_damping}"/>
      <joint name="{beta}" type="hinge" axis="1 0 0" damping="{hinge_damping}"/>
      <body name="{nut}" pos="{ball}">
        {nut_inertia}
        {screw}{nut_play}{end}
      </body>
    </body>)",
      fmt::arg("motor", strut_part(strut, "motor")), fmt::arg("base", mjcf_text(chain.base_W)),
      fmt::arg("R_WM", mjcf_text(R_WM)), fmt::arg("motor_inertia", inertial(masses.motor, Vec3(dev, 0, 0))),
      fmt::arg("alpha", strut_part(strut, "alpha")),
      fmt::arg("tangent", mjcf_text(Vec3(R_WM.transpose() * chain.tangent_W))),
      fmt::arg("hinge_damping", kHingeDamping), fmt::arg("beta", strut_part(strut, "beta")),
      fmt::arg("nut", strut_part(strut, "nut")), fmt::arg("ball", mjcf_text(d_M)),
      fmt::arg("nut_inertia", inertial(masses.nut - rod_end_mass, Vec3::Zero())),
      fmt::arg("screw", driven_joint(strut_part(strut, kScrewPart), "slide", Vec3::UnitZ(), drive)),
      fmt::arg("nut_play", nut_play), fmt::arg("end", end));
}

std::string platform_body(const machine::Masses& masses, const Pose& X_WT, double drag) {
  return fmt::format(R"(
    <body name="{}" pos="{}" quat="{}">
      <joint name="platform" type="free" damping="{}"/>
      <inertial pos="{}" mass="{}" diaginertia="{}"/>
      <site name="tip" size="0.0005"/>
    </body>)",
                     kPlatformBody, mjcf_text(Vec3(X_WT.translation())), mjcf_text(Mat3(X_WT.linear())), drag,
                     mjcf_text(masses.platform_centre_T), masses.platform,
                     mjcf_text(masses.platform_inertia));
}

std::string closures_and_drives(const AsBuilt& as_built, std::span<const machine::Drive> drives,
                                const std::array<const char*, 6>& end_parts) {
  std::string xml;
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    xml += fmt::format(R"(
    <connect name="{}" body1="{}" body2="{}" anchor="{}"/>)",
                       strut_part(i, kClosurePart), kPlatformBody, strut_part(i, end_parts[s]),
                       mjcf_text(as_built.hexapod.platform_joint[s]));
  }
  for (int i = 0; i < kinematics::kStruts; ++i)
    xml += drive_equality(strut_part(i, kScrewPart), drives[static_cast<std::size_t>(i)]);
  return xml;
}

}  // namespace

std::string write_hexapod_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built,
                               const Pose& X_WT, const MujocoOptions& options) {
  std::string struts;
  std::array<const char*, 6> end_parts{};
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    Clearance play;
    if (options.play)
      play = {as_built.nut_play[s], as_built.ball_play[s], machine.hexapod().play.friction,
              options.play_across_struts};
    const StrutChain chain =
        assemble_strut(as_built.hexapod, machine.hexapod().joints, machine.X_WB, X_WT, i);
    struts += strut_bodies(i, chain, machine.hexapod().masses, machine.drives[s], play);
    end_parts[s] = play.ball > 0 ? "rod end" : "nut";
  }
  // Closures and drives give 24 rows, play limits at most 24 more, friction 12.
  return fmt::format(
      R"(<mujoco model="{name}">{settings}
  <worldbody>{platform}{struts}
  </worldbody>
  <equality>{equalities}
  </equality>
</mujoco>
)",
      fmt::arg("name", machine.name), fmt::arg("settings", mjcf_settings(options, 100)),
      fmt::arg("platform", platform_body(machine.hexapod().masses, X_WT, options.platform_drag)),
      fmt::arg("struts", struts),
      fmt::arg("equalities", closures_and_drives(as_built, machine.drives, end_parts)));
}

}  // namespace understudy::sim
