#include "machine/file/urdf_section.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include <fmt/format.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/outside.h"
#include "core/file/read_file.h"
#include "machine/file/urdf_bodies.h"
#include "machine/file/urdf_chain.h"

namespace understudy::machine {
namespace fs = std::filesystem;
namespace {

/// The body that a URDF's links on one axis make together.
Link rigid_body(const UrdfArm& arm, int axis) {
  Link body;
  Vec3 moment = Vec3::Zero();
  for (const LinkMass& part : arm.links) {
    if (part.axis != axis) continue;
    body.mass += part.mass;
    moment += part.mass * part.centre_O;
  }
  if (!(body.mass > 0)) return body;
  body.centre_O = moment / body.mass;
  for (const LinkMass& part : arm.links) {
    if (part.axis != axis) continue;
    const Vec3 r = part.centre_O - body.centre_O;
    body.inertia_O += part.inertia_O + part.mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  return body;
}

/// A file that the map names by `key`, in its folder or below.
fs::path named_file(const YamlMap& map, const std::string& key, const std::string& name,
                    const fs::path& folder) {
  const fs::path path = folder / name;
  if (!may_be_named_from(folder, path))
    throw InputError(map.place(key), fmt::format("{} is '{}', outside the machine file's folder: copy it "
                                                 "there, or set {}=1 if you trust this file",
                                                 map.path(key), name, kAllowOutside));
  return path;
}

struct Names {
  std::string urdf, base, tool, srdf, packages;
  std::vector<std::string> unchecked;
};

Names read_names(YamlMap& map) {
  Names names;
  names.urdf = map.text("urdf", "file with axes, ranges, masses and collision shapes, relative to this one");
  names.base = map.text("base_link", "the link that carries the work");
  names.tool = map.text("tool_link", "the link that carries the tool");
  if (map.has("srdf"))
    names.srdf = map.text("srdf", "file with pairs of links that are not checked against each other");
  if (map.has("packages"))
    names.packages = map.text(
        "packages", "folder of the packages that `package://NAME/PATH` names, relative to this file");
  if (map.has("unchecked_links"))
    names.unchecked = map.texts("unchecked_links", "links whose collision shapes are left out");
  return names;
}

void check_unchecked(const YamlMap& map, const Names& names, const std::vector<std::string>& links) {
  for (const std::string& link : names.unchecked)
    if (std::find(links.begin(), links.end(), link) == links.end()) {
      const std::string near = nearest_word(link, links);
      throw InputError(map.place("unchecked_links"),
                       fmt::format("{}: the URDF has no link '{}'{}", map.path("unchecked_links"), link,
                                   near.empty() ? "" : ", did you mean '" + near + "'?"));
    }
}

/// Pairs of links as pairs of their bodies.
void keep_apart(const std::vector<std::array<std::string, 2>>& pairs, const std::vector<UrdfBody>& bodies,
                MachineNotes& notes) {
  for (const auto& pair : pairs)
    for (const UrdfBody& one : bodies)
      for (const UrdfBody& other : bodies)
        if (one.link == pair[0] && other.link == pair[1])
          notes.apart.push_back({one.shape.name, other.shape.name});
}

/// Links that are not checked: those that the file lists, and those whose meshes are in a package that is not
/// here and whose folder the file does not name.
std::vector<std::string> unchecked_links(const UrdfArm& arm, const Names& names, const MeshPlaces& places) {
  std::vector<std::string> links = names.unchecked;
  for (const UrdfShape& shape : arm.shapes) {
    const auto* mesh = std::get_if<UrdfMesh>(&shape.form);
    const bool elsewhere = mesh && names.packages.empty() && mesh->file.starts_with("package://") &&
                           find_mesh(mesh->file, places).empty();
    if (elsewhere && std::find(links.begin(), links.end(), shape.link) == links.end())
      links.push_back(shape.link);
  }
  return links;
}

}  // namespace

Link assumed_link(const kinematics::Chain& chain, int axis) {
  constexpr double kMassPerLength = 15, kLeastMass = 1;  // [kg/m], [kg]: arms that carry some kilograms
  constexpr double kRadius = 0.05;                       // [m]
  const auto index = static_cast<std::size_t>(axis);
  Vec3 from = chain.axes[index].angle ? chain.axes[index].point : Vec3(Vec3::Zero()),
       to = axis == chain.tool_axis ? Vec3(chain.X_OT_zero.translation()) : from;
  for (const kinematics::ChainAxis& next : chain.axes)
    if (next.parent == axis && next.angle) to = next.point;
  if (!chain.axes[index].angle) from = to;
  const double length = (to - from).norm();
  Link rod;
  rod.mass = std::max(kLeastMass, kMassPerLength * length);
  rod.centre_O = 0.5 * (from + to);
  const Vec3 along = length > 0 ? Vec3((to - from) / length) : Vec3(Vec3::UnitZ());
  const double own = 0.5 * kRadius * kRadius, across = own / 2 + length * length / 12;
  rod.inertia_O = rod.mass * (across * Mat3::Identity() + (own - across) * along * along.transpose());
  return rod;
}

namespace {

std::optional<Names> names_in(const std::string& text, const fs::path& file) {
  struct Seen {};  // the other keys are not of interest here
  std::optional<Names> names;
  try {
    YamlMap::read_text(text, file.string(), [&](YamlMap& root) {
      if (!root.has("geometry.urdf")) throw Seen{};
      root.section("geometry", "the mechanism as drawn", [&](YamlMap& map) {
        names = read_names(map);
        throw Seen{};
      });
    });
  } catch (const Seen&) {
  }
  return names;
}

}  // namespace

std::string tool_link_named_in(const std::string& text, const fs::path& file) {
  const std::optional<Names> names = names_in(text, file);
  return names ? names->tool : "";
}

std::vector<fs::path> files_named_in(const std::string& text, const fs::path& file) {
  const std::optional<Names> names = names_in(text, file);
  if (!names) return {};
  const fs::path folder = fs::absolute(file).parent_path();
  const MeshPlaces places{folder / names->urdf, folder / names->packages};
  std::vector<fs::path> files{places.urdf};
  if (!names->srdf.empty()) files.push_back(folder / names->srdf);
  for (const UrdfShape& shape : read_urdf(places.urdf, names->base, names->tool).shapes) {
    const auto* mesh = std::get_if<UrdfMesh>(&shape.form);
    if (!mesh ||
        std::find(names->unchecked.begin(), names->unchecked.end(), shape.link) != names->unchecked.end())
      continue;
    const fs::path found = find_mesh(mesh->file, places).lexically_normal();
    if (!found.empty() && std::find(files.begin(), files.end(), found) == files.end()) files.push_back(found);
  }
  return files;
}

void read_urdf_chain(YamlMap& map, const Pose& X_LT, MachineDescription& machine, MachineNotes& notes) {
  ChainModel& model = machine.chain();
  const Names names = read_names(map);
  if (map.recording()) model.kinematics.chain.axes.resize(1);  // one axis for all
  if (!map.complete()) return;
  const fs::path folder = machine.file.parent_path();
  const fs::path urdf = named_file(map, "urdf", names.urdf, folder);
  const UrdfArm arm = read_urdf(urdf, names.base, names.tool);
  check_unchecked(map, names, arm.link_names);
  std::vector<fs::path> files{urdf};
  const fs::path packages =
      names.packages.empty() ? folder : named_file(map, "packages", names.packages, folder);
  notes.unchecked_links = unchecked_links(arm, names, {urdf, packages});
  const std::vector<UrdfBody> bodies =
      urdf_bodies(arm, {urdf, packages}, folder, notes.unchecked_links, files);
  if (!names.srdf.empty()) {
    files.push_back(named_file(map, "srdf", names.srdf, folder));
    keep_apart(read_srdf(files.back(), arm.link_names), bodies, notes);
  }
  for (const fs::path& file : files)  // the machine is all of them
    machine.sha256 = sha256_hex(machine.sha256 + sha256_hex(read_file(file)));
  model.kinematics.chain = arm.chain;
  model.kinematics.chain.X_OT_zero = arm.chain.X_OT_zero * X_LT;
  for (int i = 0; i < arm.chain.size(); ++i) model.links.push_back(rigid_body(arm, i));
  for (const UrdfBody& body : bodies)
    (body.axis < 0 ? model.frame_bodies : model.links[static_cast<std::size_t>(body.axis)].bodies)
        .push_back(body.shape);
}

}  // namespace understudy::machine
