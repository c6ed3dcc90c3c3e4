#include <algorithm>
#include <memory>
#include <numbers>

#include <fmt/format.h>

#include "cli/plan/machine_reach.h"
#include "cli/plan/plan_options.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/error_context.h"
#include "core/units.h"
#include "machine/cure.h"
#include "machine/fixture_file.h"
#include "toolpath/planners/curve_csv.h"
#include "toolpath/planners/drawing_on_surface.h"
#include "toolpath/planners/section_rows.h"
#include "toolpath/planners/surface_planner.h"
#include "toolpath/svg/svg_outlines.h"

namespace understudy::cli {
namespace {

struct SurfaceRequest {
  PlanOptions options;
  std::string part;
  std::vector<std::string> curves;
  std::string svg, svg_at;
  double svg_turn_deg = 0, svg_width_mm = 0;
  bool upright = false, ignore_reach = false;
  std::vector<double> section{0, 0, 0, 0, 1, 0};  ///< point [mm] and normal of the cutting plane
  std::vector<double> tilt_deg{-20, 20};
  double step_mm = 0.5, chord_um = 2;
  int rows = 1, layers = 1;
  double pitch_mm = 0;  ///< 0: beads side by side
};

void check(const SurfaceRequest& r) {
  check_options(r.options);
  check_option("--step", r.step_mm, 50);
  check_option("--chord", r.chord_um, 1000);
  if (!(r.pitch_mm >= 0 && r.pitch_mm <= 100))
    throw InputError(fmt::format("--pitch {:g} is outside 0..100", r.pitch_mm));
  if (r.rows > 1 && !r.curves.empty())
    throw InputError(fmt::format("--rows {} and --curve exclude each other: rows are cut by planes", r.rows));
  if (!r.svg.empty() && (r.rows > 1 || !r.curves.empty()))
    throw InputError("--svg excludes --rows and --curve: its strokes are all that is laid");
  if (!r.svg.empty() && r.svg_at.empty())
    throw InputError("--svg needs --svg-at X,Y,Z: where on the part the middle of the drawing goes");
  if (!(r.svg_width_mm >= 0 && r.svg_width_mm <= 1000))
    throw InputError(fmt::format("--svg-width {:g} is outside 0..1000", r.svg_width_mm));
  if (r.tilt_deg[0] >= r.tilt_deg[1])
    throw InputError(
        fmt::format("--tilt {:g} {:g}: the first must be smaller", r.tilt_deg[0], r.tilt_deg[1]));
}

std::vector<std::vector<Vec3>> strokes_of_svg(const geometry::Mesh& mesh, const SurfaceRequest& r) {
  toolpath::DrawingPlace place;
  place.point_W = place_from("--svg-at", r.svg_at);
  place.turn = from_deg(r.svg_turn_deg);
  place.width = from_mm(r.svg_width_mm);
  std::vector<std::vector<Vec2>> strokes;
  for (auto& stroke : toolpath::read_svg(r.svg, r.chord_um * kMicrometre))
    strokes.push_back(std::move(stroke.points));
  return in_context_of(r.svg, [&] { return toolpath::drawing_on_surface(mesh, strokes, place); });
}

std::vector<std::vector<Vec3>> curves_on(const geometry::Mesh& mesh, const SurfaceRequest& r,
                                         const toolpath::SurfacePlan& plan, const Progress& progress) {
  if (!r.svg.empty()) return strokes_of_svg(mesh, r);
  if (!r.curves.empty()) {
    std::vector<std::vector<Vec3>> read;
    for (const std::string& file : r.curves) read.push_back(toolpath::read_curve_csv(file));
    return read;
  }
  toolpath::SectionRows rows;
  rows.point = from_mm(1) * Vec3(r.section[0], r.section[1], r.section[2]);
  const Vec3 normal(r.section[3], r.section[4], r.section[5]);
  if (!(normal.norm() > 1e-9)) throw InputError("--section: the plane's normal has no length");
  rows.normal = normal.normalized();
  rows.count = r.rows;
  rows.pitch = r.pitch_mm > 0 ? from_mm(r.pitch_mm)
                              : toolpath::bead_area(plan.bead_width, plan.bead_height) / plan.bead_height;
  rows.tilt_min = from_deg(r.tilt_deg[0]);
  rows.tilt_max = from_deg(r.tilt_deg[1]);
  rows.progress = progress;
  return toolpath::section_rows(mesh, rows);
}

constexpr double kPass = 0.2 * kMillimetre;

/// What the tool lays, cures or cuts.
void fill_process(const SurfaceRequest& r, const machine::MachineDescription& machine,
                  toolpath::SurfacePlan& plan) {
  plan.cuts = !machine.tool.prints();
  plan.bead_width = from_mm(r.options.bead_width_mm);
  plan.bead_height = bead_height(r.options, machine);
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = r.options.temperature_c + kCelsiusZero;
  plan.fan = r.options.fan;
  if (plan.cuts) {
    plan.gap = 0;
    plan.bead_height = r.options.bead_height_mm > 0 ? from_mm(r.options.bead_height_mm) : kPass;
    return;
  }
  const auto cure = machine::load_cure(r.options.machine);
  if (!cure) return;
  const double depth = cure->depth(plan.feed), area = cure->area(plan.feed, plan.bead_height);
  if (!(depth > plan.bead_height))
    throw InputError(fmt::format(
        "--feed {:g} mm/s: the light cures {:.3f} mm deep, less than the layer of {:.3f} mm: go slower",
        r.options.feed_mm_per_s, to_mm(depth), to_mm(plan.bead_height)));
  plan.temperature = 0;
  // As wide as the flattened bead that has the section of what is cured.
  plan.bead_width =
      plan.bead_height + std::max(0.0, area / plan.bead_height - std::numbers::pi / 4 * plan.bead_height);
}

int plan_surface(const SurfaceRequest& r) {
  check(r);
  const auto machine = machine::load_machine(r.options.machine);
  const auto mesh = geometry::read_stl(machine::find_fixture(r.part));
  toolpath::SurfacePlan plan;
  plan.gap = machine.gap.aim;
  plan.standoff = machine.gap.standoff;
  plan.clearance = from_mm(r.options.clearance_mm);
  plan.step = from_mm(r.step_mm);
  plan.chord_tolerance = r.chord_um * kMicrometre;
  plan.feed = from_mm(r.options.feed_mm_per_s);
  plan.approach_feed = from_mm(r.options.approach_mm_per_s);
  fill_process(r, machine, plan);
  plan.tilt_max = std::numbers::pi;  // the machine says
  plan.upright = r.upright;
  plan.curve_files = r.curves;
  const auto program = with_progress(!r.options.quiet, [&](const Progress& progress) {
    const auto curves = curves_on(*mesh, r, plan, stage_of(progress, 0, 0.3));
    plan.progress = stage_of(progress, 0.3, 0.7);
    auto planned = toolpath::plan_surface(*mesh, curves, r.layers, plan);
    if (!r.ignore_reach) check_reach(planned, machine, stage_of(progress, 0.7, 1));
    return planned;
  });
  write_program(program, machine, r.options);
  print_written(r.options, fmt::format("{} steps on {}", program.steps.size(), r.part));
  return kGood;
}

}  // namespace

void add_plan_surface(CLI::App& plan, Action& action) {
  auto request = std::make_shared<SurfaceRequest>();
  auto* surface =
      plan.add_subcommand("surface", "Curves on any surface, the tool along the surface's normal");
  surface->add_option("part", request->part, "STL in mm, or a name under models/parts")->required();
  add_machine_option(*surface, request->options);
  surface->add_option("--curve", request->curves,
                      "CSV x_mm,y_mm,z_mm of a curve near the surface; several, one after the other, are the "
                      "strokes of a drawing");
  surface->add_option("--svg", request->svg,
                      "SVG drawing whose outlines are laid on the part, its upper side uphill");
  surface->add_option("--svg-at", request->svg_at,
                      "X,Y,Z in mm on the part, where the middle of the drawing goes");
  surface->add_option("--svg-turn", request->svg_turn_deg, "degrees about the part's normal there")
      ->check(CLI::Range(-360.0, 360.0))
      ->capture_default_str();
  surface->add_option("--svg-width", request->svg_width_mm, "mm, of the whole drawing; 0: as the file has it")
      ->capture_default_str();
  surface->footer(
      "Example: understudy plan surface slanted_box --svg usc.svg --svg-at 0,0,18 --svg-width 22 -o "
      "usc.gcode");
  surface->add_option("--section", request->section, "without --curve: cut by the plane x y z nx ny nz (mm)")
      ->expected(6)
      ->capture_default_str();
  surface
      ->add_option("--tilt", request->tilt_deg,
                   "keep the section where the normal tilts from..to degrees about the plane's normal")
      ->expected(2)
      ->capture_default_str();
  surface
      ->add_option("--rows", request->rows, "sections side by side, to and fro, the given one in the middle")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  surface->add_option("--pitch", request->pitch_mm, "mm from row to row; 0: as wide as a bead's volume fills")
      ->capture_default_str();
  surface->add_option("--layers", request->layers, "one on the other, each a bead's height farther out")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  surface->add_flag("--upright", request->upright, "the tool stays vertical: to compare with");
  surface->add_flag("--ignore-reach", request->ignore_reach, "do not ask the machine whether it gets there");
  surface->add_option("--step", request->step_mm, "mm between points at most")->capture_default_str();
  surface->add_option("--chord", request->chord_um, "um between chord and surface at most")
      ->capture_default_str();
  add_motion_options(*surface, request->options);
  add_bead_options(*surface, request->options);
  add_nozzle_options(*surface, request->options);
  add_output_option(*surface, request->options);
  surface->callback([=, &action] { action = [=] { return plan_surface(*request); }; });
}

}  // namespace understudy::cli
