#include "machine/file/chain_section.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "machine/file/rods_section.h"
#include "machine/file/tool_section.h"
#include "machine/file/urdf_section.h"

namespace understudy::machine {
namespace {

using kinematics::Chain;
using kinematics::ChainAxis;
using kinematics::ChainKind;

constexpr Bounds kPlace{-5000, 5000};
constexpr double kSameLine = 1e-6;  // [m] or [rad]; two turning axes nearer than this are one

Vec3 read_direction(YamlMap& map, const std::string& key, const char* about) {
  const Vec3 direction = map.vector(key, {-1, 1}, about);
  if (!map.complete()) return Vec3::UnitZ();
  if (direction.norm() < 0.1)
    throw InputError(map.place(key),
                     fmt::format("{} has length {:g}: no direction", map.path(key), direction.norm()));
  return direction.normalized();
}

/// The name of an axis, or "frame", as a key of the file gives it.
struct Carrier {
  std::string name, path;
  Place place;
};

Carrier read_carrier(YamlMap& map, const std::string& key, const char* about) {
  return {map.text(key, about), map.path(key), map.place(key)};
}

int find_axis(const Chain& chain, const Carrier& carrier) {
  if (carrier.name == "frame" || carrier.name.empty()) return -1;  // a key that is missing is told at the end
  std::string known = "frame";
  for (int i = 0; i < chain.size(); ++i) {
    const std::string& axis = chain.axes[i].name;
    if (axis == carrier.name) return i;
    known += ", " + axis;
  }
  throw InputError(carrier.place,
                   fmt::format("{} is '{}', not one of {}", carrier.path, carrier.name, known));
}

/// Axes are told apart by name, in other programs' files as well: letters, digits, and what joins them.
void check_name(const YamlMap& map, const Chain& chain, const std::string& name) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(map.place("name"), fmt::format("{} is '{}', {}", map.path("name"), name, why));
  };
  for (int i = 0; i < chain.size(); ++i)
    if (chain.axes[i].name == name) refuse(fmt::format("as axis {} is", i + 1));
  for (const char* taken : {"frame", "work", "tool", "tip", "world"})
    if (name == taken) refuse("which means something else");
  for (const char c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != ' ' && c != '_' && c != '-')
      refuse("where letters, digits, spaces, - and _ are allowed");
}

/// Of a kind whose file lists its axes: where the axis is.
ChainAxis read_line(YamlMap& map, const Chain& chain) {
  ChainAxis axis;
  axis.name = map.text("name", "letters, digits, spaces, - and _");
  if (map.complete()) check_name(map, chain, axis.name);
  axis.angle = map.word("moves", {"turns", "slides"}, "turns or slides") == "turns";
  axis.direction = read_direction(map, "direction", "in O; a turn is right-handed about it");
  if (axis.angle) axis.point = map.vector("point_mm", kPlace, "a point on the axis, in O");
  axis.parent = find_axis(chain, read_carrier(map, "carried_by", "an axis further up in the list, or frame"));
  return axis;
}

void read_range(YamlMap& map, ChainAxis& axis) {
  const bool given = std::isfinite(axis.lower) && std::isfinite(axis.upper);  // by a URDF
  if (given && !map.has(axis.angle ? "range_deg" : "range_mm")) return;
  if (axis.angle && map.has("endless")) {
    if (map.word("endless", {"yes", "no"}, "yes: no range") == "yes") return;
  }
  const std::string key = axis.angle ? "range_deg" : "range_mm";
  const auto range =
      map.quantities(key, 2, axis.angle ? Bounds{-3600, 3600} : kPlace, "lowest and highest position");
  if (!map.complete()) return;
  axis.lower = range[0];
  axis.upper = range[1];
  const double unit = axis.angle ? kDegree : kMillimetre;
  if (axis.lower >= axis.upper)
    throw InputError(map.place(key),
                     fmt::format("{} begins at {:g} and ends at {:g} {}, not above it", map.path(key),
                                 axis.lower / unit, axis.upper / unit, axis.angle ? "deg" : "mm"));
}

double read_home(YamlMap& map, const ChainAxis& axis) {
  const std::string key = axis.angle ? "home_deg" : "home_mm";
  const double home =
      map.quantity(key, axis.angle ? Bounds{-3600, 3600} : kPlace, "where the machine starts");
  if (!map.complete() || (home >= axis.lower && home <= axis.upper)) return home;
  const double unit = axis.angle ? kDegree : kMillimetre;
  throw InputError(map.place(key),
                   fmt::format("{} is {:g} {}, outside the axis' range of {:g} to {:g}", map.path(key),
                               home / unit, axis.angle ? "deg" : "mm", axis.lower / unit, axis.upper / unit));
}

