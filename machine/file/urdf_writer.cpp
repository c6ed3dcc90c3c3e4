#include "machine/file/urdf_writer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/text/xml.h"
#include "machine/file/roll_pitch_yaw.h"

namespace understudy::machine {
namespace {

using kinematics::Chain;
using kinematics::ChainAxis;
using tinyxml2::XMLElement;

constexpr double kNoEnd = 1e6;

std::string number(double value) { return fmt::format("{}", value); }

std::string numbers(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string link_name(const Chain& chain, int axis) {
  return axis < 0 ? "frame" : chain.axes[axis].name + "_link";
}

/// Where the link of an axis has its origin. A slide's point means nothing: it stays where its parent is.
Vec3 link_origin(const Chain& chain, int axis) {
  for (int i = axis; i >= 0; i = chain.axes[i].parent) {
    const ChainAxis& a = chain.axes[i];
    if (a.angle) return a.point;
  }
  return Vec3::Zero();
}

/// All links of one axis as one body.
LinkMass joined(std::span<const LinkMass> links, int axis) {
  LinkMass body;
  for (const LinkMass& link : links) {
    if (link.axis != axis) continue;
    body.mass += link.mass;
    body.centre_O += link.mass * link.centre_O;
  }
  if (body.mass <= 0) return body;
  body.centre_O /= body.mass;
  for (const LinkMass& link : links) {
    if (link.axis != axis) continue;
    const Vec3 r = link.centre_O - body.centre_O;
    body.inertia_O += link.inertia_O + link.mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  return body;
}

void add_link(XMLElement& robot, const Chain& chain, int axis, std::span<const LinkMass> links) {
  const LinkMass body = joined(links, axis);
  XMLElement& link = add_element(robot, "link", {{"name", link_name(chain, axis)}});
  if (body.mass <= 0) return;
  const Mat3& I = body.inertia_O;
  XMLElement& inertial = add_element(link, "inertial");
  add_element(inertial, "origin", {{"xyz", numbers(body.centre_O - link_origin(chain, axis))}});
  add_element(inertial, "mass", {{"value", number(body.mass)}});
  add_element(inertial, "inertia",
              {{"ixx", number(I(0, 0))},
               {"ixy", number(I(0, 1))},
               {"ixz", number(I(0, 2))},
               {"iyy", number(I(1, 1))},
               {"iyz", number(I(1, 2))},
               {"izz", number(I(2, 2))}});
}

XMLElement& add_joint(XMLElement& robot, const std::string& name, const char* type) {
  return add_element(robot, "joint", {{"name", name}, {"type", type}});
}

void add_axis_joint(XMLElement& robot, const Chain& chain, int axis, const AxisDrive& drive) {
  const ChainAxis& a = chain.axes[axis];
  const auto bounded = [](double v) { return number(std::clamp(v, -kNoEnd, kNoEnd)); };
  const bool endless = a.angle && std::isinf(a.lower) && std::isinf(a.upper);
  XMLElement& joint = add_joint(robot, a.name, endless ? "continuous" : (a.angle ? "revolute" : "prismatic"));
  add_element(joint, "parent", {{"link", link_name(chain, a.parent)}});
  add_element(joint, "child", {{"link", link_name(chain, axis)}});
  add_element(joint, "origin",
              {{"xyz", numbers(link_origin(chain, axis) - link_origin(chain, a.parent))}, {"rpy", "0 0 0"}});
  add_element(joint, "axis", {{"xyz", numbers(a.direction)}});
  XMLElement& limit = add_element(joint, "limit");
  if (!endless) {
    limit.SetAttribute("lower", bounded(a.lower).c_str());
    limit.SetAttribute("upper", bounded(a.upper).c_str());
  }
  limit.SetAttribute("effort", bounded(drive.effort_max).c_str());
  limit.SetAttribute("velocity", bounded(drive.velocity_max).c_str());
}

/// A frame fixed to an axis' link.
void add_end(XMLElement& robot, const Chain& chain, const std::string& name, int axis, const Pose& X_O) {
  add_element(robot, "link", {{"name", name}});
  const auto taken = [&](const std::string& joint) {
    return std::any_of(chain.axes.begin(), chain.axes.end(),
                       [&](const ChainAxis& a) { return a.name == joint; });
  };
  std::string joint = name + "_mount";
  while (taken(joint)) joint += '_';
  XMLElement& mount = add_joint(robot, joint, "fixed");
  add_element(mount, "parent", {{"link", link_name(chain, axis)}});
  add_element(mount, "child", {{"link", name}});
  add_element(mount, "origin",
              {{"xyz", numbers(X_O.translation() - link_origin(chain, axis))},
               {"rpy", numbers(roll_pitch_yaw(X_O.linear()))}});
}

}  // namespace

std::string write_urdf(const std::string& name, const Chain& chain, std::span<const LinkMass> links,
                       std::span<const AxisDrive> drives) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration("xml version=\"1.0\""));
  XMLElement& robot = add_element(document, "robot", {{"name", name}});
  add_link(robot, chain, -1, links);
  for (int axis = 0; axis < chain.size(); ++axis) {
    add_link(robot, chain, axis, links);
    add_axis_joint(robot, chain, axis, axis < std::ssize(drives) ? drives[axis] : AxisDrive{});
  }
  add_end(robot, chain, "work", chain.work_axis, chain.X_OS_zero);
  add_end(robot, chain, "tool", chain.tool_axis, chain.X_OT_zero);
  return to_text(document);
}

}  // namespace understudy::machine
