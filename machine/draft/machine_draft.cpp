#include "machine/draft/machine_draft.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/units.h"
#include "core/yaml/explained_yaml.h"
#include "geometry/convex_hull.h"
#include "machine/description.h"
#include "machine/draft/table_place.h"
#include "machine/draft/urdf_ends.h"
#include "machine/file/beside_machine.h"
#include "machine/file/urdf_bodies.h"
#include "machine/file/urdf_chain.h"
#include "machine/machine_notes.h"
#include "machine/model_files.h"

namespace understudy::machine {
namespace fs = std::filesystem;
namespace {

using kinematics::ChainAxis;

constexpr double kToolLength = 0.1;                 // [m], from the flange to the tip
constexpr double kTableSize = 0.2;                  // [m]
constexpr double kFastTurn = 90, kFastSlide = 200;  // [deg/s], [mm/s], where a URDF says nothing
constexpr double kConditionMax = 200;
constexpr const char* kUrdfName = "arm.urdf";
constexpr const char* kMeshFolder = "meshes";

std::string number(double value) {
  std::string text = fmt::format("{:.6g}", value);
  return text == "-0" ? "0" : text;
}
/// A word of a stranger's file as YAML takes it, whatever is in it.
std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("''") : std::string(1, c);
  return text + "'";
}
std::string triple(const Vec3& v) {
  return fmt::format("[{}, {}, {}]", number(v.x()), number(v.y()), number(v.z()));
}

/// From the flange outwards, in the tool link's frame: along the last axis, away from the arm.
Vec3 outward(const UrdfArm& arm) {
  const kinematics::Chain& chain = arm.chain;
  const Mat3 R_LO = chain.X_OT_zero.linear().transpose();
  const int last = chain.tool_axis;
  if (last < 0) return R_LO * Vec3(0, 0, -1);
  const ChainAxis& axis = chain.axes[static_cast<std::size_t>(last)];
  Vec3 from = axis.point;
  for (int i = axis.parent; i >= 0; i = chain.axes[static_cast<std::size_t>(i)].parent)
    if (const ChainAxis& above = chain.axes[static_cast<std::size_t>(i)]; above.angle) {
      from = above.point;
      break;
    }
  const double along = axis.direction.dot(chain.X_OT_zero.translation() - from);
  Vec3 out = R_LO * axis.direction * (std::abs(along) > 1e-6 ? std::copysign(1.0, along) : 1.0);
  constexpr double kRounding = 1e-3;  // URDFs state turns with a few digits
  for (int k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0})
      if ((out - sign * Vec3::Unit(k)).norm() < kRounding) out = sign * Vec3::Unit(k);
  return out;
}

double rounded(double value, double step) { return std::round(value / step) * step; }

/// Home as the file will have it: tenths, within the range.
double home_of(const ChainAxis& axis, double home) {
  const double unit = axis.angle ? kDegree : kMillimetre, step = 0.1 * unit;
  double at = rounded(home, step);
  if (at < axis.lower) at = std::ceil(axis.lower / step) * step;
  if (at > axis.upper) at = std::floor(axis.upper / step) * step;
  return at / unit;
}

std::string said_by_urdf(const ChainAxis& axis, const AxisDrive& drive) {
  const double unit = axis.angle ? kDegree : kMillimetre;
  const char* name = axis.angle ? "deg" : "mm";
  std::string text = std::isfinite(axis.lower) ? fmt::format("{} to {} {}", number(axis.lower / unit),
                                                             number(axis.upper / unit), name)
                                               : std::string("without end");
  if (std::isfinite(drive.velocity_max))
    text += fmt::format(", at most {} {}/s", number(drive.velocity_max / unit), name);
  if (std::isfinite(drive.effort_max))
    text += fmt::format(", {} {}", number(drive.effort_max), axis.angle ? "N m" : "N");
  return text;
}