Link read_link(YamlMap& map) {
  Link link;
  link.mass = map.quantity("mass_kg", {1e-4, 1e4}, "of the body between this axis and the next");
  link.centre_O = map.vector("centre_mm", kPlace, "centre of mass in O, all axes at 0");
  link.inertia_O = read_inertia(map, "inertia_kg_mm2", "about the centre along O's axes").asDiagonal();
  if (map.has("bodies")) read_bodies(map, link.bodies);
  return link;
}

/// Two turning axes on one line, one carried by the other, are a single joint to any load.
void check_apart(const YamlMap& map, const Chain& chain, std::size_t index) {
  const ChainAxis& axis = chain.axes[index];
  if (axis.parent < 0 || !axis.angle) return;
  const ChainAxis& parent = chain.axes[axis.parent];
  if (!parent.angle || axis.direction.cross(parent.direction).norm() > kSameLine) return;
  const double distance = axis.direction.cross(axis.point - parent.point).norm();
  if (distance <= kSameLine)
    throw InputError(map.place(), fmt::format("axes {} and {} coincide: their lines are {:.4f} mm apart",
                                              parent.name, axis.name, to_mm(distance)));
}

/// For the schema, which reads no URDF: every axis that one may have.
ChainAxis any_urdf_axis(YamlMap& map) {
  ChainAxis axis;
  axis.angle = map.either("the axis turns", true);
  if (map.either("the URDF gives its range", true)) axis.lower = axis.upper = 0;
  return axis;
}

void assume_mass(MachineDescription& machine, std::size_t axis, MachineNotes& notes) {
  const Link rod = assumed_link(machine.chain().kinematics.chain, static_cast<int>(axis));
  Link& link = machine.chain().links[axis];
  link = {rod.mass, rod.centre_O, rod.inertia_O, std::move(link.bodies)};
  if (std::find(notes.assumed.begin(), notes.assumed.end(), kAssumedMasses) == notes.assumed.end())
    notes.assumed.emplace_back(kAssumedMasses);
}

void read_axis(YamlMap& map, bool listed, std::size_t index, MachineDescription& machine,
               MachineNotes& notes) {
  ChainModel& model = machine.chain();
  Chain& chain = model.kinematics.chain;
  if (listed) {
    if (index >= kinematics::kMaxAxes)
      throw InputError(map.place(), fmt::format("more than {} axes", kinematics::kMaxAxes));
    chain.axes.resize(index);
    chain.axes.push_back(read_line(map, chain));
  } else if (index >= chain.axes.size()) {
    throw InputError(map.place(), fmt::format("{} axes are given, '{}' has {}", index + 1,
                                              model.kinematics.kind, chain.axes.size()));
  } else if (const std::string name = map.text("name", "letters, digits, spaces, - and _");
             name != chain.axes[index].name && map.complete()) {
    throw InputError(map.place("name"),
                     fmt::format("{} is '{}', where axis {} of '{}' is '{}'", map.path("name"), name,
                                 index + 1, model.kinematics.kind, chain.axes[index].name));
  }
  ChainAxis& axis = chain.axes[index];
  const bool of_urdf = !listed && model.kinematics.parameters.empty();
  if (of_urdf && map.recording()) axis = any_urdf_axis(map);
  read_range(map, axis);
  model.kinematics.home[index] = read_home(map, axis);
  map.section("drive", "motor and gear",
              [&](YamlMap& drive) { read_drive(drive, axis.angle, machine.drives[index]); });
  model.play[index] = axis.angle ? map.quantity("play_arcmin", {0, 600}, "total free travel")
                                 : map.quantity("play_um", {0, 2000}, "total free travel");
  const std::string friction = axis.angle ? "friction_newton_metre" : "friction_n";
  model.friction[index] =
      map.has(friction)
          ? map.quantity(friction, {0, 1000}, "a smaller load leaves the axis where it is within its play")
          : 0.0;
  if (index >= model.links.size()) model.links.emplace_back();
  Link& told = model.links[index];  // by a URDF; its mass may be told anew, its bodies stay
  if (!of_urdf || map.has("link"))
    map.section("link", "what the axis carries, told in O with all axes at 0", [&](YamlMap& link) {
      const std::vector<geometry::Shape> bodies = std::move(told.bodies);
      told = read_link(link);
      told.bodies.insert(told.bodies.begin(), bodies.begin(), bodies.end());
    });
  else if (told.mass == 0 && map.complete())
    assume_mass(machine, index, notes);
  if (map.complete()) check_apart(map, chain, index);
}

