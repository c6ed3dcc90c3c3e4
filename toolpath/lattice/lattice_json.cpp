#include "toolpath/lattice/lattice_json.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/json_depth.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

using nlohmann::json;

const std::map<std::string, double> kUnits = {
    {"millimeter", kMillimetre}, {"centimeter", 1e-2}, {"meter", 1.0}, {"inch", kInch}};

constexpr std::size_t kEntriesMax = 100'000;  // docs/limits.md
constexpr double kFarthest = 1000;            // [m], likewise

class LatticeReader {
 public:
  LatticeReader(const json& root, const std::string& file) : root_(root), file_(file) {}

  Lattice run() {
    if (!root_.is_object()) fail("the file", "is not an object");
    const std::string unit = text(root_, "unit", "the frame");
    if (!kUnits.contains(unit))
      fail("unit", fmt::format("is '{}', it must be millimeter, centimeter, meter or inch", unit));
    unit_ = kUnits.at(unit);
    const json& nodes = list("node_list");
    for (std::size_t i = 0; i < nodes.size(); ++i) add_node(nodes[i], static_cast<int>(i));
    const json& elements = list("element_list");
    for (std::size_t i = 0; i < elements.size(); ++i) add_strut(elements[i], fmt::format("element {}", i));
    check_ground();
    return std::move(lattice_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& why) const {
    throw InputError(Place{file_}, what + " " + why);
  }

  const json& member(const json& object, const std::string& key, const std::string& owner) const {
    if (!object.is_object()) fail(owner, "is not an object");
    const auto it = object.find(key);
    if (it == object.end()) fail(owner, fmt::format("has no '{}'", key));
    return *it;
  }
  std::string text(const json& object, const std::string& key, const std::string& owner) const {
    const json& value = member(object, key, owner);
    if (!value.is_string()) fail(owner, fmt::format("has '{}' that is not a text", key));
    return value.get<std::string>();
  }
  const json& list(const std::string& key) const {
    const json& value = member(root_, key, "the frame");
    if (!value.is_array() || value.empty()) fail(key, "is not a list with an entry");
    if (value.size() > kEntriesMax)
      fail(key, fmt::format("has {} entries, more than {}", value.size(), kEntriesMax));
    return value;
  }
  int integer(const json& value, const std::string& what) const {
    const bool fits = value.is_number_integer() && std::abs(value.get<double>()) < 1e9;
    if (!fits) fail(what, fmt::format("is {}, it must be a whole number", value.dump()));
    return value.get<int>();
  }

  void add_node(const json& entry, int index) {
    const std::string name = fmt::format("node {}", index);
    const json& point = member(entry, "point", name);
    LatticeNode node;
    for (int k = 0; k < 3; ++k) {
      const std::string axis(1, static_cast<char>('X' + k));
      const json& value = member(point, axis, name);
      if (!value.is_number() || !std::isfinite(value.get<double>()))
        fail(name, fmt::format("has {} {}, it must be a finite number", axis, value.dump()));
      node.position[k] = unit_ * value.get<double>();
      if (std::abs(node.position[k]) > kFarthest)
        fail(name, fmt::format("has {} at {:g} m, beyond {:g} m", axis, node.position[k], kFarthest));
    }
    const json& grounded = member(entry, "is_grounded", name);
    if (grounded.is_boolean())
      node.grounded = grounded.get<bool>();
    else if (const int number = integer(grounded, name + " is_grounded"); number == 0 || number == 1)
      node.grounded = number == 1;
    else
      fail(name, fmt::format("has is_grounded {}, it must be 0 or 1", number));
    const int id = entry.contains("node_id") ? integer(entry["node_id"], name + " node_id") : index;
    if (!index_.emplace(id, index).second) fail(name, fmt::format("has the node_id {} a second time", id));
    lattice_.nodes.push_back(node);
  }

  void add_strut(const json& entry, const std::string& name) {
    const json& ends = member(entry, "end_node_ids", name);
    if (!ends.is_array() || ends.size() != 2)
      fail(name, fmt::format("has end_node_ids {}, it must be two nodes", ends.dump()));
    std::array<int, 2> strut{};
    for (std::size_t k = 0; k < 2; ++k) {
      const int id = integer(ends[k], name + " end node");
      const auto it = index_.find(id);
      if (it == index_.end())
        fail(name, fmt::format("ends at node {}, which is not one of the {} nodes", id, index_.size()));
      strut[k] = it->second;
    }
    if (!seen_.insert(std::minmax(strut[0], strut[1])).second) fail(name, "joins two nodes a second time");
    lattice_.struts.push_back(strut);
    if (!(lattice_.length(lattice_.struts.size() - 1) > kMicrometre))
      fail(name, fmt::format("is {:g} mm long, it must be above 0.001 mm",
                             to_mm(lattice_.length(lattice_.struts.size() - 1))));
  }

  void check_ground() const {
    bool grounded = false;
    for (const LatticeNode& node : lattice_.nodes) grounded = grounded || node.grounded;
    if (!grounded) fail("the frame", "has 0 grounded nodes, it needs 1 to begin at");
    const std::vector<int> hanging = hanging_nodes(lattice_);
    if (!hanging.empty())
      fail(fmt::format("node {}", hanging.front()),
           fmt::format("and {} more are not connected to a grounded node", hanging.size() - 1));
  }

  const json& root_;
  std::string file_;
  double unit_ = 1;  // [m]
  Lattice lattice_;
  std::map<int, int> index_;  // of a node's id
  std::set<std::pair<int, int>> seen_;
};

}  // namespace

Lattice parse_lattice(const std::string& text, const std::string& file) {
  if (nests_deeper(text))
    throw InputError(Place{file},
                     fmt::format("lists or objects are nested more than {} deep", kJsonDepthMax));
  json root;
  try {
    root = json::parse(text);
  } catch (const json::parse_error& error) {
    const auto end = static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    const auto line = 1 + std::count(text.begin(), text.begin() + end, '\n');
    throw InputError(Place{file, static_cast<int>(line)}, "is not JSON here");
  } catch (const json::exception&) {
    throw InputError(Place{file}, "holds a number that is out of range");
  }
  return LatticeReader(root, file).run();
}

Lattice read_lattice(const std::filesystem::path& path) {
  return parse_lattice(read_file(path), path.string());
}

}  // namespace understudy::toolpath
