// The MJCF of machines: names that the plants look up, and constants that both sides share.
#pragma once

#include <memory>
#include <string>

#include "core/text/xml.h"
#include "sim/plant/plant.h"

namespace understudy::sim {

/// Constraint impedance d at and beyond zero violation; 0.9999 is the hardest that MuJoCo takes.
constexpr double kImpedance = 0.9999;
/// Time constant of every constraint, in timesteps; MuJoCo is not stable below 2.
constexpr double kConstraintSteps = 2.0;

/// "strut 3 screw": joints, equalities and bodies are named after the strut that they belong to.
std::string strut_part(int strut, const char* part);

constexpr const char* kPlatformBody = "platform";
constexpr const char* kScrewPart = "screw";   ///< slide joint, and the equality that drives it
constexpr const char* kClosurePart = "ball";  ///< equality that closes the loop
constexpr const char* kNutPlayPart = "nut play";
constexpr const char* kBallPlayPart = "ball play z";  ///< along the strut

/// "x y z" and "w x y z".
std::string mjcf_text(const Vec3& v);
std::string mjcf_text(const Mat3& R);

using tinyxml2::XMLElement;

/// A joint of one axis: a slide or a hinge along `axis` in the frame of its body.
struct MjcfJoint {
  std::string name;
  bool hinge = false;
  Vec3 axis = Vec3::UnitZ();
};

/// Slide of a strut's screw, hinge or slide of a chain's axis, without and with an elastic drive.
void add_driven_joint(XMLElement& body, const MjcfJoint& joint, const machine::Drive& drive);
/// The equality that moves it; none for an elastic drive, which is a spring.
void add_drive_equality(XMLElement& equality, const std::string& name, const machine::Drive& drive);

/// Clearance of a joint: [m], [N s/m], [N], or [rad], [N m s/rad], [N m].
struct MjcfPlay {
  double travel = 0;  ///< from stop to stop
  double damping = 0;
  double friction = 0;  ///< 0: none
};
/// A limited joint, with the stops' damping left to the defaults of the model.
void add_play_joint(XMLElement& body, const MjcfJoint& joint, const MjcfPlay& play);

/// The mujoco element with everything about constraints and integration that does not depend on the machine.
XMLElement& add_model(tinyxml2::XMLDocument& document, const std::string& name, const MujocoOptions& options,
                      int rows);

std::string write_hexapod_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built,
                               const Pose& X_WT, const MujocoOptions& options);
/// All axes at 0; gravity along -z of the chain's frame, which is the model's world.
std::string write_chain_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built,
                             const MujocoOptions& options);
/// Of a chain whose tool hangs on rods, assembled at X_WT; the chain's frame is the model's world.
std::string write_rod_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built,
                           const Pose& X_WT, const MujocoOptions& options);
std::string rod_name(const std::string& axis);    ///< of its body, and of the equality that closes it
std::string chain_play(const std::string& axis);  ///< name of the axis' play joint

std::unique_ptr<Plant> make_mujoco_hexapod(const machine::MachineDescription& machine,
                                           const AsBuilt& as_built, const MujocoOptions& options);
std::unique_ptr<Plant> make_mujoco_chain(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const MujocoOptions& options);
std::unique_ptr<Plant> make_mujoco_rods(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                        const MujocoOptions& options);

}  // namespace understudy::sim
