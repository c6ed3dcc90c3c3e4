// Open chains in Bullet: one fixed-base tree, a joint an axis, held by its drive within its play.
#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/bullet/bullet_plant_base.h"
#include "sim/plant/bullet/bullet_plants.h"
#include "sim/plant/joint_constants.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;

class BulletChain final : public BulletPlantBase {
 public:
  BulletChain(const machine::MachineDescription& machine, const AsBuilt& as_built,
              const BulletOptions& options)
      : BulletPlantBase(machine, options), as_built_(as_built) {
    // The work stands in S, which is the machine's base B; O is upright.
    X_WO_ = machine.X_WB * as_built.chain.X_OS_zero.inverse();
    set_gravity(X_WO_.linear() * Vec3(0, 0, options.gravity ? -kGravity : 0));
    AxisVector home{};
    const auto& axes = machine.chain().kinematics.home;
    std::copy(axes.begin(), axes.end(), home.begin());
    reset(home);
  }

  void reset(const AxisVector& displacement) override;

  /// By the engine's own chain of frames.
  Pose tool_pose() const override { return link_pose(*tree_, as_built_.chain.tool_axis) * X_LT_; }

 private:
  AsBuilt as_built_;
  Pose X_WO_ = Pose::Identity();
  Pose X_LT_ = Pose::Identity();  ///< tool from the link that carries it
  btMultiBody* tree_ = nullptr;
};

void BulletChain::reset(const AxisVector& displacement) {
  clear();
  const machine::ChainModel& model = machine_.chain();
  std::vector<BulletLink> links;
  for (std::size_t i = 0; i < as_built_.chain.axes.size(); ++i) {
    const kinematics::ChainAxis& axis = as_built_.chain.axes[i];
    const machine::Link& link = model.links[i];
    links.push_back(
        {axis.parent, axis.angle, axis.direction, axis.point, link.mass, link.centre_O, link.inertia_O});
  }
  tree_ = &add_body(make_tree(links, X_WO_));
  X_LT_ = link_pose(*tree_, as_built_.chain.tool_axis).inverse() * X_WO_ * as_built_.chain.X_OT_zero;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const double scale = links[i].angle ? model.kinematics.length_scale : 1.0;
    const double zero = as_built_.axis_zero[i], play = options_.play ? as_built_.axis_play[i] : 0.0;
    tree_->setJointPos(static_cast<int>(i), displacement[i] + zero);
    add_drive(*tree_, static_cast<int>(i), displacement[i], zero,
              {play, kPlayDamping * scale * scale, model.friction[i]});
  }
  settle(displacement);
}

}  // namespace

std::unique_ptr<Plant> make_bullet_chain(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const BulletOptions& options) {
  return std::make_unique<BulletChain>(machine, as_built, options);
}

std::unique_ptr<Plant> make_bullet_plant(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                         const BulletOptions& options) {
  if (!machine.is_chain()) return make_bullet_hexapod(machine, as_built, options);
  if (!as_built.chain.rods.empty())
    throw InputError(
        fmt::format("{}: bullet plays hexapods and arms; here rods carry the tool: use mujoco or quasistatic",
                    machine.name));
  if (as_built.chain.work_axis >= 0)
    throw InputError(fmt::format(
        "{}: bullet plays hexapods and arms; here axis '{}' carries the work: use mujoco or quasistatic",
        machine.name, as_built.chain.axes[static_cast<std::size_t>(as_built.chain.work_axis)].name));
  return make_bullet_chain(machine, as_built, options);
}

}  // namespace understudy::sim
