// Open chains in MuJoCo: every axis a driven joint and, behind it, the joint of its play.
#include "core/error.h"
#include "sim/plant/mujoco/mjcf.h"
#include "sim/plant/mujoco/mujoco_plant_base.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;

class MujocoChain final : public MujocoPlantBase {
 public:
  MujocoChain(const machine::MachineDescription& machine, const AsBuilt& as_built,
              const MujocoOptions& options)
      : MujocoPlantBase(machine, options), as_built_(as_built) {
    AxisVector home{};
    const auto& axes = machine.chain().kinematics.home;
    std::copy(axes.begin(), axes.end(), home.begin());
    reset(home);
  }

  void reset(const AxisVector& displacement) override {
    fail_until_reset();
    // A driven joint reads the true position, a drive its displacement: axis_zero is between them.
    AxisVector assembled{};
    for (std::size_t i = 0; i < assembled.size(); ++i) assembled[i] = -as_built_.axis_zero[i];
    load(write_chain_mjcf(machine_, as_built_, options_), driven_joints(), assembled);
    find_positions();
    for (std::size_t i = 0; i < joints_.size(); ++i)
      data_->qpos[joints_[i].driven] = displacement[i] + as_built_.axis_zero[i];
    settle(displacement);
  }

  /// Relative to the work: the joints determine the whole pose.
  Pose tool_pose() const override {
    kinematics::AxisVector axes{};
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      axes[i] = data_->qpos[joints_[i].driven];
      if (joints_[i].play >= 0) axes[i] += data_->qpos[joints_[i].play];
    }
    return machine_.X_WB * kinematics::forward(as_built_.chain, std::span(axes).first(joints_.size()));
  }

 private:
  struct Positions {
    int driven = 0, play = -1;  ///< in qpos
  };

  std::vector<DrivenJoint> driven_joints() {
    std::vector<DrivenJoint> driven;
    for (std::size_t i = 0; i < as_built_.chain.axes.size(); ++i) {
      const kinematics::ChainAxis& axis = as_built_.chain.axes[i];
      DrivenJoint joint{axis.name, {}, axis.angle};
      if (options_.play && as_built_.axis_play[i] > 0) joint.play.push_back(chain_play(axis.name));
      driven.push_back(joint);
    }
    return driven;
  }

  void find_positions() {
    joints_.clear();
    for (const DrivenJoint& joint : driven_joints()) {
      Positions positions;
      positions.driven = model_->jnt_qposadr[find_id(*model_, mjOBJ_JOINT, joint.name)];
      if (!joint.play.empty())
        positions.play = model_->jnt_qposadr[find_id(*model_, mjOBJ_JOINT, joint.play.front())];
      joints_.push_back(positions);
    }
  }

  AsBuilt as_built_;
  std::vector<Positions> joints_;
};

}  // namespace

std::unique_ptr<Plant> make_mujoco_chain(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const MujocoOptions& options) {
  return std::make_unique<MujocoChain>(machine, as_built, options);
}

}  // namespace understudy::sim
