#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "cli/plan/machine_reach.h"
#include "cli/plan/plan_options.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "geometry/box_mesh.h"
#include "geometry/inflated.h"
#include "machine/fixture_file.h"
#include "toolpath/finishing/finishing_planner.h"

namespace understudy::cli {
namespace {

struct FinishingRequest {
  PlanOptions options;
  std::string part, stock;
  double depth_mm = 0.7, pitch_mm = 2, step_mm = 0.5, fit_mm = 0.25;
  std::optional<double> from_mm, to_mm;
  bool ignore_reach = false;
};

machine::MachineDescription milling_machine(const std::string& name) {
  auto machine = machine::load_machine(name);
  if (machine.tool.prints())
    throw InputError(fmt::format("machine {} prints: its tool is no end mill", machine.name));
  return machine;
}

/// The table as what the tool must not reach into.
std::shared_ptr<const geometry::Mesh> table_of(const machine::MachineDescription& machine) {
  const Vec3 half = std::get<geometry::Box>(machine.table.form).size / 2;
  return geometry::box_mesh(-half, half, machine.table.X_FS);
}

toolpath::FinishingPlan plan_of(const FinishingRequest& r, const machine::MachineDescription& machine,
                                const geometry::Mesh& part) {
  toolpath::FinishingPlan plan;
  plan.depth = from_mm(r.depth_mm);
  plan.mill_radius = machine.tool.flat_diameter / 2;
  plan.rings = toolpath::tool_rings(machine.tool.bodies, plan.mill_radius);
  plan.pitch = from_mm(r.pitch_mm);
  // The face reaches as far as the part's ends; of a lower part, one layer through its middle.
  const double middle = (part.lower().z() + part.upper().z()) / 2;
  plan.from = r.from_mm ? from_mm(*r.from_mm) : std::min(middle, part.lower().z() + plan.mill_radius);
  plan.to = r.to_mm ? from_mm(*r.to_mm) : std::max(middle, part.upper().z() - plan.mill_radius);
  plan.step = from_mm(r.step_mm);
  plan.fit_reach = from_mm(r.fit_mm);
  plan.feed = from_mm(r.options.feed_mm_per_s);
  plan.approach_feed = from_mm(r.options.approach_mm_per_s);
  plan.clearance = from_mm(r.options.clearance_mm);
  plan.first_axis = (machine.X_WB * machine.X_BT_home).linear().col(2);
  return plan;
}

int plan_finishing(const FinishingRequest& r) {
  check_options(r.options);
  if (!r.stock.empty()) check_writable(r.stock);
  check_option("--depth-of-cut", r.depth_mm, 100);
  check_option("--pitch", r.pitch_mm, 100);
  check_option("--step", r.step_mm, 10);
  check_option("--fit", r.fit_mm, 10);
  const auto machine = milling_machine(r.options.machine);
  const auto part = geometry::read_stl(machine::find_fixture(r.part));
  toolpath::FinishingPlan plan = plan_of(r, machine, *part);
  const auto stock = geometry::inflated(*part, plan.depth);
  const auto result = with_progress(!r.options.quiet, [&](const Progress& progress) {
    plan.progress = stage_of(progress, 0, 0.8);
    auto planned = toolpath::plan_finishing(*part, *stock, *table_of(machine), plan);
    if (!r.ignore_reach) check_reach_from_home(planned.program, machine, stage_of(progress, 0.8, 1));
    return planned;
  });
  std::string notes = fmt::format(
      "{} layers, {} outlines, {:.1f} mm of cutting to a depth of {:g} mm; fitted normals within {:.2f} deg "
      "of "
      "the mesh's",
      result.layers, result.outlines, to_mm(result.length), r.depth_mm, to_deg(result.fit_deviation));
  if (result.lift_max > 0)
    notes += fmt::format("; in hollows the end mill stands up to {:.3f} mm off", to_mm(result.lift_max));
  if (result.left_out > 0)
    notes += fmt::format("; {} places are too narrow for it and left out", result.left_out);
  write_program(result.program, machine, r.options, {notes});
  if (!r.stock.empty())
    write_file(r.stock,
               geometry::write_stl(*stock, fmt::format("stock {:g} mm larger, millimetres", r.depth_mm)));
  print_written(r.options, notes);
  return kGood;
}

}  // namespace

void add_plan_finishing(CLI::App& plan, Action& action) {
  auto request = std::make_shared<FinishingRequest>();
  request->options.feed_mm_per_s = 20;
  request->options.approach_mm_per_s = 5;
  request->options.clearance_mm = 4;
  auto* command =
      plan.add_subcommand("finishing", "Mill a part that was printed larger down to its own surface");
  command
      ->add_option("part", request->part,
                   "STL in mm of the part as it should be, on z = 0, or a name under models/parts")
      ->required();
  command->add_option("--machine", request->options.machine, "end mill, table and reach come from it")
      ->required();
  command
      ->add_option("--depth-of-cut", request->depth_mm,
                   "mm, by which every face of the printed part stands farther out")
      ->capture_default_str();
  command->add_option("--stock", request->stock,
                      "STL to write: the part to print, larger by the depth of cut");
  command->add_option("--from", request->from_mm,
                      "mm, z of the lowest layer; without it a mill's radius above the foot");
  command->add_option("--to", request->to_mm,
                      "mm, z of the highest layer; without it a mill's radius below the top");
  command->add_option("--pitch", request->pitch_mm, "mm, from layer to layer at most")->capture_default_str();
  command->add_option("--step", request->step_mm, "mm, from place to place of an outline at most")
      ->capture_default_str();
  command
      ->add_option("--fit", request->fit_mm,
                   "mm, around a place, of the surface that its normal is fitted to")
      ->capture_default_str();
  command->add_option("--feed", request->options.feed_mm_per_s, "mm/s")->capture_default_str();
  command->add_option("--approach-feed", request->options.approach_mm_per_s, "mm/s, into the part")
      ->capture_default_str();
  command->add_option("--clearance", request->options.clearance_mm, "mm off the printed part, for travel")
      ->capture_default_str();
  command->add_flag("--ignore-reach", request->ignore_reach, "do not ask the machine whether it gets there");
  add_output_option(*command, request->options);
  command->callback([=, &action] { action = [=] { return plan_finishing(*request); }; });
}

}  // namespace understudy::cli
