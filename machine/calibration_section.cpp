#include "machine/calibration_section.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::machine {
namespace {

constexpr Bounds kPlace{-5000, 5000};
constexpr double kUnitTolerance = 1e-6;  // of a direction or quaternion, as the file's digits leave it

void read_record(YamlMap& map, CalibrationRecord& record) {
  record.estimator = map.text("estimator");
  record.measurements = map.text("measurements");
  record.measurements_sha256 = map.text("measurements_sha256");
  record.poses = map.integer("poses", 1, 1000000);
  record.tip_sigma = map.quantity("tip_sigma_um", {0, 1e5});
}

void check_near(const YamlMap& map, const std::string& key, const std::string& what, double apart) {
  if (apart > kFarFromDrawing)
    throw InputError(map.place(key),
                     fmt::format("{} is {:.1f} mm from where geometry has it, more than {:.0f} mm: is this "
                                 "the calibration of another machine?",
                                 what, to_mm(apart), to_mm(kFarFromDrawing)));
}

void read_struts(YamlMap& map, HexapodModel& hexapod) {
  kinematics::HexapodGeometry& g = hexapod.geometry;
  const kinematics::HexapodGeometry& drawn = hexapod.design;
  g.deviation = map.quantity("deviation_mm", {0, 500});
  const Place place = map.place("struts");
  std::size_t count = 0;
  map.list("struts", [&](YamlMap& strut) {
    if (count == kinematics::kStruts)
      throw InputError(strut.place(), fmt::format("{} lists more than {} struts", map.path("struts"), count));
    const std::size_t i = count++;
    g.base_joint[i] = strut.vector("base_joint_mm", kPlace);
    g.platform_joint[i] = strut.vector("platform_joint_mm", kPlace);
    g.length_offset[i] = strut.quantity("length_offset_mm", {0, 5000});
    if (!strut.complete()) return;
    const auto part = [&](const char* what) { return fmt::format("{} {}", what, i + 1); };
    check_near(strut, "base_joint_mm", part("base joint"), (g.base_joint[i] - drawn.base_joint[i]).norm());
    check_near(strut, "platform_joint_mm", part("platform joint"),
               (g.platform_joint[i] - drawn.platform_joint[i]).norm());
    check_near(strut, "length_offset_mm", part("length offset"),
               std::abs(g.length_offset[i] - drawn.length_offset[i]));
  });
  if (count > 0 && count < kinematics::kStruts)
    throw InputError(
        place, fmt::format("{} lists {} struts, not {}", map.path("struts"), count, kinematics::kStruts));
}

Pose read_mount(YamlMap& map, const std::string& body, const Pose& drawn) {
  const std::string quaternion = body + "_quaternion", place = body + "_mm";
  const auto q = map.quantities(quaternion, 4, {-1, 1});
  const Vec3 p = map.vector(place, kPlace);
  if (!map.complete()) return drawn;
  const Quat turn(q[0], q[1], q[2], q[3]);
  if (std::abs(turn.norm() - 1) > kUnitTolerance)
    throw InputError(map.place(quaternion),
                     fmt::format("{} has length {:.7f}, not 1", map.path(quaternion), turn.norm()));
  check_near(map, place, body + " at zero", (p - drawn.translation()).norm());
  return make_pose(turn.normalized(), p);
}

void read_axis(YamlMap& map, const kinematics::ChainAxis& drawn, kinematics::ChainAxis& axis) {
  const std::string name = map.text("axis");
  axis.direction = map.vector("direction", {-1, 1});
  if (drawn.angle) axis.point = map.vector("point_mm", kPlace);
  if (!map.complete()) return;
  if (name != drawn.name)
    throw InputError(map.place("axis"),
                     fmt::format("{} is '{}', where axes has '{}'", map.path("axis"), name, drawn.name));
  if (std::abs(axis.direction.norm() - 1) > kUnitTolerance)
    throw InputError(map.place("direction"), fmt::format("{} has length {:.7f}, not 1", map.path("direction"),
                                                         axis.direction.norm()));
  axis.direction.normalize();
  const double turned = std::acos(std::clamp(axis.direction.dot(drawn.direction), -1.0, 1.0));
  if (turned > kTurnedFromDrawing)
    throw InputError(map.place("direction"),
                     fmt::format("axis {} is turned by {:.1f} deg from where geometry has it, more than "
                                 "{:.1f} deg: is this the calibration of another machine?",
                                 name, to_deg(turned), to_deg(kTurnedFromDrawing)));
  if (drawn.angle)
    check_near(map, "point_mm", "axis " + name, drawn.direction.cross(axis.point - drawn.point).norm());
}

void read_chain_calibration(YamlMap& map, MachineDescription& machine) {
  ChainModel& model = machine.chain();
  if (machine.mechanism != "arm" && machine.mechanism != "chain")
    throw InputError(map.place(),
                     fmt::format("a calibrated '{}' has no inverse kinematics here: only hexapod, "
                                 "arm and chain can have a calibration",
                                 machine.mechanism));
  kinematics::Chain& chain = model.kinematics.chain;
  const kinematics::Chain drawn = chain;
  chain.X_OT_zero = read_mount(map, "tool", drawn.X_OT_zero);
  chain.X_OS_zero = read_mount(map, "work", drawn.X_OS_zero);
  const Place place = map.place("axes");
  std::size_t count = 0;
  map.list("axes", [&](YamlMap& axis) {
    const std::size_t i = count++;
    if (i < chain.axes.size()) return read_axis(axis, drawn.axes[i], chain.axes[i]);
    throw InputError(axis.place(), fmt::format("{} lists more than {} axes", map.path("axes"), i));
  });
  if (count > 0 && count < chain.axes.size())
    throw InputError(place, fmt::format("{} lists {} axes, the machine has {}", map.path("axes"), count,
                                        chain.axes.size()));
  if (!map.complete()) return;
  model.kinematics.design = drawn;
  machine.X_BT_home = kinematics::forward(chain, model.kinematics.home);
}

}  // namespace

void read_calibration(YamlMap& root, MachineDescription& machine) {
  if (!root.complete()) {  // without the geometry there is nothing to compare with
    root.has("calibration");
    return;
  }
  root.section("calibration", [&](YamlMap& map) {
    read_record(map, machine.calibration.emplace());
    if (machine.is_chain())
      read_chain_calibration(map, machine);
    else
      read_struts(map, machine.hexapod);
  });
}

}  // namespace understudy::machine
