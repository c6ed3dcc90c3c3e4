#include "machine/file/hexapod_section.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "machine/file/tool_section.h"

namespace understudy::machine {
namespace {

constexpr double kJointsApart = 1e-3;  // [m]; nearer, two joints are one point to any real bearing

Vec3 on_circle(double radius, double angle, double height) {
  return {radius * std::cos(angle), radius * std::sin(angle), height};
}

void check_apart(const Place& place, const char* what, const kinematics::PerStrut<Vec3>& joints) {
  for (std::size_t i = 0; i < joints.size(); ++i)
    for (std::size_t j = i + 1; j < joints.size(); ++j) {
      const double distance = (joints[i] - joints[j]).norm();
      if (distance < kJointsApart)
        throw InputError(
            place, fmt::format("{} joints {} and {} are {:.3f} mm apart, at least {} mm are needed", what,
                               i + 1, j + 1, to_mm(distance), to_mm(kJointsApart)));
    }
}

void check_struts_exist(const Place& place, const MachineDescription& machine) {
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    const Vec3 d = machine.hexapod().geometry.base_joint[i] -
                   machine.X_BT_home * machine.hexapod().geometry.platform_joint[i];
    if (d.norm() <= machine.hexapod().geometry.deviation + kJointsApart)
      throw InputError(place,
                       fmt::format("strut {} has no length at home: its joints are {:.3f} mm apart, the "
                                   "deviation is {} mm",
                                   i + 1, to_mm(d.norm()), to_mm(machine.hexapod().geometry.deviation)));
  }
}

void read_geometry(YamlMap& map, MachineDescription& machine) {
  const double base_radius = map.quantity("base_radius_mm", {5, 2000}, "base joints, from the axis");
  const double base_half_angle =
      map.quantity("base_pair_half_angle_deg", {0, 60}, "base joints stand at azimuth 120 k -+ this");
  const double base_height =
      map.quantity("base_height_mm", {5, 5000}, "plane of the base joints above the table's top");
  const double platform_radius =
      map.quantity("platform_radius_mm", {5, 2000}, "ball joints, from the tool's axis");
  const double platform_half_angle = map.quantity("platform_pair_half_angle_deg", {0, 60},
                                                  "ball joints stand at azimuth 120 k -+ (60 - this)");
  const double platform_height =
      map.quantity("platform_height_mm", {0, 1000}, "plane of the ball joints above the tip");
  const Vec3 home_tip =
      map.vector("home_tip_mm", {-5000, 5000}, "tip in W at home, where the tool is upright");
  const double length_offset =
      map.quantity("length_offset_mm", {0, 5000}, "strut length at drive displacement 0");
  machine.hexapod().geometry.deviation = map.quantity(
      "deviation_mm", {0, 500}, "distance of a screw's axis from its base joint (Song 2015, eq 4)");
  machine.hexapod().strut_radius =
      map.quantity("strut_body_radius_mm", {0.1, 100}, "of a strut in collision checks and pictures");

  for (int strut = 0; strut < kinematics::kStruts; ++strut) {
    const int pair = strut / 2;
    const double centre = from_deg(120.0 * pair);
    const double side = strut % 2 == 0 ? -1 : 1;
    machine.hexapod().geometry.base_joint[strut] = on_circle(base_radius, centre + side * base_half_angle, 0);
    machine.hexapod().geometry.platform_joint[strut] =
        on_circle(platform_radius, centre + side * (from_deg(60) - platform_half_angle), platform_height);
    machine.hexapod().geometry.length_offset[strut] = length_offset;
  }
  machine.hexapod().design = machine.hexapod().geometry;
  machine.X_WB = make_pose(Quat::Identity(), Vec3(0, 0, base_height));
  machine.X_BT_home = machine.X_WB.inverse() * make_pose(Quat::Identity(), home_tip);
}

void read_limits(YamlMap& map, MachineDescription& machine) {
  kinematics::HexapodLimits& limits = machine.hexapod().limits;
  limits.strut_min = map.quantity("strut_min_mm", {1, 5000}, "shortest strut");
  limits.strut_max = map.quantity("strut_max_mm", {1, 5000}, "longest strut");
  limits.base_alpha_min = map.quantity("base_joint_alpha_min_deg", {-90, 90}, "base joint, positive inward");
  limits.base_alpha_max = map.quantity("base_joint_alpha_max_deg", {-90, 90}, "base joint, positive inward");
  limits.base_beta_max = map.quantity("base_joint_beta_max_deg", {1, 90}, "base joint to either side");
  limits.ball_min = map.quantity("ball_joint_min_deg", {0, 180}, "ball joint, from the stud's axis");
  limits.ball_max = map.quantity("ball_joint_max_deg", {0, 180}, "ball joint, from the stud's axis");
  limits.screw_distance_min =
      map.quantity("screw_distance_min_mm", {0, 500}, "least distance of the axes of two screws");
  limits.condition_max =
      map.quantity("condition_max", {1, 1e6}, "of the Jacobian, with lengths scaled by the platform radius");
  if (!map.complete()) return;
  const auto ordered = [&map](const char* low_key, double low, const char* high_key, double high, double unit,
                              const char* unit_name) {
    if (low >= high)
      throw InputError(map.place(low_key),
                       fmt::format("{} is {:g} {}, not below {} of {:g} {}", map.path(low_key), low / unit,
                                   unit_name, high_key, high / unit, unit_name));
  };
  ordered("strut_min_mm", limits.strut_min, "strut_max_mm", limits.strut_max, kMillimetre, "mm");
  ordered("base_joint_alpha_min_deg", limits.base_alpha_min, "base_joint_alpha_max_deg",
          limits.base_alpha_max, kDegree, "deg");
  ordered("ball_joint_min_deg", limits.ball_min, "ball_joint_max_deg", limits.ball_max, kDegree, "deg");
}

}  // namespace

