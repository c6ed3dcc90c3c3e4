#include "machine/file/urdf_corrected.h"

#include <fmt/format.h>

#include "core/file/read_file.h"
#include "core/text/xml.h"
#include "machine/file/roll_pitch_yaw.h"
#include "machine/file/urdf_model.h"

namespace understudy::machine {
namespace {

using kinematics::ChainAxis;

constexpr double kSame = 1e-12;      // [m], [-]: an origin that differs by less is left as it is written
constexpr double kToolStays = 1e-7;  // likewise of a tool that no joint could move

Pose origin_of(const urdf::Joint& joint) {
  const urdf::Pose& p = joint.parent_to_joint_origin_transform;
  return make_pose(Quat(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z),
                   Vec3(p.position.x, p.position.y, p.position.z));
}

/// The smallest motion that takes the frame X, on the drawn axis, to the found one.
Pose carried_to(const ChainAxis& drawn, const ChainAxis& found, const Pose& X) {
  const Mat3 R = Quat::FromTwoVectors(drawn.direction, found.direction).toRotationMatrix();
  Vec3 p = X.translation();
  if (drawn.angle) p = found.point + found.direction * found.direction.dot(p - found.point);
  return make_pose(Mat3(R * X.linear()), p);
}

class Corrector {
 public:
  Corrector(const MachineDescription& machine, const std::filesystem::path& urdf,
            const std::string& tool_link)
      : model_(parse_urdf(urdf)), known_(machine.chain().kinematics), tool_link_(tool_link) {
    const std::string text = read_file(urdf);
    document_.Parse(text.data(), text.size());
  }

  std::string text() {
    find_tool(model_->getRoot(), Pose::Identity());
    // A base that the calibration has moved in O takes the root along; poses are told from it.
    const Pose base = known_.chain.work_axis < 0
                          ? Pose(known_.chain.X_OS_zero * known_.design.X_OS_zero.inverse())
                          : Pose::Identity();
    place(model_->getRoot(), Pose::Identity(), base);
    return to_text(document_);
  }

 private:
  const ChainAxis* axis(const kinematics::Chain& chain, const std::string& name) const {
    for (const ChainAxis& one : chain.axes)
      if (one.name == name) return &one;
    return nullptr;
  }

  /// The frame of the tool link as calibrated: the tool sits on it as drawn.
  void find_tool(const urdf::LinkConstSharedPtr& from, const Pose& drawn) {
    if (from->name == tool_link_)
      X_tool_ = known_.chain.X_OT_zero * known_.design.X_OT_zero.inverse() * drawn;
    for (const auto& joint : from->child_joints)
      find_tool(model_->getLink(joint->child_link_name), drawn * origin_of(*joint));
  }

  /// `drawn` and `found`: the frame of `from` with all axes at 0.
  void place(const urdf::LinkConstSharedPtr& from, const Pose& drawn, const Pose& found) {
    for (const auto& joint : from->child_joints) {
      const urdf::LinkConstSharedPtr link = model_->getLink(joint->child_link_name);
      const Pose origin = origin_of(*joint), X = drawn * origin;
      Pose to = found * origin;
      if (const ChainAxis* line = axis(known_.design, joint->name))
        to = carried_to(*line, *axis(known_.chain, joint->name), X);
      if (link->name == tool_link_) {
        if (joint->type == urdf::Joint::FIXED)
          to = X_tool_;
        else if (!(to.matrix() - X_tool_.matrix()).isZero(kToolStays))
          add_tool(to.inverse() * X_tool_);
      }
      const Pose now = found.inverse() * to;
      if (!(now.matrix() - origin.matrix()).isZero(kSame)) write_origin(joint->name, now);
      place(link, X, to);
    }
  }

  /// Below the tool link, which its axis moves, one where the tool is.
  void add_tool(const Pose& X) {
    auto& robot = *document_.RootElement();
    const std::string name = tool_link_ + "_calibrated";
    add_element(robot, "link", {{"name", name}});
    auto& joint = add_element(robot, "joint", {{"name", name + "_joint"}, {"type", "fixed"}});
    add_element(joint, "parent", {{"link", tool_link_}});
    add_element(joint, "child", {{"link", name}});
    write_origin(name + "_joint", X);
  }

  void write_origin(const std::string& name, const Pose& X) {
    for (auto* joint = document_.RootElement()->FirstChildElement("joint"); joint;
         joint = joint->NextSiblingElement("joint")) {
      if (!joint->Attribute("name", name.c_str())) continue;
      auto* origin = joint->FirstChildElement("origin");
      if (origin == nullptr) origin = &add_element(*joint, "origin");
      const Vec3 p = X.translation(), turn = roll_pitch_yaw(X.linear());
      origin->SetAttribute("xyz", fmt::format("{} {} {}", p.x(), p.y(), p.z()).c_str());
      origin->SetAttribute("rpy", fmt::format("{} {} {}", turn.x(), turn.y(), turn.z()).c_str());
    }
  }

  urdf::ModelInterfaceSharedPtr model_;
  const kinematics::ChainDescription& known_;
  std::string tool_link_;
  tinyxml2::XMLDocument document_;
  Pose X_tool_ = Pose::Identity();
};

}  // namespace

std::string corrected_urdf(const MachineDescription& machine, const std::filesystem::path& urdf,
                           const std::string& tool_link) {
  if (machine.chain().kinematics.design.axes.empty()) return read_file(urdf);
  return Corrector(machine, urdf, tool_link).text();
}

}  // namespace understudy::machine
