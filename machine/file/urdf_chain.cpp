#include "machine/file/urdf_chain.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text/printable.h"
#include "machine/file/urdf_model.h"

namespace understudy::machine {
namespace {

using kinematics::ChainAxis;
using kinematics::kMaxAxes;

constexpr std::size_t kNameMax = 100;
constexpr double kMassMax = 1e4;     // [kg], as machine files have it
constexpr double kInertiaMax = 1e6;  // [kg m^2]: ten tons ten metres away

/// Other programs' files hold it as a column, a key, a word: nothing in it may end one of these.
bool is_axis_name(const std::string& name) {
  return name.size() <= kNameMax && std::all_of(name.begin(), name.end(), [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) ||
                  std::string_view(" -_./").find(c) != std::string_view::npos;
         });
}
constexpr double kFarthest = 1000;  // [m], of an origin; sums and products of such numbers stay finite

class UrdfReader {
 public:
  UrdfReader(const std::filesystem::path& file, const std::string& base_link, const std::string& tool_link);
  UrdfArm read();

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError({file_, 0, 0}, message); }
  /// Joints from a link up to the root.
  std::vector<urdf::JointConstSharedPtr> way_up(const urdf::LinkConstSharedPtr& from) const;
  Pose pose(const std::string& place, const urdf::Pose& p) const;
  int add_axes(const std::vector<urdf::JointConstSharedPtr>& down);
  void add_axis(const urdf::Joint& joint, int parent);
  /// Frames of all links at 0, and their masses.
  void place_links(const urdf::LinkConstSharedPtr& from, const Pose& X_OL);
  void add_masses_and_shapes(const urdf::LinkConstSharedPtr& from, int axis);
  void add_shapes(const urdf::Link& link, int axis);
  LinkMass link_mass(const urdf::Link& link, int axis) const;

  std::string file_, base_name_, tool_name_;
  urdf::ModelInterfaceSharedPtr model_;
  std::map<std::string, Pose> X_OL_;
  std::map<std::string, int> axis_of_joint_;
  UrdfArm arm_;
};

UrdfReader::UrdfReader(const std::filesystem::path& file, const std::string& base_link,
                       const std::string& tool_link)
    : file_(file.string()), base_name_(base_link), tool_name_(tool_link), model_(parse_urdf(file)) {}

std::vector<urdf::JointConstSharedPtr> UrdfReader::way_up(const urdf::LinkConstSharedPtr& from) const {
  std::vector<urdf::JointConstSharedPtr> way;
  for (urdf::LinkConstSharedPtr at = from; at->parent_joint; at = at->getParent())
    way.push_back(at->parent_joint);
  return way;
}

Pose UrdfReader::pose(const std::string& place, const urdf::Pose& p) const {
  const Quat q(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z);
  const Vec3 position(p.position.x, p.position.y, p.position.z);
  if (!position.allFinite() || !q.coeffs().allFinite())
    fail(fmt::format("{}: origin xyz is {} {} {}, which is no place", place, p.position.x, p.position.y,
                     p.position.z));
  if (position.cwiseAbs().maxCoeff() > kFarthest)
    fail(fmt::format("{}: origin xyz is {:g} {:g} {:g}, beyond {:g} m: URDF is in metres", place,
                     p.position.x, p.position.y, p.position.z, kFarthest));
  return make_pose(q, position);
}

void UrdfReader::place_links(const urdf::LinkConstSharedPtr& from, const Pose& X_OL) {
  X_OL_[from->name] = X_OL;
  for (const auto& joint : from->child_joints)
    place_links(model_->getLink(joint->child_link_name),
                X_OL * pose("joint '" + joint->name + "'", joint->parent_to_joint_origin_transform));
}