void read_hexapod(YamlMap& root, MachineDescription& machine) {
  root.section("geometry", "the mechanism as drawn", [&](YamlMap& map) { read_geometry(map, machine); });
  root.section("limits", "what struts and joints allow", [&](YamlMap& map) { read_limits(map, machine); });
  Drive drive;
  root.section("drive", "motor and screw of every strut", [&](YamlMap& map) {
    read_drive(map, false, drive);
    if (map.has("screw_rotation")) {
      const std::string word =
          map.word("screw_rotation", {"guided", "free", "compensated"},
                   "whether the joints turn the screws in their nuts, and whether the controller has it");
      machine.hexapod().screw_rotation = word == "free"          ? ScrewRotation::free
                                         : word == "compensated" ? ScrewRotation::compensated
                                                                 : ScrewRotation::guided;
    }
  });
  std::fill_n(machine.drives.begin(), kinematics::kStruts, drive);
  root.section("play", "total free travel between both ends",
               [&](YamlMap& map) { read_play(map, machine.hexapod().play); });
  root.section("masses", "of platform, struts and motors",
               [&](YamlMap& map) { read_masses(map, machine.hexapod().masses); });
}

void settle_home(const Place& place, MachineDescription& machine) {
  check_apart(place, "base", machine.hexapod().geometry.base_joint);
  check_apart(place, "platform", machine.hexapod().geometry.platform_joint);
  check_struts_exist(place, machine);
  // Studs were made as drawn; a calibration says nothing about them.
  machine.hexapod().joints = kinematics::joints_at_home(machine.hexapod().design, machine.X_BT_home);
  std::vector<kinematics::LimitViolation> violations;
  kinematics::check(machine.hexapod().geometry, machine.hexapod().joints, machine.hexapod().limits,
                    machine.X_BT_home, violations);
  if (!violations.empty())
    throw InputError(place, "home cannot be reached: " + kinematics::to_string(violations.front()));
}

}  // namespace understudy::machine
