#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/mjcf.h"
#include "sim/plant/mujoco_engine.h"

namespace understudy::sim {
namespace {

using kinematics::kStruts;
using machine::AxisArray;

// A closed joint that has come this far apart, or a screw this far from its command, is an integration that
// no longer follows the machine: a hard stop from full speed opens a joint by a tenth of it.
constexpr double kClosureLimit = 0.1e-3;    // [m]
constexpr double kFollowingLimit = 0.5e-3;  // [m]

constexpr double kSettledSpeed = 1e-6;  // [m/s] and [rad/s], of every joint
constexpr double kSettledTime = 0.02;   // [s] that it has to last
constexpr double kSettleCap = 2.0;      // [s]
// A pose in which a strut carries next to nothing lets the platform float in that strut's play for long: at
// the cap that is rest. Free fall through a play of 0.2 mm ends at 60 mm/s, so beyond this it is not.
constexpr double kFloatingSpeed = 0.06;  // [m/s] and [rad/s]

class MujocoPlant final : public Plant {
 public:
  MujocoPlant(const machine::MachineDescription& machine, const AsBuilt& as_built,
              const MujocoOptions& options)
      : machine_(machine), as_built_(as_built), options_(options) {
    if (!(options.timestep > 0 && std::isfinite(options.timestep)))
      throw InputError(fmt::format("timestep is {} s, not above 0", options.timestep));
    AxisArray start{};
    kinematics::StrutLengths lengths{};
    if (kinematics::inverse(as_built.hexapod, machine.X_BT_home, lengths) != kinematics::Solve::ok)
      throw MachineError("the as-built machine does not reach its home pose");
    for (std::size_t i = 0; i < kStruts; ++i) start[i] = lengths[i] - as_built.hexapod.length_offset[i];
    reset(start);
  }

  std::string engine() const override { return fmt::format("mujoco {}", mj_versionString()); }
  double timestep() const override { return options_.timestep; }
  double time() const override { return data_->time; }

  void reset(const AxisArray& displacement) override;
  void step(const DriveCommand& command) override;

  Pose tool_pose() const override {
    const mjtNum* q = data_->qpos + platform_qpos_;
    return make_pose(Quat(q[3], q[4], q[5], q[6]).normalized(), Vec3(q[0], q[1], q[2]));
  }

  AxisArray displacement() const override {
    AxisArray displacement{};
    for (std::size_t i = 0; i < kStruts; ++i) displacement[i] = assembled_[i] + data_->qpos[screw_qpos_[i]];
    return displacement;
  }

  AxisArray drive_force() const override {
    AxisArray force{};
    for (std::size_t i = 0; i < kStruts; ++i) {
      const int screw = screw_dof_[i];
      // What turns the rotor does not reach the strut.
      force[i] = data_->efc_force[3 * kStruts + i] - model_->dof_armature[screw] * data_->qacc[screw];
    }
    return force;
  }

  double closure_error() const override {
    double largest = 0;
    for (int i = 0; i < kStruts; ++i)
      largest = std::max(largest, Eigen::Map<const Vec3>(data_->efc_pos + 3 * i).norm());
    return largest;
  }

 private:
  Pose assemble(const AxisArray& displacement) const;
  void find_parts();
  void command_drives(const DriveCommand& command);
  void check_state(const DriveCommand& command) const;
  void settle();
  double largest_speed() const;  ///< [m/s] and [rad/s], of all joints