void UrdfReader::add_axis(const urdf::Joint& joint, int parent) {
  const std::string place = "joint '" + printable(joint.name) + "'";
  if (!is_axis_name(joint.name))
    fail(place +
         fmt::format(
             ": of an axis' name, {} characters or fewer, letters, digits, spaces and - _ . / are allowed",
             kNameMax));
  if (joint.mimic) fail(fmt::format("{} mimics '{}': not supported", place, joint.mimic->joint_name));
  if (joint.type == urdf::Joint::PLANAR) fail(place + " has the type planar: not supported");
  if (joint.type == urdf::Joint::FLOATING) fail(place + " has the type floating: not supported");
  const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
  const double length = axis.norm();
  if (!(length > 1e-9) || !std::isfinite(length))
    fail(
        fmt::format("{}: axis xyz is {} {} {}, which has no direction", place, axis.x(), axis.y(), axis.z()));
  if (arm_.chain.size() == kMaxAxes)
    fail(fmt::format("{} is axis {} between '{}' and '{}', more than {}", place, kMaxAxes + 1, base_name_,
                     tool_name_, kMaxAxes));
  const Pose& X_OL = X_OL_.at(joint.child_link_name);
  ChainAxis made;
  made.name = joint.name;
  made.angle = joint.type != urdf::Joint::PRISMATIC;
  made.direction = X_OL.linear() * (axis / length);
  made.point = X_OL.translation();
  made.parent = parent;
  AxisDrive drive;
  if (joint.limits) {
    const urdf::JointLimits& l = *joint.limits;
    if (joint.type != urdf::Joint::CONTINUOUS) {
      if (!std::isfinite(l.lower) || !std::isfinite(l.upper) || l.lower >= l.upper)
        fail(fmt::format("{}: limit lower {} is not below upper {}", place, l.lower, l.upper));
      made.lower = l.lower;
      made.upper = l.upper;
    }
    if (!(l.velocity >= 0) || !(l.effort >= 0))
      fail(fmt::format("{}: limit velocity {} and effort {} must not be negative", place, l.velocity,
                       l.effort));
    if (l.velocity > 0) drive.velocity_max = l.velocity;
    if (l.effort > 0) drive.effort_max = l.effort;
  }
  arm_.chain.axes.push_back(made);
  arm_.drives.push_back(drive);
}

/// From the fork down to an end; returns the axis that carries it.
int UrdfReader::add_axes(const std::vector<urdf::JointConstSharedPtr>& down) {
  int carrier = -1;
  for (const auto& joint : down) {
    if (joint->type == urdf::Joint::FIXED) continue;
    add_axis(*joint, carrier);
    carrier = arm_.chain.size() - 1;
    axis_of_joint_[joint->name] = carrier;
  }
  return carrier;
}

LinkMass UrdfReader::link_mass(const urdf::Link& link, int axis) const {
  const urdf::Inertial& given = *link.inertial;
  const std::string place = "link '" + link.name + "'";
  const Pose X_OC = X_OL_.at(link.name) * pose(place, given.origin);
  Mat3 I;
  I << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz, given.izz;
  if (!std::isfinite(given.mass) || given.mass < 0)
    fail(fmt::format("{}: mass is {} kg, must not be negative", place, given.mass));
  if (given.mass > kMassMax)
    fail(fmt::format("{}: mass is {} kg, more than {}", place, given.mass, kMassMax));
  if (!I.allFinite()) fail(place + ": inertia holds a number that is not finite");
  if (I.cwiseAbs().maxCoeff() > kInertiaMax)
    fail(fmt::format("{}: inertia holds {} kg m^2, more than {}", place, I.cwiseAbs().maxCoeff(),
                     kInertiaMax));
  // Of a body, no principal moment is larger than the two others together. Files round to a few digits.
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(I).eigenvalues();
  constexpr double kRounded = 1e-2;
  if (moments[0] < -kRounded * moments[2] || moments[2] > (moments[0] + moments[1]) * (1 + kRounded) + 1e-12)
    fail(fmt::format("{}: no body has the inertia of principal moments {:.3g}, {:.3g}, {:.3g} kg m^2", place,
                     moments[0], moments[1], moments[2]));
  const Mat3& R = X_OC.linear();
  return {link.name, axis, given.mass, X_OC.translation(), R * I * R.transpose()};
}

