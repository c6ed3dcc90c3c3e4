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

void add_inertial(XMLElement& body, const machine::Link& link, const Vec3& origin) {
  const Mat3& I = link.inertia_O;
  add_element(body, "inertial",
              {{"pos", mjcf_text(Vec3(link.centre_O - origin))},
               {"mass", fmt::format("{}", link.mass)},
               {"fullinertia",
                fmt::format("{} {} {} {} {} {}", I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2))}});
}

class ChainWriter {
 public:
  ChainWriter(const machine::MachineDescription& machine, const AsBuilt& as_built,
              const MujocoOptions& options)
      : machine_(machine), model_(machine.chain()), built_(as_built), options_(options) {}

  std::string write() const {
    tinyxml2::XMLDocument document;
    // A drive gives one row, the limits of its play two, friction one.
    XMLElement& mujoco = add_model(document, machine_.name, options_, 4 * built_.chain.size() + 10);
    XMLElement& world = add_element(mujoco, "worldbody");
    add_ends(world, -1);
    add_bodies(world, -1);
    XMLElement& equality = add_element(mujoco, "equality");
    for (std::size_t i = 0; i < built_.chain.axes.size(); ++i)
      add_drive_equality(equality, built_.chain.axes[i].name, machine_.drives[i]);
    return to_text(document);
  }

 private:
  /// Those that hang on `parent`, with all that they carry.
  void add_bodies(XMLElement& element, int parent) const {
    for (int i = 0; i < built_.chain.size(); ++i)
      if (built_.chain.axes[static_cast<std::size_t>(i)].parent == parent) add_body(element, i);
  }

  void add_body(XMLElement& parent, int axis) const {
    const auto i = static_cast<std::size_t>(axis);
    const kinematics::ChainAxis& a = built_.chain.axes[i];
    XMLElement& body = add_element(
        parent, "body",
        {{"name", a.name}, {"pos", mjcf_text(Vec3(a.point - body_origin(built_.chain, a.parent)))}});
    add_inertial(body, model_.links[i], a.point);
    add_driven_joint(body, {a.name, a.angle, a.direction}, machine_.drives[i]);
    if (options_.play && built_.axis_play[i] > 0) {
      // Grease at the machine's length scale.
      const double scale = a.angle ? model_.kinematics.length_scale : 1.0;
      add_play_joint(body, {chain_play(a.name), a.angle, a.direction},
                     {built_.axis_play[i], kPlayDamping * scale * scale, model_.friction[i]});
    }
    add_ends(body, axis);
    add_bodies(body, axis);
  }

  /// Sites where the tool and the work are.
  void add_ends(XMLElement& body, int axis) const {
    const auto site = [&](const char* name, const Pose& X_O) {
      add_element(body, "site",
                  {{"name", name},
                   {"size", "0.0005"},
                   {"pos", mjcf_text(Vec3(X_O.translation() - body_origin(built_.chain, axis)))},
                   {"quat", mjcf_text(Mat3(X_O.linear()))}});
    };
    if (axis == built_.chain.tool_axis) site("tip", built_.chain.X_OT_zero);
    if (axis == built_.chain.work_axis) site("work", built_.chain.X_OS_zero);
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
