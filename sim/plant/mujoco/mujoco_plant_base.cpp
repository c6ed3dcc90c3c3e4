#include "sim/plant/mujoco/mujoco_plant_base.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/mujoco/mjcf.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;

// Rotor of a drive that has let go, of the inertia that it carries: light, but no mass matrix is singular.
constexpr double kReleasedRotor = 1e-3;

const char* unit_name(bool angle) { return angle ? "mrad" : "mm"; }

}  // namespace

MujocoPlantBase::MujocoPlantBase(const machine::MachineDescription& machine, const MujocoOptions& options)
    : machine_(machine), options_(options) {
  check_timestep(machine, options.timestep);
}

std::string MujocoPlantBase::engine() const { return fmt::format("mujoco {}", mj_versionString()); }

void MujocoPlantBase::load(const std::string& mjcf, const std::vector<DrivenJoint>& joints,
                           const AxisVector& assembled) {
  failed_ = true;
  model_ = load_model(mjcf);
  data_ = make_data(*model_);
  assembled_ = assembled;
  drives_.clear();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    Drive drive;
    drive.joint = find_id(*model_, mjOBJ_JOINT, joints[i].name);
    drive.qpos = model_->jnt_qposadr[drive.joint];
    drive.dof = model_->jnt_dofadr[drive.joint];
    const machine::Drive& described = machine_.drives[i];
    if (described.stiffness > 0)
      drive.damping = 2 * described.damping_ratio * std::sqrt(described.stiffness * described.rotor());
    else
      drive.equality = find_id(*model_, mjOBJ_EQUALITY, joints[i].name);
    if (!joints[i].play.empty()) {
      drive.play = find_id(*model_, mjOBJ_JOINT, joints[i].play.front());
      drive.play_built = model_->jnt_range[2 * drive.play + 1] - model_->jnt_range[2 * drive.play];
    }
    drives_.push_back(drive);
  }
  failed_ = false;
}

void MujocoPlantBase::set_closures(const std::vector<std::string>& names) {
  closures_ = static_cast<int>(names.size());
  for (int i = 0; i < closures_; ++i)
    if (find_id(*model_, mjOBJ_EQUALITY, names[static_cast<std::size_t>(i)]) != i)
      throw MachineError("engine failure: the constraints are not in the order in which they were written");
}

/// The first rows of constraints are the closures': three each.
double MujocoPlantBase::closure_error() const {
  double largest = 0;
  for (int i = 0; i < closures_; ++i)
    largest = std::max(largest, Eigen::Map<const Vec3>(data_->efc_pos + 3 * i).norm());
  return largest;
}

void MujocoPlantBase::check_closures() const {
  const double closure = closure_error();
  if (!(closure <= kClosureLimit))
    throw MachineError(
        fmt::format("engine failure at {:.4f} s: a closed joint is {:.4f} mm apart, limit {} mm", data_->time,
                    to_mm(closure), to_mm(kClosureLimit)));
}

double MujocoPlantBase::largest_speed() const {
  return Eigen::Map<const Eigen::VectorXd>(data_->qvel, model_->nv).cwiseAbs().maxCoeff();
}

void MujocoPlantBase::settle(const AxisVector& displacement) {
  DriveCommand hold;
  hold.position = displacement;
  double still_since = 0;
  while (data_->time - still_since < kSettledTime && data_->time < kSettleCap) {
    step(hold);
    if (largest_speed() > kSettledSpeed) still_since = data_->time;
  }
  if (largest_speed() > kFloatingSpeed)
    throw MachineError(fmt::format("the machine does not come to rest within {} s", kSettleCap));
  data_->time = 0;
}

AxisVector MujocoPlantBase::displacement() const {
  AxisVector displacement{};
  for (std::size_t i = 0; i < drives_.size(); ++i)
    displacement[i] = assembled_[i] + data_->qpos[drives_[i].qpos] - drives_[i].hidden;
  return displacement;
}

double MujocoPlantBase::force_of(const Drive& drive) const {
  // What turns the rotor does not reach the machine.
  const double rotor = model_->dof_armature[drive.dof] * data_->qacc[drive.dof];
  if (drive.equality < 0) return data_->qfrc_passive[drive.dof] + data_->qfrc_applied[drive.dof] - rotor;
  for (int row = 0; row < data_->ne; ++row)
    if (data_->efc_type[row] == mjCNSTR_EQUALITY && data_->efc_id[row] == drive.equality)
      return data_->efc_force[row] - rotor;
  return -rotor;
}

