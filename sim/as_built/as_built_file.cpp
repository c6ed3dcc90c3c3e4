#include "sim/as_built/as_built_file.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "core/file/is_file.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/units.h"
#include "core/yaml/changed_file.h"
#include "core/yaml/yaml_map.h"
#include "machine/file/section_text.h"
#include "sim/as_built/file_parts.h"
#include "sim/as_built/world_file.h"

namespace understudy::sim {
namespace {

constexpr Bounds kPlay{0, 2000};

/// A part of the machine may be told once.
using Told = kinematics::PerAxis<bool>;

void tell(const YamlMap& map, const std::string& key, std::size_t index, Told& told) {
  if (told[index] && !map.recording())
    throw InputError(map.place(key), fmt::format("{} names a part that was told before", map.path(key)));
  told[index] = true;
}

void read_strut(YamlMap& map, Told& told, AsBuilt& built) {
  const int number = map.integer("strut", 1, kinematics::kStruts, "its number");
  map.require("strut");
  const auto s = static_cast<std::size_t>(number - 1);
  tell(map, "strut", s, told);
  read_if_given(map, "base_joint_mm", kPlaceBounds, "b_i in B", built.hexapod.base_joint[s]);
  read_if_given(map, "platform_joint_mm", kPlaceBounds, "a_i in T", built.hexapod.platform_joint[s]);
  read_if_given(map, "length_offset_mm", kPlaceBounds, "strut length at drive displacement 0",
                built.hexapod.length_offset[s]);
  read_if_given(map, "nut_play_um", kPlay, "total free travel of its nut", built.nut_play[s]);
  read_if_given(map, "ball_play_um", kPlay, "total free travel of its ball joint", built.ball_play[s]);
}

void read_axis(YamlMap& map, Told& told, AsBuilt& built) {
  std::vector<std::string> names;
  if (!map.recording())
    for (const auto& axis : built.chain.axes) names.push_back(axis.name);
  const std::string name = map.word("axis", names, "its name in the machine file");
  map.require("axis");
  const auto i = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  tell(map, "axis", i, told);
  kinematics::ChainAxis& axis = built.chain.axes[i];
  read_if_given(map, "point_mm", kPlaceBounds, "a point on the axis, in O", axis.point);
  read_if_given(map, "direction", {-1, 1}, "unit vector in O", axis.direction);
  if (std::abs(axis.direction.norm() - 1) > kUnitTolerance && !map.recording())
    throw InputError(map.place("direction"), fmt::format("{} has length {:.7f}, not 1", map.path("direction"),
                                                         axis.direction.norm()));
  axis.direction.normalize();
  constexpr const char* kZero = "where the axis truly is when its drive reads 0";
  constexpr const char* kFree = "total free travel";
  if (map.either("the axis turns", axis.angle)) {
    read_if_given(map, "zero_deg", {-360, 360}, kZero, built.axis_zero[i]);
    read_if_given(map, "play_arcmin", {0, 600}, kFree, built.axis_play[i]);
  } else {
    read_if_given(map, "zero_mm", kPlaceBounds, kZero, built.axis_zero[i]);
    read_if_given(map, "play_um", kPlay, kFree, built.axis_play[i]);
  }
  if (!built.chain.rods.empty())
    read_if_given(map, "rod_mm", {1, 10'000}, "length of the rods of this axis", built.chain.rods[i]);
}

void read_geometry(YamlMap& root, AsBuilt& built) {
  Told told{};
  if (root.either("the machine is a hexapod", built.chain.axes.empty())) {
    read_if_given(root, "deviation_mm", {0, 500}, "distance of a screw's axis from its base joint",
                  built.hexapod.deviation);
    if (root.has("struts"))
      root.list("struts", 0, "those that differ",
                [&](YamlMap& strut, std::size_t) { read_strut(strut, told, built); });
    return;
  }
  read_mount(root, {"tip_mm", "tool_quaternion", "the tip in O with all axes at 0"}, built.chain.X_OT_zero);
  read_mount(root, {"work_mm", "work_quaternion", "the work's origin in O with all axes at 0"},
             built.chain.X_OS_zero);
  if (root.has("axes"))
    root.list("axes", 0, "those that differ",
              [&](YamlMap& axis, std::size_t) { read_axis(axis, told, built); });
}

void read_built(YamlMap& root, AsBuilt& built) {
  if (root.has("machine")) {
    const std::string name = root.text("machine", "name of the machine that it tells of, as its file has it");
    if (!root.recording() && name != built.machine)
      root.fail("machine", fmt::format("this is the truth of a machine '{}', and --machine is a '{}'",
                                       printable(name), printable(built.machine)));
  }
  read_geometry(root, built);
  read_world(root, built);
}

std::string geometry_text(const AsBuilt& built) {
  if (built.chain.axes.empty()) {
    std::string out = fmt::format("deviation_mm: {}\nstruts:\n", to_mm(built.hexapod.deviation));
    for (std::size_t s = 0; s < kinematics::kStruts; ++s)
      out += fmt::format(
          "  - {{strut: {}, base_joint_mm: {}, platform_joint_mm: {}, length_offset_mm: {}, nut_play_um: {}, "
          "ball_play_um: {}}}\n",
          s + 1, vector_text(built.hexapod.base_joint[s], kMillimetre),
          vector_text(built.hexapod.platform_joint[s], kMillimetre), to_mm(built.hexapod.length_offset[s]),
          to_um(built.nut_play[s]), to_um(built.ball_play[s]));
    return out;
  }
  const Pose &X_OT = built.chain.X_OT_zero, &X_OS = built.chain.X_OS_zero;
  std::string out = fmt::format("tip_mm: {}\ntool_quaternion: {}\nwork_mm: {}\nwork_quaternion: {}\naxes:\n",
                                vector_text(X_OT.translation(), kMillimetre), rotation_text(X_OT),
                                vector_text(X_OS.translation(), kMillimetre), rotation_text(X_OS));
  for (std::size_t i = 0; i < built.chain.axes.size(); ++i) {
    const kinematics::ChainAxis& axis = built.chain.axes[i];
    out += fmt::format("  - {{axis: {}, direction: {}, point_mm: {}, ", machine::quoted_text(axis.name),
                       vector_text(axis.direction, 1), vector_text(axis.point, kMillimetre));
    if (!built.chain.rods.empty()) out += fmt::format("rod_mm: {}, ", to_mm(built.chain.rods[i]));
    out += axis.angle ? fmt::format("zero_deg: {}, play_arcmin: {}}}\n", to_deg(built.axis_zero[i]),
                                    60 * to_deg(built.axis_play[i]))
                      : fmt::format("zero_mm: {}, play_um: {}}}\n", to_mm(built.axis_zero[i]),
                                    to_um(built.axis_play[i]));
  }
  return out;
}

}  // namespace

void read_as_built(const std::string& file, AsBuilt& built) {
  const std::string path = changed_file(file).file;
  if (!is_file(path))
    throw InputError(fmt::format(
        "as-built \"{}\" is not one of nominal, sampled, manufactured, calibrated, nor a file", file));
  YamlMap::read_text(read_file(path), file, [&built](YamlMap& root) { read_built(root, built); });
}

MapSchema as_built_schema() {
  AsBuilt built;
  built.chain.axes.resize(1);
  built.chain.rods.resize(1);
  return YamlMap::schema([&built](YamlMap& root) { read_built(root, built); });
}

std::string file_of(const AsBuilt& built) {
  return is_file(changed_file(built.source).file) ? built.source : "";
}

std::string write_as_built(const AsBuilt& built) {
  return fmt::format("# As built: {}, seed {}. Every parameter that the plant uses.\nmachine: {}\n",
                     printable(built.source), built.seed, machine::quoted_text(built.machine)) +
         geometry_text(built) + write_world(built);
}

}  // namespace understudy::sim
