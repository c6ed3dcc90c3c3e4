#include <memory>

#include <fmt/format.h>

#include "cli/plan/plan_options.h"
#include "core/units.h"
#include "toolpath/planners/spiral.h"

namespace understudy::cli {
namespace {

struct SpiralRequest {
  PlanOptions options;
  std::string place = "0,0,0";
  double radius_mm = 10, pitch_mm = 10, turns = 2, lean_deg = 20, lean_turns = 1;
  double strand_mm = 0.45, chord_um = 5, end_dwell_s = 5;
};

int plan_spiral(const SpiralRequest& r) {
  check_options(r.options);
  check_option("--radius", r.radius_mm, 1000);
  check_option("--pitch", r.pitch_mm, 1000);
  check_option("--turns", r.turns, 1000);
  check_option("--strand", r.strand_mm, 10);
  check_option("--chord", r.chord_um, 1000);
  const auto machine = printing_machine(r.options.machine);
  toolpath::SpiralPlan plan;
  plan.centre = place_from("--place", r.place);
  plan.radius = from_mm(r.radius_mm);
  plan.pitch = from_mm(r.pitch_mm);
  plan.turns = r.turns;
  plan.gap = machine.gap.aim;
  plan.lean = from_deg(r.lean_deg);
  plan.lean_turns = r.lean_turns;
  plan.strand_diameter = from_mm(r.strand_mm);
  plan.chord_tolerance = r.chord_um * kMicrometre;
  plan.feed = from_mm(r.options.feed_mm_per_s);
  plan.approach_feed = from_mm(r.options.approach_mm_per_s);
  plan.clearance = from_mm(r.options.clearance_mm);
  plan.end_dwell = r.end_dwell_s;
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = r.options.temperature_c + kCelsiusZero;
  plan.fan = r.options.fan;
  const auto program = toolpath::plan_spiral(plan);
  write_program(program, machine, r.options);
  print_written(r.options, fmt::format("a helix of {:.1f} mm, {} steps", to_mm(toolpath::spiral_length(plan)),
                                       program.steps.size()));
  return kGood;
}

}  // namespace

void add_plan_spiral(CLI::App& plan, Action& action) {
  auto request = std::make_shared<SpiralRequest>();
  auto* spiral = plan.add_subcommand("spiral", "A helix drawn in the air, the tool leaning along it");
  add_machine_option(*spiral, request->options);
  spiral->add_option("--radius", request->radius_mm, "mm")->capture_default_str();
  spiral->add_option("--pitch", request->pitch_mm, "mm of rise a turn")->capture_default_str();
  spiral->add_option("--turns", request->turns, "counter-clockwise")->capture_default_str();
  spiral->add_option("--lean", request->lean_deg, "degrees from vertical towards where the tool goes")
      ->capture_default_str();
  spiral->add_option("--lean-turns", request->lean_turns, "over which it takes up its lean, from upright")
      ->capture_default_str();
  spiral->add_option("--place", request->place, "X,Y,Z mm of the middle, on the table")
      ->capture_default_str();
  spiral->add_option("--strand", request->strand_mm, "mm, diameter")->capture_default_str();
  spiral->add_option("--chord", request->chord_um, "um between chord and helix at most")
      ->capture_default_str();
  spiral->add_option("--end-dwell", request->end_dwell_s, "s at the end, for the strand to solidify")
      ->capture_default_str();
  add_motion_options(*spiral, request->options);
  add_nozzle_options(*spiral, request->options);
  add_output_option(*spiral, request->options);
  spiral->callback([=, &action] { action = [=] { return plan_spiral(*request); }; });
}

}  // namespace understudy::cli
