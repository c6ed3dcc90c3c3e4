#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/hexapod_assembly.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/mujoco/mjcf.h"
#include "sim/plant/mujoco/mujoco_plant_base.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;
using kinematics::kStruts;

class MujocoHexapod final : public MujocoPlantBase {
 public:
  MujocoHexapod(const machine::MachineDescription& machine, const AsBuilt& as_built,
                const MujocoOptions& options)
      : MujocoPlantBase(machine, options), as_built_(as_built), screws_(machine, as_built) {
    reset(home_displacement(machine, as_built));
  }

  void reset(const AxisVector& displacement) override;

  Pose tool_pose() const override {
    const mjtNum* q = data_->qpos + platform_qpos_;
    return make_pose(Quat(q[3], q[4], q[5], q[6]).normalized(), Vec3(q[0], q[1], q[2]));
  }

 protected:
  double hidden_travel(int strut) const override { return screws_.growth(tool_pose(), strut); }

 private:
  std::vector<DrivenJoint> driven_joints() const;

  AsBuilt as_built_;
  ScrewTurning screws_;
  int platform_qpos_ = 0;
};

std::vector<DrivenJoint> MujocoHexapod::driven_joints() const {
  std::vector<DrivenJoint> joints;
  for (int i = 0; i < kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    DrivenJoint joint{strut_part(i, kScrewPart), {}, false};
    if (options_.play && as_built_.nut_play[s] > 0)
      joint.play.push_back(strut_part(i, kNutPlayPart));
    else if (options_.play && as_built_.ball_play[s] > 0)
      joint.play.push_back(strut_part(i, kBallPlayPart));
    joints.push_back(joint);
  }
  return joints;
}

void MujocoHexapod::reset(const AxisVector& displacement) {
  fail_until_reset();
  const Pose X_WT = assemble_hexapod(machine_, as_built_, displacement);
  AxisVector assembled = displacement;  // with what the screws' turning has added
  for (int i = 0; i < kStruts; ++i) assembled[static_cast<std::size_t>(i)] += screws_.growth(X_WT, i);
  load(write_mjcf(machine_, as_built_, X_WT, options_), driven_joints(), assembled);
  platform_qpos_ = model_->jnt_qposadr[find_id(*model_, mjOBJ_JOINT, kPlatformBody)];
  std::vector<std::string> closures;
  for (int i = 0; i < kStruts; ++i) closures.push_back(strut_part(i, kClosurePart));
  set_closures(closures);
  settle(displacement);
}

}  // namespace

std::unique_ptr<Plant> make_mujoco_hexapod(const machine::MachineDescription& machine,
                                           const AsBuilt& as_built, const MujocoOptions& options) {
  return std::make_unique<MujocoHexapod>(machine, as_built, options);
}

}  // namespace understudy::sim
