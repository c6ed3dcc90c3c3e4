#include "machine/file/calibration_section.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "machine/file/mount_key.h"

namespace understudy::machine {
namespace {

constexpr Bounds kPlace{-5000, 5000};
constexpr double kUnitTolerance = 1e-6;  // of a direction, as the file's digits leave it

void read_record(YamlMap& map, CalibrationRecord& record) {
  record.estimator = map.text("estimator", "the one that found it");
  record.measurements = map.text("measurements", "name of the table of measured poses");
  record.measurements_sha256 = map.text("measurements_sha256", "checksum of its bytes");
  record.poses = map.integer("poses", 1, 1000000, "rows of that table");
  if (map.has("tip_sigma_um"))
    record.tip_sigma =
        map.quantity("tip_sigma_um", {0, 1e5}, "3D uncertainty of the tip, 1 sigma, RMS over the work space");
}

void check_near(const YamlMap& map, const std::string& key, const std::string& what, double apart,
                double limit = kFarFromDrawing) {
  if (apart > limit)
    throw InputError(map.place(key),
                     fmt::format("{} is {:.1f} mm from where geometry has it, more than {:.0f} mm: is this "
                                 "the calibration of another machine?",
                                 what, to_mm(apart), to_mm(limit)));
}

/// How far a chain's axes and mounts may be from their drawing: zeros of axes before them swing them about.
double chain_limit(const kinematics::Chain& drawn) {
  double reach = 0;
  for (const kinematics::ChainAxis& from : drawn.axes) {
    if (!from.angle) continue;
    for (const kinematics::ChainAxis& to : drawn.axes)
      if (to.angle) reach = std::max(reach, (to.point - from.point).norm());
    for (const Pose& mount : {drawn.X_OT_zero, drawn.X_OS_zero})
      reach = std::max(reach, (mount.translation() - from.point).norm());
  }
  return kFarFromDrawing + kZeroFromDrawing * reach;
}

void read_struts(YamlMap& map, HexapodModel& hexapod) {
  kinematics::HexapodGeometry& g = hexapod.geometry;
  const kinematics::HexapodGeometry& drawn = hexapod.design;
  g.deviation = map.quantity("deviation_mm", {0, 500}, "distance of a screw's axis from its base joint");
  const Place place = map.place("struts");
  std::size_t count = 0;
  map.list("struts", kinematics::kStruts, "all six, in their order", [&](YamlMap& strut, std::size_t i) {
    if (i == kinematics::kStruts)
      throw InputError(strut.place(), fmt::format("{} lists more than {} struts", map.path("struts"), i));
    count = i + 1;
    g.base_joint[i] = strut.vector("base_joint_mm", kPlace, "b_i in B");
    g.platform_joint[i] = strut.vector("platform_joint_mm", kPlace, "a_i in T");
    g.length_offset[i] =
        strut.quantity("length_offset_mm", {0, 5000}, "strut length at drive displacement 0");
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

Pose read_mount_near(YamlMap& map, const std::string& body, const Pose& drawn, double limit) {
  const Pose X = read_mount(map, body, "O with all axes at 0");
  if (!map.complete()) return drawn;
  check_near(map, body + "_mm", body + " at zero", (X.translation() - drawn.translation()).norm(), limit);
  return X;
}

void read_axis(YamlMap& map, const kinematics::ChainAxis& drawn, double limit, kinematics::ChainAxis& axis) {
  const std::string name = map.text("axis", "its name");
  axis.direction = map.vector("direction", {-1, 1}, "unit vector in O at drive readings 0");
  if (drawn.angle) axis.point = map.vector("point_mm", kPlace, "a point on the axis, in O");
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
    check_near(map, "point_mm", "axis " + name, drawn.direction.cross(axis.point - drawn.point).norm(),
               limit);
}

void read_chain_calibration(YamlMap& map, MachineDescription& machine) {
  ChainModel& model = machine.chain();
  kinematics::Chain& chain = model.kinematics.chain;
  const kinematics::Chain drawn = chain;
  const double limit = chain_limit(drawn);
  chain.X_OT_zero = read_mount_near(map, "tool", drawn.X_OT_zero, limit);
  chain.X_OS_zero = read_mount_near(map, "work", drawn.X_OS_zero, limit);
  const Place place = map.place("axes");
  std::size_t count = 0;
  const bool named = !model.kinematics.parameters.empty();
  map.list("axes", named ? chain.axes.size() : 0, "in the order of the section axes",
           [&](YamlMap& axis, std::size_t i) {
             if (i >= chain.axes.size())
               throw InputError(axis.place(), fmt::format("{} lists more than {} axes", map.path("axes"), i));
             count = i + 1;
             kinematics::ChainAxis as_drawn = drawn.axes[i];
             if (!named) as_drawn.angle = axis.either("the axis turns", as_drawn.angle);
             read_axis(axis, as_drawn, limit, chain.axes[i]);
           });
  if (count > 0 && count < chain.axes.size())
    throw InputError(place, fmt::format("{} lists {} axes, the machine has {}", map.path("axes"), count,
                                        chain.axes.size()));
  if (!map.complete()) return;
  model.kinematics.design = drawn;
  machine.X_BT_home = kinematics::forward(chain, model.kinematics.home);
}

bool may_be_calibrated(const MachineDescription& machine) {
  return machine.visit(
      [](const HexapodModel&) { return true; },
      [&](const ChainModel&) { return kinematics::find_chain_kind(machine.mechanism)->may_be_calibrated; });
}

std::string not_calibratable(const MachineDescription& machine) {
  std::vector<std::string> words{kinematics::kHexapod};
  for (const kinematics::ChainKind& kind : kinematics::chain_kinds())
    if (kind.may_be_calibrated) words.push_back(kind.name);
  return fmt::format("a calibrated '{}' has no inverse kinematics: only {} can be calibrated",
                     machine.mechanism, fmt::join(words, ", "));
}

}  // namespace

void require_calibratable(const MachineDescription& machine) {
  if (!may_be_calibrated(machine)) throw InputError(not_calibratable(machine));
}

void read_calibration(YamlMap& root, MachineDescription& machine, CalibratedParameters& parameters) {
  if (!may_be_calibrated(machine)) return root.refuse("calibration", not_calibratable(machine));
  if (!root.has("calibration")) return;
  if (!root.complete() && !root.recording()) return;  // without the geometry there is nothing to compare with
  root.section("calibration", "measured geometry, which the controller uses in place of the drawn one",
               [&](YamlMap& map) {
                 read_record(map, machine.calibration.emplace());
                 machine.visit([&](const HexapodModel&) { read_struts(map, machine.hexapod()); },
                               [&](const ChainModel&) { read_chain_calibration(map, machine); });
                 parameters = read_calibrated_parameters(map, machine);
               });
}

}  // namespace understudy::machine
