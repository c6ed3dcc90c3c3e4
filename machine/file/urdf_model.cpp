#include "machine/file/urdf_model.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/text/xml.h"

namespace understudy::machine {
namespace {

constexpr int kLinksMax = 1000;  // docs/limits.md
constexpr std::size_t kBytesMax = 64'000'000;

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

[[noreturn]] void fail(const std::string& file, const std::string& message) {
  throw InputError({file, 0, 0}, message);
}

/// Of the elements right below the root: macros and their calls end there, or expand to what stands there.
bool is_xacro(const tinyxml2::XMLElement& root) {
  for (const auto* e = root.FirstChildElement(); e; e = e->NextSiblingElement())
    if (std::string_view(e->Name()).starts_with("xacro:")) return true;
  return false;
}

/// urdfdom's own message does not name the joint.
void check_range(const std::string& file, const tinyxml2::XMLElement& joint) {
  const char *type = joint.Attribute("type"), *name = joint.Attribute("name");
  if (!type || !name || joint.FirstChildElement("limit")) return;
  const std::string_view kind = type;
  if (kind != "revolute" && kind != "prismatic") return;
  fail(file,
       fmt::format("joint '{}' is {} and has no limit: give it <limit lower=\"\" upper=\"\" effort=\"\" "
                   "velocity=\"\"/>{}",
                   printable(name), kind, kind == "revolute" ? ", or the type continuous" : ""));
}

// urdfdom recurses into elements and links, however many there are.
void check_elements(const std::string& file, const std::string& text) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED)
    fail(file, fmt::format("is no URDF: elements are nested more than {} deep", TINYXML2_MAX_ELEMENT_DEPTH));
  const auto* root = document.RootElement();
  if (root == nullptr) return;  // urdfdom's message says more
  if (is_xacro(*root))
    fail(file,
         "is a xacro file, not expanded: `understudy new-machine FILE -o FOLDER` does it, or `xacro FILE "
         "-o arm.urdf`");
  for (const char* kind : {"link", "joint"}) {
    int count = 0;
    for (const auto* e = root->FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) ++count;
    if (count > kLinksMax) fail(file, fmt::format("has {} {}s, more than {}", count, kind, kLinksMax));
  }
  for (const auto* e = root->FirstChildElement("joint"); e; e = e->NextSiblingElement("joint"))
    check_range(file, *e);
}

// urdfdom takes a link with two parents, and leaves one of them out without a word; and links that hang on
// none, or on each other in a loop.
void check_tree(const std::string& file, const urdf::ModelInterface& model) {
  std::map<std::string, std::string> parent_joint;
  for (const auto& [name, joint] : model.joints_) {
    const auto [known, is_new] = parent_joint.emplace(joint->child_link_name, name);
    if (!is_new)
      fail(file, fmt::format("link '{}' is the child of two joints, '{}' and '{}': loops are not supported",
                             joint->child_link_name, known->second, name));
  }
  std::vector<std::string> reached{model.getRoot()->name};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const auto& joint : model.getLink(reached[i])->child_joints)
      reached.push_back(joint->child_link_name);
  for (const auto& [name, link] : model.links_)
    if (std::find(reached.begin(), reached.end(), name) == reached.end())
      fail(file, fmt::format("link '{}' is not connected to the root link '{}'", name, reached[0]));
}

}  // namespace

urdf::ModelInterfaceSharedPtr parse_urdf(const std::filesystem::path& path) {
  const std::string file = path.string(), text = read_file(path, kBytesMax);
  check_elements(file, text);
  urdf::ModelInterfaceSharedPtr model;
  QuietConsole console;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& e) {
    fail(file, std::string("is no URDF: ") + e.what());
  }
  // With some errors it only leaves out the element that they stand in, such as a mass.
  if (!model || !console.message().empty())
    fail(file, "is no URDF: " + (console.message().empty() ? "unknown reason" : console.message()));
  check_tree(file, *model);
  return model;
}

urdf::LinkConstSharedPtr find_link(const urdf::ModelInterface& model, const std::string& file,
                                   const std::string& name) {
  if (auto found = model.getLink(name)) return found;
  std::vector<std::string> names;
  for (const auto& [known, ignored] : model.links_) names.push_back(known);
  const std::string near = nearest_word(name, names);
  fail(file, fmt::format("has no link '{}'{}", name, near.empty() ? "" : ", did you mean '" + near + "'?"));
}

}  // namespace understudy::machine
