#include <map>
#include <memory>

#include <fmt/format.h>

#include "cli/plan/plan_options.h"
#include "core/error.h"
#include "core/units.h"
#include "toolpath/planners/waypoints.h"

namespace understudy::cli {
namespace {

struct WaypointRequest {
  PlanOptions options;
  std::vector<std::string> files;
  std::string place, up = "z";
  bool flip = false;
  double gap_limit_mm = 3, tilt_max_deg = 90;
};

const std::map<std::string, Vec3>& directions() {
  static const std::map<std::string, Vec3> kDirections = {{"x", Vec3::UnitX()},   {"y", Vec3::UnitY()},
                                                          {"z", Vec3::UnitZ()},   {"-x", -Vec3::UnitX()},
                                                          {"-y", -Vec3::UnitY()}, {"-z", -Vec3::UnitZ()}};
  return kDirections;
}

int plan_waypoints(const WaypointRequest& r) {
  check_options(r.options);
  check_option("--largest-step", r.gap_limit_mm, 100);
  check_option("--tilt", r.tilt_max_deg, 180);
  if (!directions().contains(r.up))
    throw InputError(fmt::format("--up '{}' is not x, y, z, -x, -y or -z", r.up));
  const auto machine = printing_machine(r.options.machine);
  std::vector<toolpath::WaypointLayer> layers;
  for (const std::string& file : r.files) layers.push_back(toolpath::read_waypoints(file));
  toolpath::turn(layers, {directions().at(r.up), r.flip});
  if (!r.place.empty()) toolpath::place_on(layers, place_from("--place", r.place));
  toolpath::WaypointPlan plan;
  plan.bead_width = from_mm(r.options.bead_width_mm);
  plan.bead_height = bead_height(r.options, machine);
  plan.feed = from_mm(r.options.feed_mm_per_s);
  plan.approach_feed = from_mm(r.options.approach_mm_per_s);
  plan.clearance = from_mm(r.options.clearance_mm);
  plan.largest_step = from_mm(r.gap_limit_mm);
  plan.tilt_max = from_deg(r.tilt_max_deg);
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = r.options.temperature_c + kCelsiusZero;
  plan.fan = r.options.fan;
  plan.files = r.files;
  const auto result = toolpath::plan_waypoints(layers, plan);
  write_program(result.program, machine, r.options);
  if (result.single_points > 0)
    fmt::print(stderr,
               "warning: {} waypoints are more than {:g} mm from both neighbours; nothing is printed there\n",
               result.single_points, r.gap_limit_mm);
  print_written(r.options, fmt::format("{} layers, {} strokes, {:.1f} mm of bead", layers.size(),
                                       result.strokes, to_mm(result.printed)));
  return kGood;
}

}  // namespace

void add_plan_waypoints(CLI::App& plan, Action& action) {
  auto request = std::make_shared<WaypointRequest>();
  auto* waypoints = plan.add_subcommand("waypoints", "Curved layers that others planned, point by point");
  waypoints->add_option("files", request->files, "rows x y z nx ny nz in mm, a layer a file")->required();
  add_machine_option(*waypoints, request->options);
  waypoints->add_option(
      "--place", request->place,
      "X,Y,Z mm: the middle of their bounding box's lower side goes there; left out: they stay");
  waypoints->add_option("--up", request->up, "axis of the files that points up: x y z -x -y -z")
      ->capture_default_str();
  waypoints->add_flag("--flip", request->flip, "the normals point into the part");
  waypoints
      ->add_option("--largest-step", request->gap_limit_mm,
                   "mm; waypoints farther apart are not joined by a bead")
      ->capture_default_str();
  waypoints->add_option("--tilt", request->tilt_max_deg, "degrees from vertical that a normal may have")
      ->capture_default_str();
  add_motion_options(*waypoints, request->options);
  add_bead_options(*waypoints, request->options);
  add_nozzle_options(*waypoints, request->options);
  add_output_option(*waypoints, request->options);
  waypoints->callback([=, &action] { action = [=] { return plan_waypoints(*request); }; });
}

}  // namespace understudy::cli
