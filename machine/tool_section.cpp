#include "machine/tool_section.h"

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::machine {
namespace {

constexpr Bounds kBodySize{0.01, 1000};

geometry::Shape read_body(YamlMap& map) {
  geometry::Shape body;
  body.name = map.text("name");
  const std::string shape = map.word("shape", {"frustum", "cylinder", "box", "capsule"});
  if (shape == "capsule") {
    const Vec3 from = map.vector("from_mm", {-5000, 5000}), to = map.vector("to_mm", {-5000, 5000});
    return geometry::capsule_between(body.name, from, to, map.quantity("radius_mm", kBodySize));
  }
  // The file places every body by the centre of its lower face; boxes and cylinders have theirs in the
  // middle.
  Vec3 centre = map.vector("bottom_centre_mm", {-5000, 5000});
  if (shape == "frustum") {
    geometry::Frustum frustum{};
    frustum.radius_bottom = map.quantity("radius_bottom_mm", {0, 1000});
    frustum.radius_top = map.quantity("radius_top_mm", kBodySize);
    frustum.height = map.quantity("height_mm", kBodySize);
    body.form = frustum;
  } else if (shape == "cylinder") {
    geometry::Cylinder cylinder{};
    cylinder.radius = map.quantity("radius_mm", kBodySize);
    cylinder.length = map.quantity("height_mm", kBodySize);
    centre.z() += cylinder.length / 2;
    body.form = cylinder;
  } else {
    const Vec3 size = map.vector("size_mm", kBodySize);
    centre.z() += size.z() / 2;
    body.form = geometry::Box{size};
  }
  body.X_FS = make_pose(Quat::Identity(), centre);
  return body;
}

}  // namespace

void read_drive(YamlMap& map, bool angle, Drive& drive) {
  if (angle) {
    drive.lead = map.quantity("lead_deg", {0.001, 360});
    drive.velocity_max = map.quantity("velocity_max_deg_per_s", {0.01, 1e5});
    drive.acceleration_max = map.quantity("acceleration_max_deg_per_s2", {0.1, 1e7});
  } else {
    drive.lead = map.quantity("lead_mm", {0.1, 100});
    drive.velocity_max = map.quantity("velocity_max_mm_per_s", {0.1, 5000});
    drive.acceleration_max = map.quantity("acceleration_max_mm_per_s2", {1, 1e6});
  }
  const std::string jump = angle ? "velocity_jump_deg_per_s" : "velocity_jump_mm_per_s";
  if (map.has(jump)) drive.velocity_jump = map.quantity(jump, {0, 1000});
  drive.steps_per_turn = map.integer("steps_per_turn", 1, 10000000);
  drive.microsteps = map.integer("microsteps", 1, 1024);
  if (map.has("self_locking")) drive.self_locking = map.word("self_locking", {"yes", "no"}) == "yes";
  const std::string stiffness = angle ? "stiffness_nm_per_rad" : "stiffness_n_per_um";
  if (!map.has(stiffness)) return;
  drive.stiffness = map.quantity(stiffness, angle ? Bounds{1, 1e9} : Bounds{0.01, 1e5});
  drive.resonance = map.quantity("resonance_hz", {1, 2000});
  drive.damping_ratio = map.quantity("damping_ratio", {0.001, 2});
}

void read_play(YamlMap& map, Play& play) {
  play.screw_nut = map.quantity("screw_nut_um", {0, 2000});
  play.ball_joint = map.quantity("ball_joint_um", {0, 2000});
  if (map.has("friction_n")) play.friction = map.quantity("friction_n", {0, 1000});
}

void read_masses(YamlMap& map, Masses& masses) {
  masses.platform = map.quantity("platform_kg", {0.001, 1000});
  masses.nut = map.quantity("nut_kg", {1e-4, 100});
  masses.motor = map.quantity("motor_kg", {1e-3, 100});
  masses.platform_centre_T = map.vector("platform_centre_mm", {-1000, 1000});
  masses.platform_inertia = read_inertia(map, "platform_inertia_kg_mm2");
}

Vec3 read_inertia(YamlMap& map, const std::string& key) {
  const Vec3 inertia = map.vector(key, {0.01, 1e9});
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
  map.list("bodies", [&bodies](YamlMap& body) { bodies.push_back(read_body(body)); });
}

void read_tool(YamlMap& map, Tool& tool) {
  if (map.has("end_mill_diameter_mm")) {
    tool.flat_diameter = map.quantity("end_mill_diameter_mm", {0.1, 100});
    read_bodies(map, tool.bodies);
    return;
  }
  tool.nozzle_diameter = map.quantity("nozzle_diameter_mm", {0.01, 20});
  tool.flat_diameter = map.quantity("flat_diameter_mm", {0.01, 50});
  tool.filament_diameter = map.quantity("filament_diameter_mm", {0.1, 20});
  read_bodies(map, tool.bodies);
  if (map.complete() && tool.flat_diameter <= tool.nozzle_diameter)
    throw InputError(
        map.place("flat_diameter_mm"),
        fmt::format("{} is {:g} mm, not wider than the bore of {:g} mm", map.path("flat_diameter_mm"),
                    to_mm(tool.flat_diameter), to_mm(tool.nozzle_diameter)));
}

void read_process(YamlMap& map, Process& process) {
  if (map.has("material")) process.material = map.text("material");
  if (map.has("ambient_c"))
    process.ambient_temperature = kCelsiusZero + map.quantity("ambient_c", {-50, 200});
  if (map.has("fan_air_m_per_s")) process.fan_air_speed = map.quantity("fan_air_m_per_s", {0, 50});
  if (map.has("free_strand_mm")) process.free_strand_diameter = map.quantity("free_strand_mm", {0.01, 20});
  if (map.has("extruder_lag_ms")) process.extruder_lag = map.quantity("extruder_lag_ms", {0, 2000});
}

}  // namespace understudy::machine