AxisVector MujocoPlantBase::drive_force() const {
  AxisVector force{};
  for (std::size_t i = 0; i < drives_.size(); ++i) force[i] = force_of(drives_[i]);
  return force;
}

void MujocoPlantBase::let_go(const Drive& drive) {
  if (drive.equality < 0) {
    model_->jnt_stiffness[drive.joint] = 0;
    model_->dof_damping[drive.dof] = 0;
    return;
  }
  model_->eq_active[drive.equality] = 0;
  // The rotor of a rigid drive only kept the mass matrix regular: what falls must not carry it.
  const double rotor = model_->dof_armature[drive.dof];
  const double change = kReleasedRotor * (data_->qM[model_->dof_Madr[drive.dof]] - rotor) - rotor;
  model_->dof_armature[drive.dof] += change;
  model_->dof_M0[drive.dof] += change;  // which the engine uses as it is for a body whose inertia stays
}

void MujocoPlantBase::set_condition(int axis, const AxisCondition& condition) {
  Drive& drive = drives_.at(static_cast<std::size_t>(axis));
  const machine::Drive& described = machine_.drives[static_cast<std::size_t>(axis)];
  if (condition.play_added != drive.condition.play_added) {
    if (drive.play < 0)
      throw MachineError(fmt::format("axis {} is built without play: there is no joint to loosen", axis + 1));
    const double half = 0.5 * (drive.play_built + condition.play_added);
    model_->jnt_range[2 * drive.play] = -half;
    model_->jnt_range[2 * drive.play + 1] = half;
  }
  if (condition.released && drive.following) {
    drive.following = false;
    drive.held = data_->qpos[drive.qpos];
    if (drive.equality < 0) data_->qfrc_applied[drive.dof] = 0;  // the field no longer moves
    if (!described.self_locking) let_go(drive);
  }
  drive.condition = condition;
}

void MujocoPlantBase::command_drives(const DriveCommand& command) {
  // A MuJoCo constraint is a spring and damper towards a fixed target: leading the target by damping over
  // stiffness times the rate removes the lag (docs/reference.md#mujoco).
  const double lead = 2 * kConstraintSteps * options_.timestep * kImpedance;  // [s]
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    Drive& drive = drives_[i];
    if (!drive.following) {
      if (drive.equality >= 0) model_->eq_data[mjNEQDATA * drive.equality] = drive.held;
      continue;
    }
    drive.hidden = drive.condition.growth + hidden_travel(static_cast<int>(i));
    const double target = command.position[i] - assembled_[i] + drive.hidden;
    const double rate = command.velocity[i];
    if (!std::isfinite(target + rate))
      throw MachineError(fmt::format("drive {} is commanded to a position that is not finite at {:.4f} s",
                                     i + 1, data_->time));
    if (drive.equality >= 0) {
      model_->eq_data[mjNEQDATA * drive.equality] = target + lead * rate;
    } else {
      model_->qpos_spring[drive.qpos] = target;
      data_->qfrc_applied[drive.dof] = drive.damping * rate;  // damped against the field, not the frame
    }
  }
}

void MujocoPlantBase::check_state(const DriveCommand& command) const {
  check_closures();
  const AxisVector reached = displacement();
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (!drives_[i].following) continue;
    // The command belongs to the step's beginning, the state to its end.
    const double due = command.position[i] + options_.timestep * command.velocity[i];
    const double error = std::abs(reached[i] - due);
    // An elastic drive loses its step when the rotor leaves its field by a full step: that is a machine's
    // failure as well. A rigid one that catches a cycle after a stall jumps by two.
    const double full_step = machine_.drives[i].lead / std::max(1, machine_.drives[i].steps_per_turn);
    const double limit = std::max(kFollowingLimit, (drives_[i].equality >= 0 ? 2 : 1) * full_step);
    if (!(error <= limit))
      throw MachineError(fmt::format(
          "engine failure at {:.4f} s: drive {} is {:.4f} {} from its command, limit {} {}", data_->time,
          i + 1, 1e3 * error, unit_name(model_->jnt_type[drives_[i].joint] == mjJNT_HINGE), 1e3 * limit,
          unit_name(model_->jnt_type[drives_[i].joint] == mjJNT_HINGE)));
  }
}

void MujocoPlantBase::step(const DriveCommand& command) {
  if (failed_) throw MachineError("engine failure: the plant has failed before and was not reset");
  failed_ = true;
  command_drives(command);
  checked_step(*model_, *data_);
  check_state(command);
  failed_ = false;
}

}  // namespace understudy::sim
