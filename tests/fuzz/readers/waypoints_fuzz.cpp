// Bytes as a layer of waypoints.
#include "core/units.h"
#include "tests/fuzz/reader.h"
#include "toolpath/planners/waypoints.h"

namespace understudy::fuzz {
namespace {

using toolpath::WaypointLayer;

void check_layer(const WaypointLayer& layer) {
  for (const toolpath::Waypoint& waypoint : layer) {
    require_finite(waypoint.position, "position");
    require_near(waypoint.normal.norm(), 1, 1e-12, 0, "length of a normal");
  }
}

toolpath::WaypointPlan ordinary_plan() {
  toolpath::WaypointPlan plan;
  plan.bead_width = 0.5e-3;
  plan.bead_height = 0.2e-3;
  plan.feed = plan.approach_feed = 10e-3;
  plan.clearance = 5e-3;
  plan.largest_step = 2e-3;
  plan.tilt_max = 60 * kDegree;
  plan.filament_diameter = 1.75e-3;
  plan.temperature = 483.15;
  return plan;
}

}  // namespace
}  // namespace understudy::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace understudy;
  toolpath::WaypointLayer layer;
  const std::string text(fuzz::text_of(data, size));
  if (!fuzz::accepts(size, "a.txt", [&] { layer = toolpath::parse_waypoints(text, "a.txt"); })) return 0;
  fuzz::check_layer(layer);
  std::vector<toolpath::WaypointLayer> layers{layer};
  toolpath::turn(layers, {-Vec3::UnitY(), true});
  toolpath::place_on(layers, Vec3(0, 0, 0.01));
  fuzz::check_layer(layers[0]);
  // It is planned and can be written, or refused with a reason.
  try {
    toolpath::plan_waypoints(layers, fuzz::ordinary_plan());
  } catch (const InputError&) {
  }
  return 0;
}
