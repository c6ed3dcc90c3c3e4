#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/plan/machine_reach.h"
#include "cli/plan/plan_options.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/units.h"
#include "machine/fixture_file.h"
#include "toolpath/planners/curve_csv.h"
#include "toolpath/support_free/support_free_planner.h"

namespace understudy::cli {
namespace {

struct SupportFreeRequest {
  PlanOptions options;
  std::string part, line;
  double layer_mm = 0.2, step_mm = 1, smooth_um = 20, lag_deg = 20;
  std::vector<double> range_mm{0.08, 0.32};
  int walls = 1;
  bool ignore_reach = false;
};

toolpath::StructuralLine line_of(const SupportFreeRequest& r, const geometry::Mesh& part,
                                 const Progress& progress) {
  if (!r.line.empty()) return toolpath::StructuralLine(toolpath::read_curve_csv(r.line));
  return toolpath::find_structural_line(part, from_mm(r.step_mm), r.smooth_um * kMicrometre, progress);
}

int plan_support_free(const SupportFreeRequest& r) {
  check_options(r.options);
  check_option("--layer", r.layer_mm, 10);
  check_option("--step", r.step_mm, 100);
  check_option("--lag", r.lag_deg, 60);
  if (!(r.smooth_um >= 0 && r.smooth_um <= 1000))
    throw InputError(fmt::format("--smooth {:g} um is outside 0..1000 um", r.smooth_um));
  const auto machine = printing_machine(r.options.machine);
  const auto part = geometry::read_stl(machine::find_fixture(r.part));
  toolpath::SupportFreePlan plan;
  plan.range = {from_mm(r.layer_mm), from_mm(r.range_mm.at(0)), from_mm(r.range_mm.at(1)),
                from_deg(r.lag_deg)};
  plan.bead_width = from_mm(r.options.bead_width_mm);
  plan.walls = r.walls;
  plan.feed = from_mm(r.options.feed_mm_per_s);
  plan.approach_feed = from_mm(r.options.approach_mm_per_s);
  plan.clearance = from_mm(r.options.clearance_mm);
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = r.options.temperature_c + kCelsiusZero;
  plan.fan = r.options.fan;
  const auto result = with_progress(!r.options.quiet, [&](const Progress& progress) {
    const auto line = line_of(r, *part, stage_of(progress, 0, 0.3));
    plan.progress = stage_of(progress, 0.3, 0.8);
    auto planned = toolpath::plan_support_free(*part, line, plan);
    if (!r.ignore_reach) check_reach(planned.program, machine, stage_of(progress, 0.8, 1));
    return planned;
  });
  const std::string notes = fmt::format(
      "{} layers of {:.3f} to {:.3f} mm, {:.1f} mm of bead, {:.1f} mm3, {} travels; the tool leans by up to "
      "{:.1f} "
      "deg, layers by up to {:.1f} deg against the plane across the line",
      result.layers, to_mm(result.thinnest), to_mm(result.thickest), to_mm(result.printed),
      1e9 * result.volume, result.travels, to_deg(result.tilt_max), to_deg(result.lag_max));
  write_program(result.program, machine, r.options, {notes});
  print_written(r.options, notes);
  return kGood;
}

}  // namespace

void add_plan_support_free(CLI::App& plan, Action& action) {
  auto request = std::make_shared<SupportFreeRequest>();
  request->options.feed_mm_per_s = 12;
  request->options.clearance_mm = 2;
  request->options.approach_mm_per_s = 3;
  request->options.bead_width_mm = 0.6;
  request->options.temperature_c = 205;
  request->options.fan = 1;
  auto* command =
      plan.add_subcommand("support-free", "Layers across a bent part's line, so that nothing overhangs");
  command->add_option("part", request->part, "STL in mm that stands on z = 0, or a name under models/parts")
      ->required();
  command->add_option("--line", request->line,
                      "CSV x_mm,y_mm,z_mm of the structural line, from the foot; without it, it is found");
  command->add_option("--step", request->step_mm, "mm, along the line, in which it is found")
      ->capture_default_str();
  command
      ->add_option("--smooth", request->smooth_um,
                   "um by which the found line may leave the middles of the sections, lest layers turn with "
                   "the facets of a mesh: about a facet's distance from the true surface")
      ->capture_default_str();
  command->add_option("--machine", request->options.machine, "filament, nozzle and reach come from it")
      ->required();
  command->add_option("--layer", request->layer_mm, "mm, height of the layers along the line")
      ->capture_default_str();
  command
      ->add_option("--layer-range", request->range_mm,
                   "mm, thinnest,thickest anywhere in a layer, inside and outside of a bend")
      ->expected(2)
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--lag", request->lag_deg,
                   "degrees that a layer may lean against the plane across the line")
      ->capture_default_str();
  command->add_option("--walls", request->walls, "contours from the outline inwards")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--ignore-reach", request->ignore_reach, "do not ask the machine whether it gets there");
  add_motion_options(*command, request->options);
  command->add_option("--width", request->options.bead_width_mm, "mm, width of the bead")
      ->capture_default_str();
  add_nozzle_options(*command, request->options);
  add_output_option(*command, request->options);
  command->callback([=, &action] { action = [=] { return plan_support_free(*request); }; });
}

}  // namespace understudy::cli
