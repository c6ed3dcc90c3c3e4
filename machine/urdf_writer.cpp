#include "machine/urdf_writer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace understudy::machine {
namespace {

using kinematics::Chain;
using kinematics::ChainAxis;

constexpr double kNoEnd = 1e6;

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string numbers(const Vec3& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

/// Angles of R = Rz(yaw) Ry(pitch) Rx(roll); roll from what yaw leaves, so that R stays exact where pitch is
/// a right angle.
Vec3 roll_pitch_yaw(const Mat3& R) {
  const double level = std::hypot(R(0, 0), R(1, 0));
  const double yaw = level > 1e-14 ? std::atan2(R(1, 0), R(0, 0)) : 0.0;
  const double c = std::cos(yaw), s = std::sin(yaw);
  const double roll = std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1));
  return {roll, std::atan2(-R(2, 0), level), yaw};
}

std::string link_name(const Chain& chain, int axis) {
  return axis < 0 ? "frame" : chain.axes[static_cast<std::size_t>(axis)].name + "_link";
}

/// Where the link of an axis has its origin. A slide's point means nothing: it stays where its parent is.
Vec3 link_origin(const Chain& chain, int axis) {
  for (int i = axis; i >= 0; i = chain.axes[static_cast<std::size_t>(i)].parent) {
    const ChainAxis& a = chain.axes[static_cast<std::size_t>(i)];
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

std::string link_element(const Chain& chain, int axis, std::span<const LinkMass> links) {
  const LinkMass body = joined(links, axis);
  const std::string name = escaped(link_name(chain, axis));
  if (body.mass <= 0) return fmt::format("  <link name=\"{}\"/>\n", name);
  const Mat3& I = body.inertia_O;
  return fmt::format(
      "  <link name=\"{}\">\n    <inertial>\n      <origin xyz=\"{}\"/>\n      <mass value=\"{}\"/>\n"
      "      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n"
      "    </inertial>\n  </link>\n",
      name, numbers(body.centre_O - link_origin(chain, axis)), body.mass, I(0, 0), I(0, 1), I(0, 2), I(1, 1),
      I(1, 2), I(2, 2));
}

std::string joint_element(const Chain& chain, int axis, std::span<const AxisDrive> drives) {
  const auto k = static_cast<std::size_t>(axis);
  const ChainAxis& a = chain.axes[k];
  const auto bounded = [](double v) { return std::clamp(v, -kNoEnd, kNoEnd); };
  const bool endless = a.angle && std::isinf(a.lower) && std::isinf(a.upper);
  const AxisDrive drive = k < drives.size() ? drives[k] : AxisDrive{};
  const std::string ends =
      endless ? "" : fmt::format("lower=\"{}\" upper=\"{}\" ", bounded(a.lower), bounded(a.upper));
  return fmt::format(
      "  <joint name=\"{}\" type=\"{}\">\n    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n"
      "    <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n    <axis xyz=\"{}\"/>\n"
      "    <limit {}effort=\"{}\" velocity=\"{}\"/>\n  </joint>\n",
      escaped(a.name), endless ? "continuous" : (a.angle ? "revolute" : "prismatic"),
      escaped(link_name(chain, a.parent)), escaped(link_name(chain, axis)),
      numbers(link_origin(chain, axis) - link_origin(chain, a.parent)), numbers(a.direction), ends,
      bounded(drive.effort_max), bounded(drive.velocity_max));
}

std::string end_element(const Chain& chain, const std::string& name, int axis, const Pose& X_O) {
  return fmt::format(
      "  <link name=\"{0}\"/>\n  <joint name=\"{0}_mount\" type=\"fixed\">\n    <parent link=\"{1}\"/>\n"
      "    <child link=\"{0}\"/>\n    <origin xyz=\"{2}\" rpy=\"{3}\"/>\n  </joint>\n",
      name, escaped(link_name(chain, axis)), numbers(X_O.translation() - link_origin(chain, axis)),
      numbers(roll_pitch_yaw(X_O.linear())));
}

}  // namespace

std::string write_urdf(const std::string& name, const Chain& chain, std::span<const LinkMass> links,
                       std::span<const AxisDrive> drives) {
  std::string out = fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", escaped(name));
  out += link_element(chain, -1, links);
  for (int axis = 0; axis < chain.size(); ++axis)
    out += link_element(chain, axis, links) + joint_element(chain, axis, drives);
  out += end_element(chain, "work", chain.work_axis, chain.X_OS_zero);
  out += end_element(chain, "tool", chain.tool_axis, chain.X_OT_zero);
  return out + "</robot>\n";
}

}  // namespace understudy::machine
