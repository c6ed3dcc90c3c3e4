#include "sim/plant/joint_constants.h"
#include "sim/plant/mujoco/mjcf.h"

#include <fmt/format.h>

#include "core/units.h"
#include "sim/plant/strut_chain.h"

namespace understudy::sim {
namespace {

std::string number(double value) { return fmt::format("{}", value); }

void add_inertial(XMLElement& body, double mass, const Vec3& centre) {
  const double moment = cube_moment(mass);
  add_element(body, "inertial",
              {{"pos", mjcf_text(centre)},
               {"mass", number(mass)},
               {"diaginertia", fmt::format("{0} {0} {0}", moment)}});
}

struct Clearance {
  double nut = 0;       ///< [m], 0: no joint
  double ball = 0;      ///< [m]
  double friction = 0;  ///< [N], along the strut
  bool across = false;
};

void add_play_slide(XMLElement& body, const std::string& name, const Vec3& axis, double travel,
                    double friction = 0) {
  add_play_joint(body, {name, false, axis}, {travel, kPlayDamping, friction});
}

/// The ball joint's clearance: a slide along the line between the joints, which carries the force, and
/// perhaps two across it.
void add_rod_end(XMLElement& nut, int strut, const Mat3& R_NE, double mass, const Clearance& play) {
  XMLElement& end =
      add_element(nut, "body", {{"name", strut_part(strut, "rod end")}, {"quat", mjcf_text(R_NE)}});
  add_inertial(end, mass, Vec3::Zero());
  if (play.across) {
    add_play_slide(end, strut_part(strut, "ball play x"), Vec3::UnitX(), play.ball);
    add_play_slide(end, strut_part(strut, "ball play y"), Vec3::UnitY(), play.ball);
  }
  add_play_slide(end, strut_part(strut, kBallPlayPart), Vec3::UnitZ(), play.ball, play.friction);
}

void add_universal_hinge(XMLElement& motor, const std::string& name, const Vec3& axis) {
  add_element(
      motor, "joint",
      {{"name", name}, {"type", "hinge"}, {"axis", mjcf_text(axis)}, {"damping", number(kHingeDamping)}});
}

/// Motor frame M: origin in the universal joint, x along the offset, z along the screw.
void add_strut(XMLElement& world, int strut, const StrutChain& chain, const machine::Masses& masses,
               const machine::Drive& drive, const Clearance& play) {
  Mat3 R_WM;
  R_WM << chain.offset_W, chain.screw_W.cross(chain.offset_W), chain.screw_W;
  const Vec3 d_M = R_WM.transpose() * (chain.ball_W - chain.base_W);
  const double dev = d_M.x();
  const double rod_end_mass = play.ball > 0 ? kRodEndShare * masses.nut : 0.0;

  XMLElement& motor = add_element(
      world, "body",
      {{"name", strut_part(strut, "motor")}, {"pos", mjcf_text(chain.base_W)}, {"quat", mjcf_text(R_WM)}});
  add_inertial(motor, masses.motor, Vec3(dev, 0, 0));
  add_universal_hinge(motor, strut_part(strut, "alpha"), R_WM.transpose() * chain.tangent_W);
  add_universal_hinge(motor, strut_part(strut, "beta"), Vec3::UnitX());

  XMLElement& nut = add_element(motor, "body", {{"name", strut_part(strut, "nut")}, {"pos", mjcf_text(d_M)}});
  add_inertial(nut, masses.nut - rod_end_mass, Vec3::Zero());
  add_driven_joint(nut, {strut_part(strut, kScrewPart), false, Vec3::UnitZ()}, drive);
  if (play.nut > 0)
    add_play_slide(nut, strut_part(strut, kNutPlayPart), Vec3::UnitZ(), play.nut, play.friction);
  if (play.ball > 0) {
    const Vec3 d_axis = d_M.normalized();
    Mat3 R_ME;
    R_ME << Vec3::UnitY().cross(d_axis), Vec3::UnitY(), d_axis;
    add_rod_end(nut, strut, R_ME, rod_end_mass, play);
  }
}

void add_platform(XMLElement& world, const machine::Masses& masses, const Pose& X_WT, double drag) {
  XMLElement& body = add_element(world, "body",
                                 {{"name", kPlatformBody},
                                  {"pos", mjcf_text(Vec3(X_WT.translation()))},
                                  {"quat", mjcf_text(Mat3(X_WT.linear()))}});
  add_element(body, "joint", {{"name", "platform"}, {"type", "free"}, {"damping", number(drag)}});
  add_element(body, "inertial",
              {{"pos", mjcf_text(masses.platform_centre_T)},
               {"mass", number(masses.platform)},
               {"diaginertia", mjcf_text(masses.platform_inertia)}});
  add_element(body, "site", {{"name", "tip"}, {"size", "0.0005"}});
}

void add_closure(XMLElement& equality, int strut, const char* end_part, const Vec3& anchor_T) {
  add_element(equality, "connect",
              {{"name", strut_part(strut, kClosurePart)},
               {"body1", kPlatformBody},
               {"body2", strut_part(strut, end_part)},
               {"anchor", mjcf_text(anchor_T)}});
}

}  // namespace

std::string write_hexapod_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built,
                               const Pose& X_WT, const MujocoOptions& options) {
  tinyxml2::XMLDocument document;
  // Closures and drives give 24 rows, play limits at most 24 more, friction 12.
  XMLElement& model = add_model(document, machine.name, options, 100);
  XMLElement& world = add_element(model, "worldbody");
  XMLElement& equality = add_element(model, "equality");
  add_platform(world, machine.hexapod().masses, X_WT, options.platform_drag);
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    Clearance play;
    if (options.play)
      play = {as_built.nut_play[s], as_built.ball_play[s], machine.hexapod().play.friction,
              options.play_across_struts};
    const StrutChain chain =
        assemble_strut(as_built.hexapod, machine.hexapod().joints, machine.X_WB, X_WT, i);
    add_strut(world, i, chain, machine.hexapod().masses, machine.drives[s], play);
    add_closure(equality, i, play.ball > 0 ? "rod end" : "nut", as_built.hexapod.platform_joint[s]);
  }
  for (int i = 0; i < kinematics::kStruts; ++i)
    add_drive_equality(equality, strut_part(i, kScrewPart), machine.drives[static_cast<std::size_t>(i)]);
  return to_text(document);
}

}  // namespace understudy::sim