/// An axis that moves neither the tool nor the work is a mistake in what another one is carried by.
/// `places`: of each axis in the file.
void check_all_carry(const Chain& chain, const std::vector<Place>& places) {
  std::vector<bool> carries(chain.axes.size(), false);
  for (int from : {chain.tool_axis, chain.work_axis})
    for (int axis = from; axis >= 0; axis = chain.axes[static_cast<std::size_t>(axis)].parent)
      carries[static_cast<std::size_t>(axis)] = true;
  for (std::size_t i = 0; i < carries.size(); ++i)
    if (!carries[i])
      throw InputError(places[i], fmt::format("axis {} carries neither the tool nor the work: look at "
                                              "carried_by of the axes behind it, at tool_carried_by and "
                                              "at work_carried_by",
                                              chain.axes[i].name));
}

/// The tool at zero, for chains that list their axes.
Pose read_tool_mount(YamlMap& map) {
  const Vec3 tip =
      map.vector("tip_mm", kPlace, "the tip, in O with all axes at 0; with a URDF, on its tool_link");
  return make_pose(shortest_arc_from_z(read_direction(map, "tool_direction", "from the tip into the tool")),
                   tip);
}

void read_base(YamlMap& map, MachineDescription& machine) {
  const Vec3 base = map.vector("base_mm", kPlace, "B in W");
  const double turn = map.quantity("base_turn_deg", {-360, 360}, "turn of B about z of W");
  machine.X_WB = make_pose(Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ())), base);
}

}  // namespace

void read_chain(YamlMap& root, MachineDescription& machine, MachineNotes& notes) {
  ChainModel& model = machine.model.emplace<machine::ChainModel>();
  model.kinematics.kind = machine.mechanism;
  const ChainKind& kind = *kinematics::find_chain_kind(machine.mechanism);
  Chain& chain = model.kinematics.chain;
  const bool from_urdf = kind.chain == nullptr && root.has("geometry.urdf");
  const bool listed = kind.chain == nullptr && !from_urdf;
  Carrier tool, work;
  Place base;
  bool based = false;
  root.section("geometry", "the mechanism as drawn", [&](YamlMap& map) {
    model.kinematics.parameters.clear();
    for (const auto& parameter : kind.parameters)
      model.kinematics.parameters.push_back(
          map.quantity(parameter.key, {parameter.low, parameter.high}, parameter.about));
    base = map.place("base_mm");
    if (map.has("base_mm")) read_base(map, machine);
    based = map.has("base_mm");
    if (kind.chain) {
      chain = kind.chain(model.kinematics.parameters);
      return;
    }
    if (from_urdf) return read_urdf_chain(map, read_tool_mount(map), machine, notes);
    tool = read_carrier(map, "tool_carried_by", "name of an axis, or frame");
    work = read_carrier(map, "work_carried_by", "name of an axis, or frame");
    chain.X_OT_zero = read_tool_mount(map);
  });
  root.section("conditioning", "how axes are weighed against each other", [&](YamlMap& map) {
    model.kinematics.length_scale =
        map.quantity("length_scale_mm", {1, 5000}, "a radian weighs as much as this");
    if (map.has("condition_max"))
      model.kinematics.condition_max = map.quantity("condition_max", {1, 1e6}, "of the Jacobian");
  });
  std::size_t count = 0;
  std::vector<Place> places;
  root.list("axes", kind.chain ? chain.axes.size() : 0, "range, drive, play and body of each axis",
            [&](YamlMap& map, std::size_t index) {
              read_axis(map, listed, index, machine, notes);
              count = index + 1;
              places.push_back(map.place());
            });
  if (root.has("frame"))
    root.section("frame", "what stands still", [&](YamlMap& map) { read_bodies(map, model.frame_bodies); });
  read_rods(root, model);
  if (!root.complete()) return;
  if (count < chain.axes.size())
    throw InputError(root.place("axes"), fmt::format("axes lists {}, '{}' has {}", count,
                                                     model.kinematics.kind, chain.axes.size()));
  if (listed) {
    chain.tool_axis = find_axis(chain, tool);
    chain.work_axis = find_axis(chain, work);
    if (chain.rods.empty()) check_all_carry(chain, places);
  }
  check_rods(root, model);
  if (chain.work_axis >= 0 && based)
    throw InputError(
        base, "geometry.base_mm is given, but axes carry the work: the world stands on it, not on the frame");
  machine.X_BT_home = kinematics::forward(chain, model.kinematics.home);
}

}  // namespace understudy::machine