std::string axis_text(const ChainAxis& axis, const AxisDrive& drive, double home) {
  const double unit = axis.angle ? kDegree : kMillimetre;
  const double fast =
      std::isfinite(drive.velocity_max) ? drive.velocity_max / unit : (axis.angle ? kFastTurn : kFastSlide);
  const bool endless = axis.angle && !std::isfinite(axis.lower);
  const char* u = axis.angle ? "deg" : "mm";
  return fmt::format(
      "  # {}: {} by the URDF\n  - name: {}\n{}    home_{}: {}\n    {}\n    drive: {{lead_{}: {}, "
      "steps_per_turn: 8192, microsteps: 1, velocity_max_{}_per_s: {}, acceleration_max_{}_per_s2: {}}}\n",
      axis.name, said_by_urdf(axis, drive), quoted(axis.name), endless ? "    endless: yes\n" : "", u,
      number(home_of(axis, home)), axis.angle ? "play_arcmin: 0.1" : "play_um: 20", u,
      axis.angle ? "3.6" : "20", u, number(fast), u, number(5 * fast));
}

constexpr const char* kTail = R"(tool:
  nozzle_diameter_mm: 0.4
  flat_diameter_mm: 1.0
  filament_diameter_mm: 1.75
  bodies:
    - {name: nozzle, shape: frustum, bottom_centre_mm: [0, 0, 0], radius_bottom_mm: 0.5, radius_top_mm: 3.5, height_mm: 14}
    - {name: heater block, shape: box, bottom_centre_mm: [0, 0, 14], size_mm: [20, 16, 11]}
    - {name: extruder, shape: cylinder, bottom_centre_mm: [0, 0, 30], radius_mm: 24, height_mm: 62}
tolerances:
  manufactured: {axis_position_mm: 0.2, axis_direction_deg: 0.02, zero_mm: 0.1, zero_deg: 0.05}
  after_calibration: {axis_position_mm: 0.01, axis_direction_deg: 0.001, zero_mm: 0.01, zero_deg: 0.001}
gap: {accepted_min_mm: 0.10, accepted_max_mm: 0.30, aim_mm: 0.20, standoff_mm: 2}
accuracy: {tip_mm: 0.2, orientation_deg: 2}
table: {size_mm: [200, 200, 10]}
motion: {cycle_ms: 1, travel_mm_per_s: 75, orientation_deg_per_s: 60, acceleration_mm_per_s2: 500}
)";

/// The text with a comment at every key; those of assumed figures say so.
std::string explained(const std::string& text, const MapSchema& schema,
                      const std::vector<std::string>& assumed) {
  return explained_yaml(text, schema, [&](const std::string& path) -> std::string {
    const std::string word = assumption_of(path);
    return std::find(assumed.begin(), assumed.end(), word) == assumed.end() ? "" : "assumed";
  });
}

std::string assumed_key(const std::vector<std::string>& assumed) {
  return fmt::format(
      "# What is marked `assumed` nobody measured on this machine. Measure it, write it here, and take its "
      "word out of\n"
      "# this list; without the list the machine counts as measured.\nassumed: [{}]\n",
      fmt::join(assumed, ", "));
}

bool is_body(const fs::path& mesh, const Vec3& scale) {
  try {
    std::vector<Vec3> points = geometry::read_mesh_points(mesh);
    for (Vec3& p : points) p = p.cwiseProduct(scale);
    return geometry::convex_hull(points, mesh.string()) != nullptr;
  } catch (const InputError&) {
    return false;
  }
}