  machine::MachineDescription machine_;
  AsBuilt as_built_;
  MujocoOptions options_;
  ModelPointer model_;
  DataPointer data_;
  AxisArray assembled_{};  ///< [m], drive displacement at which the model's screws read 0
  bool failed_ = false;    ///< the state is no result any more
  int platform_qpos_ = 0;
  std::array<int, kStruts> screw_qpos_{};
  std::array<int, kStruts> screw_dof_{};
  std::array<int, kStruts> drive_equality_{};
};

Pose MujocoPlant::assemble(const AxisArray& displacement) const {
  kinematics::StrutLengths lengths{};
  for (std::size_t i = 0; i < kStruts; ++i) lengths[i] = displacement[i] + as_built_.hexapod.length_offset[i];
  const auto found = kinematics::forward(as_built_.hexapod, lengths, machine_.X_BT_home);
  if (found.status != kinematics::Solve::ok)
    throw MachineError(fmt::format(
        "the loops cannot be closed for strut lengths {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} mm: {}",
        to_mm(lengths[0]), to_mm(lengths[1]), to_mm(lengths[2]), to_mm(lengths[3]), to_mm(lengths[4]),
        to_mm(lengths[5]), kinematics::to_string(found.status)));
  return machine_.X_WB * found.X_BT;
}

void MujocoPlant::find_parts() {
  platform_qpos_ = model_->jnt_qposadr[find_id(*model_, mjOBJ_JOINT, kPlatformBody)];
  for (int i = 0; i < kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const int screw = find_id(*model_, mjOBJ_JOINT, strut_part(i, kScrewPart));
    screw_qpos_[s] = model_->jnt_qposadr[screw];
    screw_dof_[s] = model_->jnt_dofadr[screw];
    drive_equality_[s] = find_id(*model_, mjOBJ_EQUALITY, strut_part(i, kScrewPart));
    // closure_error() and drive_force() read the constraint rows in this order: three a closure, one a drive.
    if (find_id(*model_, mjOBJ_EQUALITY, strut_part(i, kClosurePart)) != i ||
        drive_equality_[s] != kStruts + i)
      throw MachineError("engine failure: the constraints are not in the order in which they were written");
  }
}

void MujocoPlant::reset(const AxisArray& displacement) {
  failed_ = true;
  const Pose X_WT = assemble(displacement);
  model_ = load_model(write_mjcf(machine_, as_built_, X_WT, options_));
  data_ = make_data(*model_);
  assembled_ = displacement;
  find_parts();
  failed_ = false;
  settle();
  data_->time = 0;
}

double MujocoPlant::largest_speed() const {
  return Eigen::Map<const Eigen::VectorXd>(data_->qvel, model_->nv).cwiseAbs().maxCoeff();
}

void MujocoPlant::settle() {
  DriveCommand hold;
  hold.position = assembled_;
  double still_since = 0;
  while (data_->time - still_since < kSettledTime && data_->time < kSettleCap) {
    step(hold);
    if (largest_speed() > kSettledSpeed) still_since = data_->time;
  }
  if (largest_speed() > kFloatingSpeed)
    throw MachineError(fmt::format("the machine does not come to rest within {} s", kSettleCap));
}

void MujocoPlant::command_drives(const DriveCommand& command) {
  // A MuJoCo constraint is a spring and damper towards a fixed target: leading the target by damping over
  // stiffness times the rate removes the lag (reference I).
  const double lead = 2 * kConstraintSteps * options_.timestep * kImpedance;  // [s]
  for (std::size_t i = 0; i < kStruts; ++i) {
    const double target = command.position[i] - assembled_[i] + lead * command.velocity[i];
    if (!std::isfinite(target))
      throw MachineError(fmt::format("drive {} is commanded to a position that is not finite at {:.4f} s",
                                     i + 1, data_->time));
    model_->eq_data[mjNEQDATA * drive_equality_[i]] = target;
  }
}

void MujocoPlant::check_state(const DriveCommand& command) const {
  const double closure = closure_error();
  if (!(closure <= kClosureLimit))
    throw MachineError(
        fmt::format("engine failure at {:.4f} s: a closed joint is {:.4f} mm apart, limit {} mm", data_->time,
                    to_mm(closure), to_mm(kClosureLimit)));
  const AxisArray reached = displacement();
  for (std::size_t i = 0; i < kStruts; ++i) {
    // The command belongs to the step's beginning, the state to its end.
    const double due = command.position[i] + options_.timestep * command.velocity[i];
    const double error = std::abs(reached[i] - due);
    if (!(error <= kFollowingLimit))
      throw MachineError(
          fmt::format("engine failure at {:.4f} s: drive {} is {:.4f} mm from its command, limit {} mm",
                      data_->time, i + 1, to_mm(error), to_mm(kFollowingLimit)));
  }
}

void MujocoPlant::step(const DriveCommand& command) {
  if (failed_) throw MachineError("engine failure: the plant has failed before and was not reset");
  failed_ = true;
  command_drives(command);
  checked_step(*model_, *data_);
  check_state(command);
  failed_ = false;
}

}  // namespace

std::unique_ptr<Plant> make_mujoco_plant(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const MujocoOptions& options) {
  return std::make_unique<MujocoPlant>(machine, as_built, options);
}

}  // namespace understudy::sim
