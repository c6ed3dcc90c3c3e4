#include "sim/as_built/as_built_file.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include <fmt/format.h>

#include "core/output_file.h"
#include "core/units.h"
#include "core/yaml_map.h"

namespace understudy::sim {
namespace {

constexpr Bounds kPlace{-5000, 5000};
constexpr Bounds kPlay{0, 2000};
constexpr double kUnitTolerance = 1e-6;  // of a direction's length, as the file's digits leave it

template <typename Value>
void read_if_given(YamlMap& map, const std::string& key, Bounds bounds, const char* about, Value& value) {
  if (!map.has(key)) return;
  if constexpr (std::is_same_v<Value, Vec3>)
    value = map.vector(key, bounds, about);
  else
    value = map.quantity(key, bounds, about);
}

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
  read_if_given(map, "base_joint_mm", kPlace, "b_i in B", built.hexapod.base_joint[s]);
  read_if_given(map, "platform_joint_mm", kPlace, "a_i in T", built.hexapod.platform_joint[s]);
  read_if_given(map, "length_offset_mm", kPlace, "strut length at drive displacement 0",
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
  read_if_given(map, "point_mm", kPlace, "a point on the axis, in O", axis.point);
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
    read_if_given(map, "zero_mm", kPlace, kZero, built.axis_zero[i]);
    read_if_given(map, "play_um", kPlay, kFree, built.axis_play[i]);
  }
}

/// `position` and `rotation` are keys.
void read_mount(YamlMap& map, const std::string& position, const std::string& rotation, const char* about,
                Pose& mount) {
  Vec3 p = mount.translation();
  read_if_given(map, position, kPlace, about, p);
  mount.translation() = p;
  if (!map.has(rotation)) return;
  const auto q = map.quantities(rotation, 4, {-1, 1}, "its rotation in O: w, x, y, z, of unit length");
  if (map.recording()) return;
  const Quat turn(q[0], q[1], q[2], q[3]);
  if (std::abs(turn.norm() - 1) > kUnitTolerance)
    throw InputError(map.place(rotation),
                     fmt::format("{} has length {:.7f}, not 1", map.path(rotation), turn.norm()));
  mount = make_pose(turn.normalized(), p);
}

void read_built(YamlMap& root, AsBuilt& built) {
  Told told{};
  if (root.either("the machine is a hexapod", built.chain.axes.empty())) {
    read_if_given(root, "deviation_mm", {0, 500}, "distance of a screw's axis from its base joint",
                  built.hexapod.deviation);
    if (root.has("struts"))
      root.list("struts", 0, "those that differ",
                [&](YamlMap& strut, std::size_t) { read_strut(strut, told, built); });
    return;
  }
  read_mount(root, "tip_mm", "tool_quaternion", "the tip in O with all axes at 0", built.chain.X_OT_zero);
  read_mount(root, "work_mm", "work_quaternion", "the work's origin in O with all axes at 0",
             built.chain.X_OS_zero);
  if (root.has("axes"))
    root.list("axes", 0, "those that differ",
              [&](YamlMap& axis, std::size_t) { read_axis(axis, told, built); });
}

std::string text(const Vec3& v, double unit) {
  return fmt::format("[{}, {}, {}]", v.x() / unit, v.y() / unit, v.z() / unit);
}

std::string rotation_text(const Pose& X) {
  const Quat q(X.linear());
  return fmt::format("[{}, {}, {}, {}]", q.w(), q.x(), q.y(), q.z());
}

}  // namespace

void read_as_built(const std::string& file, AsBuilt& built) {
  if (!std::filesystem::is_regular_file(file))
    throw InputError(fmt::format(
        "as-built \"{}\" is not one of nominal, sampled, manufactured, calibrated, nor a file", file));
  YamlMap::read_text(read_file(file), file, [&built](YamlMap& root) { read_built(root, built); });
}

MapSchema as_built_schema() {
  AsBuilt built;
  built.chain.axes.resize(1);
  return YamlMap::schema([&built](YamlMap& root) { read_built(root, built); });
}

std::string write_as_built(const AsBuilt& built) {
  std::string out = fmt::format("# As built: {}, seed {}. Every parameter that the plant uses.\n",
                                built.source, built.seed);
  if (built.chain.axes.empty()) {
    out += fmt::format("deviation_mm: {}\nstruts:\n", to_mm(built.hexapod.deviation));
    for (std::size_t s = 0; s < kinematics::kStruts; ++s)
      out += fmt::format(
          "  - {{strut: {}, base_joint_mm: {}, platform_joint_mm: {}, length_offset_mm: {}, nut_play_um: {}, "
          "ball_play_um: {}}}\n",
          s + 1, text(built.hexapod.base_joint[s], kMillimetre),
          text(built.hexapod.platform_joint[s], kMillimetre), to_mm(built.hexapod.length_offset[s]),
          to_um(built.nut_play[s]), to_um(built.ball_play[s]));
    return out;
  }
  const Pose &X_OT = built.chain.X_OT_zero, &X_OS = built.chain.X_OS_zero;
  out += fmt::format("tip_mm: {}\ntool_quaternion: {}\nwork_mm: {}\nwork_quaternion: {}\naxes:\n",
                     text(X_OT.translation(), kMillimetre), rotation_text(X_OT),
                     text(X_OS.translation(), kMillimetre), rotation_text(X_OS));
  for (std::size_t i = 0; i < built.chain.axes.size(); ++i) {
    const kinematics::ChainAxis& axis = built.chain.axes[i];
    out += fmt::format("  - {{axis: {}, direction: {}, point_mm: {}, ", axis.name, text(axis.direction, 1),
                       text(axis.point, kMillimetre));
    out += axis.angle ? fmt::format("zero_deg: {}, play_arcmin: {}}}\n", to_deg(built.axis_zero[i]),
                                    60 * to_deg(built.axis_play[i]))
                      : fmt::format("zero_mm: {}, play_um: {}}}\n", to_mm(built.axis_zero[i]),
                                    to_um(built.axis_play[i]));
  }
  return out;
}

}  // namespace understudy::sim
