#include <fmt/format.h>

#include "core/units.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/mujoco/mjcf.h"

namespace understudy::sim {
namespace {

/// Frame of an axis' body at zero: along O's axes, its origin on the axis.
Vec3 body_origin(const kinematics::Chain& chain, int axis) {
  return axis < 0 ? Vec3(0, 0, 0) : chain.axes[static_cast<std::size_t>(axis)].point;
}

std::string inertial(const machine::Link& link, const Vec3& origin) {
  const Mat3& I = link.inertia_O;
  return fmt::format(R"(<inertial pos="{}" mass="{}" fullinertia="{} {} {} {} {} {}"/>)",
                     mjcf_text(Vec3(link.centre_O - origin)), link.mass, I(0, 0), I(1, 1), I(2, 2), I(0, 1),
                     I(0, 2), I(1, 2));
}

class ChainWriter {
 public:
  ChainWriter(const machine::MachineDescription& machine, const AsBuilt& as_built,
              const MujocoOptions& options)
      : machine_(machine), model_(machine.chain()), built_(as_built), options_(options) {}

  std::string write() const {
    std::string equalities;
    for (std::size_t i = 0; i < built_.chain.axes.size(); ++i)
      equalities += drive_equality(built_.chain.axes[i].name, machine_.drives[i]);
    // A drive gives one row, the limits of its play two, friction one.
    return fmt::format(R"(<mujoco model="{}">{}
  <worldbody>{}{}
  </worldbody>
  <equality>{}
  </equality>
</mujoco>
)",
                       machine_.name, mjcf_settings(options_, 4 * built_.chain.size() + 10), ends(-1),
                       carried_by(-1), equalities);
  }

 private:
  std::string carried_by(int parent) const {
    std::string bodies;
    for (int i = 0; i < built_.chain.size(); ++i)
      if (built_.chain.axes[static_cast<std::size_t>(i)].parent == parent) bodies += body(i);
    return bodies;
  }

  std::string body(int axis) const {
    const auto i = static_cast<std::size_t>(axis);
    const kinematics::ChainAxis& a = built_.chain.axes[i];
    const std::string type = a.angle ? "hinge" : "slide";
    std::string play;
    if (options_.play && built_.axis_play[i] > 0) {
      // Grease at the machine's length scale.
      const double scale = a.angle ? model_.kinematics.length_scale : 1.0;
      play = play_joint(chain_play(a.name), type, a.direction, built_.axis_play[i],
                        kPlayDamping * scale * scale, model_.friction[i]);
    }
    return fmt::format(R"(
    <body name="{}" pos="{}">
      {}
      {}{}{}{}
    </body>)",
                       a.name, mjcf_text(Vec3(a.point - body_origin(built_.chain, a.parent))),
                       inertial(model_.links[i], a.point),
                       driven_joint(a.name, type, a.direction, machine_.drives[i]), play, ends(axis),
                       carried_by(axis));
  }

  /// Sites where the tool and the work are.
  std::string ends(int axis) const {
    std::string sites;
    const auto site = [&](const char* name, const Pose& X_O) {
      sites += fmt::format(R"(
      <site name="{}" size="0.0005" pos="{}" quat="{}"/>)",
                           name, mjcf_text(Vec3(X_O.translation() - body_origin(built_.chain, axis))),
                           mjcf_text(Mat3(X_O.linear())));
    };
    if (axis == built_.chain.tool_axis) site("tip", built_.chain.X_OT_zero);
    if (axis == built_.chain.work_axis) site("work", built_.chain.X_OS_zero);
    return sites;
  }

  const machine::MachineDescription& machine_;
  const machine::ChainModel& model_;
  const AsBuilt& built_;
  const MujocoOptions& options_;
};

}  // namespace

std::string chain_play(const std::string& axis) { return axis + " play"; }

std::string write_chain_mjcf(const machine::MachineDescription& machine, const AsBuilt& as_built,
                             const MujocoOptions& options) {
  return ChainWriter(machine, as_built, options).write();
}

}  // namespace understudy::sim
