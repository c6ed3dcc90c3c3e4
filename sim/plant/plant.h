// A machine's mechanics as an engine integrates them. Three plants stand behind this interface.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "kinematics/mechanism.h"
#include "machine/description.h"
#include "machine/port.h"
#include "sim/as_built/as_built.h"

namespace understudy::sim {

using kinematics::AxisVector;
using kinematics::PerAxis;
using kinematics::PerStrut;

/// What a drive is asked for during one step, at the step's beginning: motor side, as-built zero.
struct DriveCommand {
  kinematics::AxisVector position{};  ///< [m or rad]; hexapod: drive displacement
  kinematics::AxisVector velocity{};  ///< [m/s or rad/s], feed-forward
};

/// What has happened to an axis since it was built.
struct AxisCondition {
  double play_added = 0;  ///< [m] or [rad], more total free travel: a nut or gear that has come loose
  double growth = 0;  ///< [m] or [rad], true position beyond what the drive reads: a strut that has warmed
  bool released = false;  ///< the motor has no torque: a self-locking drive stays, any other follows its load
};

class Plant {
 public:
  virtual ~Plant() = default;

  virtual std::string engine() const = 0;  ///< "mujoco 2.2.2"
  virtual double timestep() const = 0;     ///< [s]
  virtual double time() const = 0;         ///< [s]

  /// Assembles the machine at rest for these displacements and lets it settle under gravity; time is 0.
  /// Throws MachineError when the loops cannot be closed.
  virtual void reset(const kinematics::AxisVector& displacement) = 0;
  /// One timestep. Throws MachineError when the integration diverges: a result is never made up.
  virtual void step(const DriveCommand& command) = 0;
  /// From the next step on. A change of growth or play may be stepwise; the state stays continuous. Throws
  /// MachineError for what an engine cannot play.
  virtual void set_condition(int axis, const AxisCondition& condition) = 0;

  virtual Pose tool_pose() const = 0;                       ///< X_WT, true
  virtual kinematics::AxisVector displacement() const = 0;  ///< motor side, as encoders would see it
  /// [N] or [N m], what each drive carried during the last step; hexapod: along the screw, positive where
  /// the strut pushes the platform, negative where it pulls.
  virtual kinematics::AxisVector drive_force() const = 0;
  /// [m], largest distance between the two ends of a closed joint, play not counted, at the beginning of the
  /// last step.
  virtual double closure_error() const = 0;
};

struct MujocoOptions {
  double timestep = 0.5e-3;  ///< [s]
  bool gravity = true;
  bool play = true;  ///< false: the clearances are left out
  /// Ball clearance in all three directions instead of along the strut only. A strut swings freely about its
  /// universal joint, so the two directions across it do not move the tool; they cost twelve joints.
  bool play_across_struts = false;
  double platform_drag = 0;  ///< [N s/m] and [N m s/rad], of cables and filament on the platform
};
/// All machines.
std::unique_ptr<Plant> make_mujoco_plant(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const MujocoOptions& options = {});

struct BulletOptions {
  double timestep = 0.5e-3;  ///< [s]
  bool gravity = true;
  bool play = true;
  int iterations = 200;  ///< changes of the set of stops in touch, at most, in a step's direct solution
};
/// Hexapods and serial arms; built from the description, not from the MJCF. Throws InputError for others.
std::unique_ptr<Plant> make_bullet_plant(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const BulletOptions& options = {});

struct QuasistaticOptions {
  double timestep = 2e-3;  ///< [s], between poses: path resolution, not stability
  bool gravity = true;
  bool inertia = true;  ///< accelerations of the command load the drives
  bool play = true;
  Vec3 nozzle_force_T{0, 0, 0};  ///< [N], on the tip
};
/// Tool pose from axis displacements and as-built geometry, each play pushed to the side that its force
/// chooses; all machines. It does not integrate: what swings or bounces is not seen.
std::unique_ptr<Plant> make_quasistatic_plant(const machine::MachineDescription& machine,
                                              const AsBuilt& as_built,
                                              const QuasistaticOptions& options = {});

/// The MJCF of the as-built machine, assembled at X_WT; what `understudy export mjcf` writes.
std::string write_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built, const Pose& X_WT,
                       const MujocoOptions& options = {});

}  // namespace understudy::sim
