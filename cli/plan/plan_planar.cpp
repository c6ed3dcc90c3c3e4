#include <memory>

#include <fmt/format.h>

#include "cli/plan/plan_options.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/units.h"
#include "machine/fixture_file.h"
#include "toolpath/planners/planar_slicer.h"

namespace understudy::cli {
namespace {

struct PlanarRequest {
  PlanOptions options;
  std::string part, core;
  double layer_mm = 0.13, pitch_mm = 0;
  int walls = 0;
};

int plan_planar(const PlanarRequest& r) {
  check_options(r.options);
  check_option("--layer", r.layer_mm, 10);
  if (!(r.pitch_mm >= 0 && r.pitch_mm <= 100))
    throw InputError(fmt::format("--pitch {:g} is outside 0..100", r.pitch_mm));
  const auto machine = printing_machine(r.options.machine);
  const auto part = geometry::read_stl(machine::find_fixture(r.part));
  const auto core = r.core.empty() ? nullptr : geometry::read_stl(machine::find_fixture(r.core));
  toolpath::PlanarPlan plan;
  plan.layer_height = from_mm(r.layer_mm);
  plan.bead_width = from_mm(r.options.bead_width_mm);
  plan.pitch = from_mm(r.pitch_mm);
  plan.walls = r.walls;
  plan.feed = from_mm(r.options.feed_mm_per_s);
  plan.approach_feed = from_mm(r.options.approach_mm_per_s);
  plan.clearance = from_mm(r.options.clearance_mm);
  plan.nozzle_flat = machine.tool.flat_diameter;
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = r.options.temperature_c + kCelsiusZero;
  plan.fan = r.options.fan;
  const auto result = with_progress(!r.options.quiet, [&](const Progress& progress) {
    plan.progress = progress;
    return toolpath::plan_planar(*part, core.get(), plan);
  });
  write_program(result.program, machine, r.options);
  print_written(r.options, fmt::format("{} layers of {:g} mm, {} strokes, {:.1f} mm of bead", result.layers,
                                       r.layer_mm, result.strokes, to_mm(result.printed)));
  return kGood;
}

}  // namespace

void add_plan_planar(CLI::App& plan, Action& action) {
  auto request = std::make_shared<PlanarRequest>();
  request->options.clearance_mm = 2;
  request->options.approach_mm_per_s = 3;
  auto* planar = plan.add_subcommand("planar", "Level layers, the tool upright: to compare with");
  planar->add_option("part", request->part, "STL in mm, or a name under models/parts")->required();
  planar->add_option("--core", request->core, "STL or name of what is there already, inside the part");
  add_machine_option(*planar, request->options);
  planar->add_option("--layer", request->layer_mm, "mm, height of the layers")->capture_default_str();
  planar->add_option("--walls", request->walls, "beads from the outline inwards; 0: until the layer is full")
      ->check(CLI::Range(0, 10000))
      ->capture_default_str();
  planar
      ->add_option("--pitch", request->pitch_mm, "mm from bead to bead; 0: as wide as a bead's volume fills")
      ->capture_default_str();
  add_motion_options(*planar, request->options);
  planar->add_option("--width", request->options.bead_width_mm, "mm, width of the bead")
      ->capture_default_str();
  add_nozzle_options(*planar, request->options);
  add_output_option(*planar, request->options);
  planar->callback([=, &action] { action = [=] { return plan_planar(*request); }; });
}

}  // namespace understudy::cli
