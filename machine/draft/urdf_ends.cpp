#include "machine/draft/urdf_ends.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "machine/file/urdf_model.h"

namespace understudy::machine {
namespace {

constexpr std::array<std::string_view, 12> kUsual{"tool0",  "tcp",       "tool_tip", "tool",
                                                  "flange", "ee_link",   "link_eef", "end_effector",
                                                  "ee",     "tool_link", "hand_tcp", "gripper_base"};

bool moves(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED && !joint.mimic; }

/// By the name of the joint or of what it carries.
bool is_of_gripper(const urdf::Joint& joint) {
  std::string names = joint.name + " " + joint.child_link_name;
  std::transform(names.begin(), names.end(), names.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const char* word : {"finger", "gripper", "jaw", "knuckle"})
    if (names.find(word) != std::string::npos) return true;
  return false;
}

/// Moving joints of every link's subtree, and from the root to it.
struct Counts {
  std::map<std::string, int> below, above;

  int count(const urdf::ModelInterface& model, const urdf::LinkConstSharedPtr& link, int so_far) {
    above[link->name] = so_far;
    int sum = 0;
    for (const auto& joint : link->child_joints) {
      const int own = moves(*joint) ? 1 : 0;
      sum += own + count(model, model.getLink(joint->child_link_name), so_far + own);
    }
    return below[link->name] = sum;
  }
};

std::string end_of_arm(const urdf::ModelInterface& model, const Counts& counts) {
  urdf::LinkConstSharedPtr at = model.getRoot();
  while (counts.below.at(at->name) > 0) {
    std::vector<urdf::JointConstSharedPtr> branches;
    for (const auto& joint : at->child_joints)
      if (joint->type != urdf::Joint::FIXED || counts.below.at(joint->child_link_name) > 0)
        branches.push_back(joint);
    if (branches.size() > 1 && counts.above.at(at->name) > 0) break;  // fingers
    if (branches.size() == 1 && moves(*branches[0]) && is_of_gripper(*branches[0])) break;
    const auto most = std::max_element(branches.begin(), branches.end(), [&](const auto& a, const auto& b) {
      return counts.below.at(a->child_link_name) < counts.below.at(b->child_link_name);
    });
    at = model.getLink((*most)->child_link_name);
  }
  return at->name;
}

}  // namespace

UrdfEnds likely_ends(const std::filesystem::path& urdf) {
  const auto model = parse_urdf(urdf);
  Counts counts;
  if (counts.count(*model, model->getRoot(), 0) == 0)
    throw InputError({urdf.string(), 0, 0}, "has no joint that moves");
  const std::string end = end_of_arm(*model, counts);
  const int axes = counts.above.at(end);
  for (const std::string_view usual : kUsual)
    for (const auto& [name, link] : model->links_) {
      const bool fits =
          name == usual ||
          (name.size() > usual.size() + 1 && name.ends_with(usual) &&
           (name[name.size() - usual.size() - 1] == '_' || name[name.size() - usual.size() - 1] == '-'));
      if (fits && counts.above.at(name) == axes) return {model->getRoot()->name, name};
    }
  return {model->getRoot()->name, end};
}

}  // namespace understudy::machine
