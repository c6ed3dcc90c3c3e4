#include "studies/faults/drawn_print.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/units.h"
#include "geometry/box_mesh.h"
#include "geometry/mesh.h"
#include "machine/fixture_file.h"
#include "toolpath/planners/planar_slicer.h"
#include "toolpath/planners/section_rows.h"
#include "toolpath/planners/spiral.h"
#include "toolpath/planners/surface_planner.h"

namespace understudy::studies {
namespace {

using machine::MachineDescription;

constexpr double kBeadWidth = 0.48e-3;    // [m], as `understudy plan` has it
constexpr double kTemperature = 503.15;   // [K], likewise
constexpr double kClearance = 3e-3;       // [m]
constexpr double kApproachFeed = 2e-3;    // [m/s]
constexpr double kFarFromMiddle = 10e-3;  // [m], of what stands on the table
constexpr double kLongestBead = 60e-3;    // [m]: longer prints say no more and take longer

/// What a gap sensor is to hold; without one, the middle of the band where the loaded joints hang in their
/// play.
double gap_of(const MachineDescription& machine) {
  if (machine.has_microscope) return machine.gap.aim;
  const double middle = (machine.gap.accepted_min + machine.gap.accepted_max) / 2;
  return std::min(middle + machine.tip_play() / 2, machine.gap.accepted_max);
}

double draw_feed(Random& random) { return random.uniform(3e-3, 12e-3); }

toolpath::SurfacePlan surface_plan(const MachineDescription& machine, Random& random) {
  toolpath::SurfacePlan plan;
  plan.gap = gap_of(machine);
  plan.standoff = machine.gap.standoff;
  plan.clearance = kClearance + machine.gap.standoff;
  plan.step = 0.5e-3;
  plan.chord_tolerance = 2e-6;
  plan.feed = draw_feed(random);
  plan.approach_feed = kApproachFeed;
  plan.bead_width = kBeadWidth;
  plan.bead_height = gap_of(machine);
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = kTemperature;
  plan.tilt_max = from_deg(30);
  return plan;
}

/// `understudy plan surface bottle --section 0 0 0 0 1 0 --tilt FROM TO`: the bottle's line is -20 to 20.
DrawnPrint draw_bottle_line(const MachineDescription& machine, Random& random) {
  const auto part = geometry::read_stl(machine::find_fixture("bottle"));
  const bool all = random.uniform() < 0.3;
  toolpath::SectionRows rows;
  rows.point = Vec3::Zero();
  rows.tilt_min = all ? from_deg(-20) : from_deg(random.uniform(-20, 5));
  rows.tilt_max = all ? from_deg(20) : rows.tilt_min + from_deg(random.uniform(8, 15));
  const auto plan = surface_plan(machine, random);
  return {"bottle line", "bottle",
          toolpath::plan_surface(*part, toolpath::section_rows(*part, rows), 1, plan)};
}

DrawnPrint draw_surface(const MachineDescription& machine, Random& random) {
  constexpr std::array kParts{"bottle", "slanted_box"};
  const char* const name = kParts[random.uniform() < 0.5 ? 0 : 1];
  const auto part = geometry::read_stl(machine::find_fixture(name));
  const auto plan = surface_plan(machine, random);
  const double turn = random.uniform(0, std::numbers::pi);
  toolpath::SectionRows rows;
  const Vec3 middle = 0.5 * (part->lower() + part->upper());
  const double beside = random.uniform(-4e-3, 4e-3);
  rows.point = middle + Vec3(beside, random.uniform(-8e-3, 8e-3), 0);
  rows.normal = Vec3(std::cos(turn), std::sin(turn), 0);
  rows.count = random.uniform() < 0.5 ? 1 : 2;
  rows.pitch = toolpath::bead_area(plan.bead_width, plan.bead_height) / plan.bead_height;
  rows.tilt_min = from_deg(random.uniform(-25, 5));
  rows.tilt_max = rows.tilt_min + from_deg(random.uniform(8, 25));
  const int layers = random.uniform() < 0.7 ? 1 : 2;
  return {"surface", name, toolpath::plan_surface(*part, toolpath::section_rows(*part, rows), layers, plan)};
}

Vec3 draw_place(Random& random) {
  const double x = random.uniform(-kFarFromMiddle, kFarFromMiddle);
  return {x, random.uniform(-kFarFromMiddle, kFarFromMiddle), 0};
}

DrawnPrint draw_layers(const MachineDescription& machine, Random& random) {
  const double layers = 1 + std::floor(random.uniform(0, 3));
  toolpath::PlanarPlan plan;
  plan.layer_height = gap_of(machine);
  plan.bead_width = kBeadWidth;
  plan.walls = random.uniform() < 0.5 ? 1 : 2;
  plan.feed = draw_feed(random);
  plan.approach_feed = kApproachFeed;
  plan.clearance = 2e-3;
  plan.nozzle_flat = machine.tool.flat_diameter;
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = kTemperature;
  const Vec3 lower = draw_place(random);
  const double width = random.uniform(2e-3, 8e-3), depth = random.uniform(2e-3, 8e-3);
  const Vec3 size(width, depth, (layers + 1e-3) * plan.layer_height);
  auto planned = toolpath::plan_planar(*geometry::box_mesh(lower, lower + size), nullptr, plan);
  return {"layers", "", std::move(planned.program)};
}

DrawnPrint draw_spiral(const MachineDescription& machine, Random& random) {
  toolpath::SpiralPlan plan;
  plan.centre = draw_place(random);
  plan.radius = random.uniform(4e-3, 8e-3);
  plan.pitch = random.uniform(2e-3, 8e-3);
  plan.turns = random.uniform(0.3, 1);
  plan.gap = gap_of(machine);
  plan.lean = from_deg(random.uniform(0, 20));
  plan.lean_turns = 0.5;
  plan.strand_diameter = 0.45e-3;
  plan.chord_tolerance = 5e-6;
  plan.feed = random.uniform(3e-3, 6e-3);
  plan.approach_feed = kApproachFeed;
  plan.clearance = kClearance;
  plan.end_dwell = 2;
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = kTemperature;
  return {"spiral", "", toolpath::plan_spiral(plan)};
}

double bead_length(const toolpath::Program& program) {
  double length = 0;
  Vec3 tip = Vec3::Zero();
  for (const toolpath::Step& step : program.steps) {
    if (!toolpath::moves(step)) continue;
    if (step.kind == toolpath::StepKind::print) length += (step.X_WT.translation() - tip).norm();
    tip = step.X_WT.translation();
  }
  return length;
}

}  // namespace

DrawnPrint draw_print(const MachineDescription& machine, Random& random) {
  const double kind = random.uniform();
  DrawnPrint print = kind < 0.35   ? draw_bottle_line(machine, random)
                     : kind < 0.65 ? draw_surface(machine, random)
                     : kind < 0.9  ? draw_layers(machine, random)
                                   : draw_spiral(machine, random);
  if (bead_length(print.program) > kLongestBead) throw InputError("the drawn print is too long");
  return print;
}

}  // namespace understudy::studies
