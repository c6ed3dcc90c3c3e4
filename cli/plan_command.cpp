#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "core/error.h"
#include "core/output_file.h"
#include "core/units.h"
#include "machine/description.h"
#include "rehearsal/rehearse.h"
#include "toolpath/gcode.h"
#include "toolpath/surface_planner.h"

namespace understudy::cli {
namespace {

/// Options in the units of the command line.
struct SurfaceRequest {
  std::string part, machine = "hexapod", curve, output;
  std::vector<double> section{0, 0, 0, 0, 1, 0};  ///< point [mm] and normal of the cutting plane
  std::vector<double> tilt_deg{-20, 20};
  double feed_mm_per_s = 5, approach_mm_per_s = 1, step_mm = 0.5, chord_um = 2, clearance_mm = 8;
  double bead_width_mm = 0.48, bead_height_mm = 0;
  double temperature_c = 230, fan = 0;
};

void check(const SurfaceRequest& r) {
  const auto positive = [](const char* name, double value, double limit) {
    if (!(value > 0) || value > limit)
      throw InputError(fmt::format("{} {:g} is outside 0..{:g}", name, value, limit));
  };
  positive("--feed", r.feed_mm_per_s, 500);
  positive("--approach-feed", r.approach_mm_per_s, 50);
  positive("--step", r.step_mm, 50);
  positive("--chord", r.chord_um, 1000);
  positive("--clearance", r.clearance_mm, 100);
  positive("--width", r.bead_width_mm, 10);
  if (r.tilt_deg[0] >= r.tilt_deg[1])
    throw InputError(
        fmt::format("--tilt {:g} {:g}: the first must be smaller", r.tilt_deg[0], r.tilt_deg[1]));
  if (r.temperature_c < 100 || r.temperature_c > 450)
    throw InputError(fmt::format("--temperature {:g} C is outside 100..450 C", r.temperature_c));
}

std::vector<Vec3> curve_on(const geometry::Mesh& mesh, const SurfaceRequest& r) {
  if (!r.curve.empty()) return toolpath::read_curve_csv(r.curve);
  const Vec3 point = from_mm(1) * Vec3(r.section[0], r.section[1], r.section[2]);
  const Vec3 normal = Vec3(r.section[3], r.section[4], r.section[5]);
  if (!(normal.norm() > 1e-9)) throw InputError("--section: the plane's normal has no length");
  const Vec3 n = normal.normalized();
  const auto section = toolpath::section_curve(mesh, point, n, Vec3::UnitZ());
  return toolpath::clip_by_tilt(mesh, section, from_deg(r.tilt_deg[0]), from_deg(r.tilt_deg[1]), n);
}

int plan_surface(const SurfaceRequest& r) {
  check(r);
  const auto machine = machine::load_machine(r.machine);
  const auto mesh = geometry::read_stl(rehearsal::find_fixture(r.part));
  toolpath::SurfacePlan plan;
  plan.gap = machine.gap.aim;
  plan.standoff = machine.gap.standoff;
  plan.clearance = from_mm(r.clearance_mm);
  plan.step = from_mm(r.step_mm);
  plan.chord_tolerance = r.chord_um * kMicrometre;
  plan.feed = from_mm(r.feed_mm_per_s);
  plan.approach_feed = from_mm(r.approach_mm_per_s);
  plan.bead_width = from_mm(r.bead_width_mm);
  plan.bead_height = r.bead_height_mm > 0 ? from_mm(r.bead_height_mm) : machine.gap.aim;
  plan.filament_diameter = machine.tool.filament_diameter;
  plan.temperature = r.temperature_c + 273.15;
  plan.fan = r.fan;
  plan.tilt_max = from_deg(30);
  const auto program = toolpath::plan_surface(*mesh, curve_on(*mesh, r), plan);
  write_file(r.output, toolpath::write_gcode(program, {"planned by: " + command_line()}));
  fmt::print("{}: {} steps on {}\n", r.output, program.steps.size(), r.part);
  return kGood;
}

}  // namespace

void add_plan(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("plan", "Make a program for a part");
  command->require_subcommand(1);
  auto request = std::make_shared<SurfaceRequest>();
  auto* surface =
      command->add_subcommand("surface", "A curve on any surface, the tool along the surface's normal");
  surface->add_option("part", request->part, "STL in mm, or a name under models/parts")->required();
  surface->add_option("--machine", request->machine, "gap, standoff and filament come from it")
      ->capture_default_str();
  surface->add_option("--curve", request->curve, "CSV x_mm,y_mm,z_mm of a curve near the surface");
  surface->add_option("--section", request->section, "without --curve: cut by the plane x y z nx ny nz (mm)")
      ->expected(6)
      ->capture_default_str();
  surface
      ->add_option("--tilt", request->tilt_deg,
                   "keep the section where the normal tilts from..to degrees about the plane's normal")
      ->expected(2)
      ->capture_default_str();
  surface->add_option("--feed", request->feed_mm_per_s, "mm/s")->capture_default_str();
  surface->add_option("--approach-feed", request->approach_mm_per_s, "mm/s, from S' to S")
      ->capture_default_str();
  surface->add_option("--step", request->step_mm, "mm between points at most")->capture_default_str();
  surface->add_option("--chord", request->chord_um, "um between chord and surface at most")
      ->capture_default_str();
  surface->add_option("--clearance", request->clearance_mm, "mm above the surface for travel")
      ->capture_default_str();
  surface->add_option("--width", request->bead_width_mm, "mm, width of the bead")->capture_default_str();
  surface->add_option("--height", request->bead_height_mm, "mm, height of the bead; 0: the gap")
      ->capture_default_str();
  surface->add_option("--temperature", request->temperature_c, "C, nozzle")->capture_default_str();
  surface->add_option("--fan", request->fan, "0..1")->check(CLI::Range(0.0, 1.0))->capture_default_str();
  surface->add_option("-o,--output", request->output, "G-code to write")->required();
  surface->callback([=, &action] { action = [=] { return plan_surface(*request); }; });
}

}  // namespace understudy::cli
