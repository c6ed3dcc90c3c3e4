#include "machine/tool_section.h"

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::machine {
namespace {

constexpr Bounds kBodySize{0.01, 1000};

geometry::Shape read_body(YamlMap& map) {
  geometry::Shape body;
  body.name = map.text("name");
  const std::string shape = map.word("shape", {"frustum", "cylinder", "box"});
  // The file places every body by the centre of its lower face; boxes and cylinders have theirs in the
  // middle.
  Vec3 centre = map.vector("bottom_centre_mm", {-1000, 1000});
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

void read_drive(YamlMap& map, Drive& drive) {
  drive.lead = map.quantity("lead_mm", {0.1, 100});
  drive.steps_per_turn = map.integer("steps_per_turn", 1, 100000);
  drive.microsteps = map.integer("microsteps", 1, 1024);
  drive.velocity_max = map.quantity("velocity_max_mm_per_s", {0.1, 5000});
  drive.acceleration_max = map.quantity("acceleration_max_mm_per_s2", {1, 1e6});
}

void read_play(YamlMap& map, Play& play) {
  play.screw_nut = map.quantity("screw_nut_um", {0, 2000});
  play.ball_joint = map.quantity("ball_joint_um", {0, 2000});
}

void read_masses(YamlMap& map, Masses& masses) {
  masses.platform = map.quantity("platform_kg", {0.001, 1000});
  masses.nut = map.quantity("nut_kg", {1e-4, 100});
  masses.motor = map.quantity("motor_kg", {1e-3, 100});
  masses.platform_centre_T = map.vector("platform_centre_mm", {-1000, 1000});
  masses.platform_inertia = map.vector("platform_inertia_kg_mm2", {0.01, 1e9});
  if (!map.complete()) return;
  const Vec3& inertia = masses.platform_inertia;
  const double largest = inertia.maxCoeff();
  if (inertia.sum() - largest < largest)
    throw InputError(
        map.place("platform_inertia_kg_mm2"),
        fmt::format("{} has a largest moment of {:g} kg mm^2, more than the sum {:g} kg mm^2 of the other "
                    "two: no body has that",
                    map.path("platform_inertia_kg_mm2"), largest * 1e6, (inertia.sum() - largest) * 1e6));
}

void read_tool(YamlMap& map, Tool& tool) {
  tool.nozzle_diameter = map.quantity("nozzle_diameter_mm", {0.01, 20});
  tool.flat_diameter = map.quantity("flat_diameter_mm", {0.01, 50});
  tool.filament_diameter = map.quantity("filament_diameter_mm", {0.1, 20});
  map.list("bodies", [&tool](YamlMap& body) { tool.bodies.push_back(read_body(body)); });
  if (map.complete() && tool.flat_diameter <= tool.nozzle_diameter)
    throw InputError(
        map.place("flat_diameter_mm"),
        fmt::format("{} is {:g} mm, not wider than the bore of {:g} mm", map.path("flat_diameter_mm"),
                    to_mm(tool.flat_diameter), to_mm(tool.nozzle_diameter)));
}

}  // namespace understudy::machine