/// The folder of packages as it will lie beside the machine file, and the links whose meshes are nowhere or
/// no bodies.
void collect_meshes(const UrdfArm& arm, const MeshPlaces& places, MachineDraft& draft) {
  const auto unchecked = [&](const std::string& link) {
    if (std::find(draft.unchecked.begin(), draft.unchecked.end(), link) == draft.unchecked.end())
      draft.unchecked.push_back(link);
  };
  for (const UrdfShape& shape : arm.shapes) {
    const auto* mesh = std::get_if<UrdfMesh>(&shape.form);
    if (!mesh) continue;
    const fs::path found = find_mesh(mesh->file, places);
    constexpr std::string_view kPackage = "package://";
    fs::path name = mesh->file;
    if (std::string_view(mesh->file).starts_with(kPackage))
      name = fs::path(kMeshFolder) / mesh->file.substr(kPackage.size());
    const bool outside =
        name.is_absolute() || *name.lexically_normal().begin() == ".." || mesh->file.starts_with("file://");
    if (found.empty() || outside || !is_body(found, mesh->scale)) {
      unchecked(shape.link);
      continue;
    }
    const auto same = [&](const DraftFile& file) { return file.name == name.string(); };
    if (std::none_of(draft.files.begin(), draft.files.end(), same))
      draft.files.push_back({name.string(), read_file(found)});
  }
}

struct Placed {
  TablePlace table;
  Vec3 tip{0, 0, 0}, tool{0, 0, 1};  // in the tool link's frame
  double length_scale = 0.3;
};

Placed place(const UrdfArm& arm) {
  Placed placed;
  const Vec3 out = outward(arm);
  placed.tip = kToolLength * out;
  placed.tool = -out;
  kinematics::ChainDescription description;
  description.kind = "chain";
  description.chain = arm.chain;
  description.length_scale = placed.length_scale;
  description.chain.X_OT_zero = arm.chain.X_OT_zero * make_pose(shortest_arc_from_z(placed.tool), placed.tip);
  for (std::size_t i = 0; i < description.chain.axes.size(); ++i) {
    const ChainAxis& axis = description.chain.axes[i];
    description.home[i] = std::clamp(0.0, axis.lower, axis.upper);
  }
  placed.table = find_table_place(description, 0.4 * kTableSize);
  return placed;
}

bool lacks_mass(const UrdfArm& arm) {
  for (int i = 0; i < arm.chain.size(); ++i)
    if (std::none_of(arm.links.begin(), arm.links.end(),
                     [&](const LinkMass& l) { return l.axis == i && l.mass > 0; }))
      return true;
  return false;
}

std::string geometry_text(const UrdfDraftRequest& request, const UrdfArm& arm, const Placed& placed,
                          const MachineDraft& draft) {
  std::string text = fmt::format("geometry:\n  urdf: {}\n", kUrdfName);
  if (!request.srdf.empty()) text += "  srdf: arm.srdf\n";
  const bool packed = std::any_of(draft.files.begin(), draft.files.end(), [](const DraftFile& file) {
    return file.name.starts_with(std::string(kMeshFolder) + "/");
  });
  if (packed) text += fmt::format("  packages: {}\n", kMeshFolder);
  std::vector<std::string> unchecked;
  for (const std::string& link : draft.unchecked) unchecked.push_back(quoted(link));
  if (!unchecked.empty())
    text += fmt::format(
        "  # Their meshes were not found, or are no bodies: put them beside this file and take the links "
        "out.\n"
        "  unchecked_links: [{}]\n",
        fmt::join(unchecked, ", "));
  text += fmt::format("  base_link: {}\n  tool_link: {}\n  tip_mm: {}\n  tool_direction: {}\n",
                      quoted(draft.base_link), quoted(draft.tool_link), triple(1e3 * placed.tip),
                      triple(placed.tool));
  if (arm.chain.work_axis < 0) {
    const Vec3 base = -1e3 * placed.table.centre_B;
    text += fmt::format("  base_mm: {}\n  base_turn_deg: 0\n",
                        triple(Vec3(rounded(base.x(), 1), rounded(base.y(), 1), rounded(base.z(), 1))));
  }
  text += fmt::format("conditioning:\n  length_scale_mm: {}\n", number(1e3 * placed.length_scale));
  if (arm.chain.size() >= 6 && placed.table.found)
    text += fmt::format("  condition_max: {}\n",
                        number(std::max(kConditionMax, 100 * std::ceil(0.03 * placed.table.condition))));
  return text;
}

}  // namespace

