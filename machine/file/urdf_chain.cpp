#include "machine/file/urdf_chain.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <mutex>
#include <string_view>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/text/xml.h"

namespace understudy::machine {
namespace {

using kinematics::Chain;
using kinematics::ChainAxis;
using kinematics::kMaxAxes;

/// Collects what urdfdom would print, while it lives. Its output is global: one reader at a time.
class QuietConsole final : public console_bridge::OutputHandler {
 public:
  QuietConsole() : lock_(mutex()) { console_bridge::useOutputHandler(this); }
  ~QuietConsole() override { console_bridge::restorePreviousOutputHandler(); }
  QuietConsole(const QuietConsole&) = delete;
  QuietConsole& operator=(const QuietConsole&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR || ++errors_ > 2) return;
    if (!message_.empty()) message_ += "; ";
    for (const char c : text) message_ += c == '\n' || c == '\r' ? ' ' : c;
  }
  const std::string& message() const { return message_; }

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  int errors_ = 0;
  std::string message_;  // the first two errors: the value, and the element that it stands in
};

constexpr int kLinksMax = 1000;  // docs/limits.md
constexpr std::size_t kBytesMax = 64'000'000;
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
  void check_size(const std::string& text) const;
  void check_tree() const;
  urdf::LinkConstSharedPtr link(const std::string& name) const;
  /// Joints from a link up to the root.
  std::vector<urdf::JointConstSharedPtr> way_up(const urdf::LinkConstSharedPtr& from) const;
  Pose pose(const std::string& place, const urdf::Pose& p) const;
  int add_axes(const std::vector<urdf::JointConstSharedPtr>& down);
  void add_axis(const urdf::Joint& joint, int parent);
  /// Frames of all links at 0, and their masses.
  void place_links(const urdf::LinkConstSharedPtr& from, const Pose& X_OL);
  void add_masses(const urdf::LinkConstSharedPtr& from, int axis);
  LinkMass link_mass(const urdf::Link& link, int axis) const;

  std::string file_, base_name_, tool_name_;
  urdf::ModelInterfaceSharedPtr model_;
  std::map<std::string, Pose> X_OL_;
  std::map<std::string, int> axis_of_joint_;
  UrdfArm arm_;
};

UrdfReader::UrdfReader(const std::filesystem::path& file, const std::string& base_link,
                       const std::string& tool_link)
    : file_(file.string()), base_name_(base_link), tool_name_(tool_link) {
  const std::string text = read_file(file, kBytesMax);
  check_size(text);
  QuietConsole console;
  try {
    model_ = urdf::parseURDF(text);
  } catch (const std::exception& e) {
    fail(std::string("is no URDF: ") + e.what());
  }
  // With some errors it only leaves out the element that they stand in, such as a mass.
  if (!model_ || !console.message().empty())
    fail("is no URDF: " + (console.message().empty() ? "unknown reason" : console.message()));
}

// urdfdom recurses into elements and links, however many there are.
void UrdfReader::check_size(const std::string& text) const {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    fail(fmt::format("is no URDF: elements are nested more than {} deep", TINYXML2_MAX_ELEMENT_DEPTH));
  if (document.RootElement() == nullptr) return;  // urdfdom's message says more
  for (const char* kind : {"link", "joint"}) {
    int count = 0;
    for (const auto* e = document.RootElement()->FirstChildElement(kind); e; e = e->NextSiblingElement(kind))
      ++count;
    if (count > kLinksMax) fail(fmt::format("has {} {}s, more than {}", count, kind, kLinksMax));
  }
}

// urdfdom takes a link with two parents, and leaves one of them out without a word; and links that hang on
// none, or on each other in a loop.
void UrdfReader::check_tree() const {
  std::map<std::string, std::string> parent_joint;
  for (const auto& [name, joint] : model_->joints_) {
    const auto [known, is_new] = parent_joint.emplace(joint->child_link_name, name);
    if (!is_new)
      fail(fmt::format("link '{}' is the child of two joints, '{}' and '{}': loops are not supported",
                       joint->child_link_name, known->second, name));
  }
  std::vector<std::string> reached{model_->getRoot()->name};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const auto& joint : model_->getLink(reached[i])->child_joints)
      reached.push_back(joint->child_link_name);
  for (const auto& [name, link] : model_->links_)
    if (std::find(reached.begin(), reached.end(), name) == reached.end())
      fail(fmt::format("link '{}' is not connected to the root link '{}'", name, reached[0]));
}

urdf::LinkConstSharedPtr UrdfReader::link(const std::string& name) const {
  if (auto found = model_->getLink(name)) return found;
  std::vector<std::string> names;
  for (const auto& [known, ignored] : model_->links_) names.push_back(known);
  const std::string near = nearest_word(name, names);
  fail(fmt::format("has no link '{}'{}", name, near.empty() ? "" : ", did you mean '" + near + "'?"));
}

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

void UrdfReader::add_masses(const urdf::LinkConstSharedPtr& from, int axis) {
  if (from->inertial && from->inertial->mass != 0) arm_.links.push_back(link_mass(*from, axis));
  for (const auto& joint : from->child_joints) {
    const auto moved = axis_of_joint_.find(joint->name);
    add_masses(model_->getLink(joint->child_link_name), moved == axis_of_joint_.end() ? axis : moved->second);
  }
}

UrdfArm UrdfReader::read() {
  check_tree();
  const auto base = link(base_name_), tool = link(tool_name_);
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
  add_masses(model_->getRoot(), -1);
  return std::move(arm_);
}

}  // namespace

UrdfArm read_urdf(const std::filesystem::path& file, const std::string& base_link,
                  const std::string& tool_link) {
  return UrdfReader(file, base_link, tool_link).read();
}

}  // namespace understudy::machine