void UrdfReader::add_shapes(const urdf::Link& link, int axis) {
  const std::string place = "link '" + link.name + "'";
  const auto checked = [&](std::initializer_list<double> sizes, const char* what) {
    for (const double size : sizes)
      if (!(size > 0) || size > kFarthest)
        fail(fmt::format("{}: collision {} has a size of {:g} m, not above 0 and at most {:g} m", place, what,
                         size, kFarthest));
  };
  for (const auto& collision : link.collision_array) {
    if (!collision || !collision->geometry) continue;
    UrdfShape shape{link.name, axis, geometry::Sphere{},
                    X_OL_.at(link.name) * pose(place, collision->origin)};
    const urdf::Geometry& form = *collision->geometry;
    if (form.type == urdf::Geometry::SPHERE) {
      const auto& sphere = dynamic_cast<const urdf::Sphere&>(form);
      checked({sphere.radius}, "sphere");
      shape.form = geometry::Sphere{sphere.radius};
    } else if (form.type == urdf::Geometry::CYLINDER) {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(form);
      checked({cylinder.radius, cylinder.length}, "cylinder");
      shape.form = geometry::Cylinder{cylinder.radius, cylinder.length};
    } else if (form.type == urdf::Geometry::BOX) {
      const auto& box = dynamic_cast<const urdf::Box&>(form);
      checked({box.dim.x, box.dim.y, box.dim.z}, "box");
      shape.form = geometry::Box{Vec3(box.dim.x, box.dim.y, box.dim.z)};
    } else {
      const auto& mesh = dynamic_cast<const urdf::Mesh&>(form);
      const Vec3 scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
      if (!scale.allFinite() || scale.cwiseAbs().minCoeff() == 0)
        fail(fmt::format("{}: collision mesh has the scale {:g} {:g} {:g}", place, scale.x(), scale.y(),
                         scale.z()));
      if (mesh.filename.empty() || mesh.filename.back() == '/')
        fail(fmt::format("{}: collision mesh '{}' names no file", place, mesh.filename));
      shape.form = UrdfMesh{mesh.filename, scale};
    }
    arm_.shapes.push_back(std::move(shape));
  }
}

void UrdfReader::add_masses_and_shapes(const urdf::LinkConstSharedPtr& from, int axis) {
  if (from->inertial && from->inertial->mass != 0) arm_.links.push_back(link_mass(*from, axis));
  add_shapes(*from, axis);
  for (const auto& joint : from->child_joints) {
    const auto moved = axis_of_joint_.find(joint->name);
    add_masses_and_shapes(model_->getLink(joint->child_link_name),
                          moved == axis_of_joint_.end() ? axis : moved->second);
  }
}

UrdfArm UrdfReader::read() {
  const auto base = find_link(*model_, file_, base_name_), tool = find_link(*model_, file_, tool_name_);
  for (const auto& [name, link] : model_->links_) arm_.link_names.push_back(name);
  place_links(model_->getRoot(), Pose::Identity());
  auto to_base = way_up(base), to_tool = way_up(tool);
  // What carries both moves neither against the other.
  while (!to_base.empty() && !to_tool.empty() && to_base.back() == to_tool.back()) {
    to_base.pop_back();
    to_tool.pop_back();
  }
  std::reverse(to_base.begin(), to_base.end());
  std::reverse(to_tool.begin(), to_tool.end());
  arm_.chain.tool_axis = add_axes(to_tool);
  arm_.chain.work_axis = add_axes(to_base);
  if (arm_.chain.axes.empty()) fail(fmt::format("no joint moves '{}' against '{}'", tool_name_, base_name_));
  arm_.chain.X_OS_zero = X_OL_.at(base_name_);
  arm_.chain.X_OT_zero = X_OL_.at(tool_name_);
  add_masses_and_shapes(model_->getRoot(), -1);
  return std::move(arm_);
}

}  // namespace

UrdfArm read_urdf(const std::filesystem::path& file, const std::string& base_link,
                  const std::string& tool_link) {
  return UrdfReader(file, base_link, tool_link).read();
}

}  // namespace understudy::machine
