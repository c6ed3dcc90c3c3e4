// A tool on rods in MuJoCo: three driven slides, and the closures of the rods at the tool.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "kinematics/chain/rods.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/mujoco/mjcf.h"
#include "sim/plant/mujoco/mujoco_plant_base.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;
using kinematics::kRods;

class MujocoRods final : public MujocoPlantBase {
 public:
  MujocoRods(const machine::MachineDescription& machine, const AsBuilt& as_built,
             const MujocoOptions& options)
      : MujocoPlantBase(machine, options),
        as_built_(as_built),
        X_WO_(machine.X_WB * as_built.chain.X_OS_zero.inverse()) {
    reset(machine.chain().kinematics.home);
  }

  void reset(const AxisVector& displacement) override;

  Pose tool_pose() const override {
    const Vec3 moved = Eigen::Map<const Vec3>(data_->qpos + carried_qpos_);
    return X_WO_ * (Eigen::Translation3d(meet_O_ + moved) * as_built_.chain.X_OT_zero);
  }

 private:
  AsBuilt as_built_;
  Pose X_WO_;
  Vec3 meet_O_ = Vec3::Zero();  ///< where the rods met when the model was assembled
  int carried_qpos_ = 0;        ///< x, followed by y and z
};

void MujocoRods::reset(const AxisVector& displacement) {
  fail_until_reset();
  const kinematics::Chain& chain = as_built_.chain;
  AxisVector slides = displacement;
  for (std::size_t i = 0; i < kRods; ++i) slides[i] += as_built_.axis_zero[i];
  if (kinematics::rods_meet(chain, slides, meet_O_) != kinematics::SolveStatus::ok)
    throw MachineError(fmt::format("the rods cannot be closed for axis positions {:.3f} {:.3f} {:.3f} mm",
                                   to_mm(slides[0]), to_mm(slides[1]), to_mm(slides[2])));
  const Pose X_WT = X_WO_ * (Eigen::Translation3d(meet_O_) * chain.X_OT_zero);
  std::vector<DrivenJoint> joints;
  std::vector<std::string> closures;
  for (std::size_t i = 0; i < kRods; ++i) {
    DrivenJoint joint{chain.axes[i].name, {}, false};
    if (options_.play && as_built_.axis_play[i] > 0) joint.play.push_back(chain_play(chain.axes[i].name));
    joints.push_back(joint);
    closures.push_back(rod_name(chain.axes[i].name));
  }
  load(write_rod_mjcf(machine_, as_built_, X_WT, options_), joints, displacement);
  carried_qpos_ = model_->jnt_qposadr[find_id(*model_, mjOBJ_JOINT, fmt::format("{} x", kPlatformBody))];
  set_closures(closures);
  settle(displacement);
}

}  // namespace

std::unique_ptr<Plant> make_mujoco_rods(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                        const MujocoOptions& options) {
  return std::make_unique<MujocoRods>(machine, as_built, options);
}

}  // namespace understudy::sim
