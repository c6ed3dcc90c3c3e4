#include "machine/file/tool_section.h"

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::machine {
namespace {

constexpr Bounds kBodySize{0.01, 1000};

geometry::Shape read_body(YamlMap& map) {
  geometry::Shape body;
  body.name = map.name("name", "shown in findings");
  const std::string shape = map.word("shape", {"frustum", "cylinder", "box", "capsule"}, "which keys follow");
  if (shape == "capsule") {
    const Vec3 from = map.vector("from_mm", {-5000, 5000}, "one end of its axis"),
               to = map.vector("to_mm", {-5000, 5000}, "the other end");
    return geometry::capsule_between(body.name, from, to,
                                     map.quantity("radius_mm", kBodySize, "across its axis"));
  }
  // The file places every body by the centre of its lower face; boxes and cylinders have theirs in the
  // middle.
  Vec3 centre = map.vector("bottom_centre_mm", {-5000, 5000}, "middle of its lower face");
  if (shape == "frustum") {
    geometry::Frustum frustum{};
    frustum.radius_bottom = map.quantity("radius_bottom_mm", {0, 1000}, "of the lower face");
    frustum.radius_top = map.quantity("radius_top_mm", kBodySize, "of the upper face");
    frustum.height = map.quantity("height_mm", kBodySize, "along z");
    body.form = frustum;
  } else if (shape == "cylinder") {
    geometry::Cylinder cylinder{};
    cylinder.radius = map.quantity("radius_mm", kBodySize, "across its axis");
    cylinder.length = map.quantity("height_mm", kBodySize, "along z");
    centre.z() += cylinder.length / 2;
    body.form = cylinder;
  } else {
    const Vec3 size = map.vector("size_mm", kBodySize, "along x, y and z");
    centre.z() += size.z() / 2;
    body.form = geometry::Box{size};
  }
  body.X_FS = make_pose(Quat::Identity(), centre);
  return body;
}

}  // namespace

void read_drive(YamlMap& map, bool angle, Drive& drive) {
  if (angle) {
    drive.lead = map.quantity("lead_deg", {0.001, 360}, "turn of the axis in one turn of the motor");
    drive.velocity_max = map.quantity("velocity_max_deg_per_s", {0.01, 1e5}, "of the axis");
    drive.acceleration_max = map.quantity("acceleration_max_deg_per_s2", {0.1, 1e7}, "of the axis");
  } else {
    drive.lead = map.quantity("lead_mm", {0.1, 100}, "travel in one turn of the motor");
    drive.velocity_max = map.quantity("velocity_max_mm_per_s", {0.1, 5000}, "of the axis");
    drive.acceleration_max = map.quantity("acceleration_max_mm_per_s2", {1, 1e6}, "of the axis");
  }
  const std::string jump = angle ? "velocity_jump_deg_per_s" : "velocity_jump_mm_per_s";
  if (map.has(jump))
    drive.velocity_jump =
        map.quantity(jump, {0, 1000}, "change of speed that the motor takes at once at a corner");
  drive.steps_per_turn =
      map.integer("steps_per_turn", 1, 10000000, "full steps of the motor; of a servo, its encoder's counts");
  drive.microsteps = map.integer("microsteps", 1, 1024, "per full step");
  if (map.has("self_locking"))
    drive.self_locking =
        map.word("self_locking", {"yes", "no"}, "whether it keeps its place without current") == "yes";
  const std::string stiffness = angle ? "stiffness_nm_per_rad" : "stiffness_n_per_um";
  if (!map.has(stiffness)) return;
  drive.stiffness = map.quantity(stiffness, angle ? Bounds{1, 1e9} : Bounds{0.01, 1e5},
                                 "rotor against its commanded field, seen on the axis");
  drive.resonance = map.quantity("resonance_hz", {1, 2000}, "of the bare motor on that spring");
  drive.damping_ratio = map.quantity("damping_ratio", {0.001, 2}, "of that resonance");
}

void read_play(YamlMap& map, Play& play) {
  play.screw_nut = map.quantity("screw_nut_um", {0, 2000}, "of each nut");
  play.ball_joint = map.quantity("ball_joint_um", {0, 2000}, "of each ball joint");
  if (map.has("friction_n"))
    play.friction = map.quantity("friction_n", {0, 1000},
                                 "along the strut; a smaller load leaves the parts where they touch");
}

void read_masses(YamlMap& map, Masses& masses) {
  masses.platform = map.quantity("platform_kg", {0.001, 1000}, "platform with all it carries");
  masses.nut = map.quantity("nut_kg", {1e-4, 100}, "nut and rod end of one strut");
  masses.motor = map.quantity("motor_kg", {1e-3, 100}, "motor of one strut");
  masses.platform_centre_T = map.vector("platform_centre_mm", {-1000, 1000}, "centre of mass in T");
  masses.platform_inertia =
      read_inertia(map, "platform_inertia_kg_mm2", "principal moments about it along T's axes");
}

Vec3 read_inertia(YamlMap& map, const std::string& key, const char* about) {
  const Vec3 inertia = map.vector(key, {0.01, 1e9}, about);
  if (!map.complete()) return inertia;
  const double largest = inertia.maxCoeff();
  if (inertia.sum() - largest < largest * (1 - 1e-9))
    throw InputError(
        map.place(key),
        fmt::format("{} has a largest moment of {:g} kg mm^2, more than the sum {:g} kg mm^2 of the other "
                    "two: no body has that",
                    map.path(key), largest * 1e6, (inertia.sum() - largest) * 1e6));
  return inertia;
}

void read_bodies(YamlMap& map, std::vector<geometry::Shape>& bodies) {
  map.list("bodies", 0, "shapes for collision checks and pictures",
           [&bodies](YamlMap& body, std::size_t) { bodies.push_back(read_body(body)); });
}

void read_tool(YamlMap& map, Tool& tool, std::optional<Cure>& cure) {
  if (map.has("end_mill_diameter_mm")) {
    tool.flat_diameter = map.quantity("end_mill_diameter_mm", {0.1, 100}, "of a tool that prints nothing");
    read_bodies(map, tool.bodies);
    return;
  }
  if (map.has("light_guide_diameter_mm")) {
    read_cure(map, tool, cure);
    read_bodies(map, tool.bodies);
    return;
  }
  tool.nozzle_diameter = map.quantity("nozzle_diameter_mm", {0.01, 20}, "bore");
  tool.flat_diameter = map.quantity("flat_diameter_mm", {0.01, 50}, "flat ring around the bore");
  tool.filament_diameter = map.quantity("filament_diameter_mm", {0.1, 20}, "of the filament that is fed");
  read_bodies(map, tool.bodies);
  if (map.complete() && tool.flat_diameter <= tool.nozzle_diameter)
    throw InputError(
        map.place("flat_diameter_mm"),
        fmt::format("{} is {:g} mm, not wider than the bore of {:g} mm", map.path("flat_diameter_mm"),
                    to_mm(tool.flat_diameter), to_mm(tool.nozzle_diameter)));
}

void read_process(YamlMap& map, Process& process) {
  if (map.has("material"))
    process.material = map.text("material", "a name under models/materials, or a path of a material file");
  if (map.has("ambient_c"))
    process.ambient_temperature =
        kCelsiusZero + map.quantity("ambient_c", {-50, 200}, "air, and what the print radiates to");
  if (map.has("fan_air_m_per_s"))
    process.fan_air_speed = map.quantity("fan_air_m_per_s", {0, 50}, "air past the strand at full fan");
  if (map.has("free_strand_mm"))
    process.free_strand_diameter =
        map.quantity("free_strand_mm", {0.01, 20}, "diameter of a strand that leaves the nozzle freely");
  if (map.has("extruder_lag_ms"))
    process.extruder_lag = map.quantity("extruder_lag_ms", {0, 2000},
                                        "first-order lag from the drive's feed to the flow at the nozzle");
}

}  // namespace understudy::machine