MachineDraft draft_of_urdf(const UrdfDraftRequest& request) {
  MachineDraft draft;
  const bool guess = request.base_link.empty() || request.tool_link.empty();
  const UrdfEnds ends = guess ? likely_ends(request.urdf) : UrdfEnds{};
  draft.base_link = request.base_link.empty() ? ends.base : request.base_link;
  draft.tool_link = request.tool_link.empty() ? ends.tool : request.tool_link;
  const UrdfArm arm = read_urdf(request.urdf, draft.base_link, draft.tool_link);
  draft.axes = arm.chain.size();
  draft.files.push_back({kUrdfName, read_file(request.urdf)});
  if (!request.srdf.empty()) {
    (void)read_srdf(request.srdf, arm.link_names);
    draft.files.push_back({"arm.srdf", read_file(request.srdf)});
  }
  const fs::path beside = fs::absolute(request.urdf).parent_path();
  collect_meshes(arm, {request.urdf, request.packages.empty() ? beside : request.packages}, draft);
  const Placed placed = place(arm);
  if (!placed.table.found)
    draft.place_note =
        "no place for a table was found where the tool stands upright all over it: set geometry.base_mm "
        "and home yourself, or name another --tool-link";
  if (lacks_mass(arm)) draft.assumed.emplace_back(kAssumedMasses);
  for (const char* word : {"place", "home", "drives", "play", "tolerances", "tool", "motion"})
    if (arm.chain.work_axis < 0 || word != std::string("place")) draft.assumed.emplace_back(word);
  std::string text = fmt::format(
      "# Written by `understudy new-machine` from {}. Ranges, masses, velocities and collision shapes are "
      "the URDF's.\n"
      "name: {}\nmechanism: chain\n",
      printable(request.urdf.filename().string()), quoted(request.name));
  text += assumed_key(draft.assumed) + geometry_text(request, arm, placed, draft) + "axes:\n";
  for (std::size_t i = 0; i < arm.chain.axes.size(); ++i)
    text += axis_text(arm.chain.axes[i], arm.drives[i], placed.table.home[i]);
  draft.text = explained(text + kTail, machine_schema(), draft.assumed);
  return draft;
}

MachineDraft draft_of_kind(const std::string& kind, const std::string& name) {
  const std::vector<std::string> names = machine_names();
  if (std::find(names.begin(), names.end(), kind) == names.end()) {
    const std::string near = nearest_word(kind, names);
    throw InputError(fmt::format("unknown kind '{}'{}; known kinds: {}", kind,
                                 near.empty() ? "" : fmt::format(", did you mean '{}'?", near),
                                 fmt::join(names, ", ")));
  }
  const fs::path file = find_model(kind);
  std::string text = read_file(file);
  MachineDraft draft;
  std::set<std::string> there;
  const MapSchema schema = machine_schema();
  (void)explained_yaml(text, schema, [&](const std::string& path) {
    there.insert(assumption_of(path));
    return std::string();
  });
  for (const std::string& word : assumption_words())
    if (there.contains(word)) draft.assumed.push_back(word);
  const std::string urdf = urdf_named_in(text, file);
  if (!urdf.empty()) draft.files.push_back({urdf, read_file(file.parent_path() / urdf)});
  const std::size_t at = text.starts_with("name:") ? 0 : text.find("\nname:") + 1;
  const std::size_t end = text.find('\n', at);
  text.replace(at, end - at, fmt::format("name: {}\n{}", quoted(name), assumed_key(draft.assumed)));
  text.insert(0, fmt::format("# Written by `understudy new-machine` from the ready machine `{}`:\n", kind));
  draft.text = explained(text, schema, draft.assumed);
  return draft;
}

}  // namespace understudy::machine
