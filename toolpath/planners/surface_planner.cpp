#include "toolpath/planners/surface_planner.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/error_context.h"
#include "core/units.h"
#include "toolpath/planners/curve_sampling.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

using geometry::SurfacePoint;

constexpr int kMostLayers = 1000;

void check_plan(const SurfacePlan& plan) {
  if (!plan.cuts) check_positive("gap", to_mm(plan.gap), "mm");
  check_positive("standoff", to_mm(plan.standoff), "mm");
  check_positive("clearance", to_mm(plan.clearance), "mm");
  check_positive("step", to_mm(plan.step), "mm");
  check_within("chord tolerance", to_mm(plan.chord_tolerance), 1e-3, 10, "mm");
  check_positive("feed", plan.feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach feed", plan.approach_feed / kMillimetrePerMinute, "mm/min");
  if (plan.cuts) {
    check_positive("depth of a pass", to_mm(plan.bead_height), "mm");
  } else {
    check_bead(plan.bead_width, plan.bead_height);
    check_positive("filament diameter", to_mm(plan.filament_diameter), "mm");
  }
  check_positive("largest tilt", to_deg(plan.tilt_max), "deg");
  if (plan.clearance < plan.standoff)
    throw InputError(fmt::format("clearance is {:g} mm, less than the standoff of {:g} mm",
                                 to_mm(plan.clearance), to_mm(plan.standoff)));
  check_nozzle(plan.temperature, plan.fan);
}

void check_tilt(const std::vector<SurfacePoint>& path, double tilt_max) {
  for (const SurfacePoint& s : path) {
    const double tilt = std::atan2(s.normal.head<2>().norm(), s.normal.z());
    if (tilt > tilt_max + 1e-9)  // a curve clipped at the limit lies on it to rounding
      throw InputError(fmt::format("the surface at {} tilts the tool {:.3f} deg, more than {:.3f} deg",
                                   in_mm(s.position), to_deg(tilt), to_deg(tilt_max)));
  }
}

// One stroke of a bead whose lower side is `base` above the surface.
void add_stroke(ProgramBuilder& program, const std::vector<SurfacePoint>& path, double base,
                const SurfacePlan& plan) {
  const auto tool = [&](const SurfacePoint& s, double height) {
    return plan.upright ? make_pose(Mat3::Identity(), s.position + (base + height) * s.normal)
                        : tool_at(s.position, s.normal, base + height);
  };
  const Pose above = tool(path.front(), plan.gap + plan.clearance);
  if (program.empty() && !plan.cuts) program.begin(above, plan.temperature, plan.fan);
  program.travel(above);
  program.travel(tool(path.front(), plan.gap + plan.standoff));
  program.move(tool(path.front(), plan.gap), plan.approach_feed);
  const double middle = base + 0.5 * plan.bead_height,
               area = plan.cuts ? 0 : bead_area(plan.bead_width, plan.bead_height);
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (plan.cuts) {
      program.move(tool(path[i], plan.gap), plan.feed);
      continue;
    }
    const Vec3 from = path[i - 1].position + middle * path[i - 1].normal;
    const Vec3 to = path[i].position + middle * path[i].normal;
    program.print(tool(path[i], plan.gap), plan.feed, area * (to - from).norm());
  }
  program.travel(tool(path.back(), plan.gap + plan.clearance));
}

}  // namespace

Program plan_surface(const geometry::Mesh& mesh, const std::vector<Vec3>& curve, const SurfacePlan& plan) {
  return plan_surface(mesh, std::vector<std::vector<Vec3>>{curve}, 1, plan);
}

Program plan_surface(const geometry::Mesh& mesh, const std::vector<std::vector<Vec3>>& curves, int layers,
                     const SurfacePlan& plan) {
  check_plan(plan);
  check_within("number of layers", layers, 1, kMostLayers, "layers");
  if (curves.empty()) throw InputError("there are 0 curves to print, it needs 1");
  std::vector<std::vector<SurfacePoint>> paths;
  const double outermost = plan.gap + (layers - 1) * plan.bead_height;
  for (const auto& curve : curves) {
    const std::size_t i = paths.size();
    in_context_of(i < plan.curve_files.size() ? plan.curve_files[i] : "", [&] {
      paths.push_back(sample_curve(mesh, curve, {outermost, plan.step, plan.chord_tolerance}));
      if (!plan.upright) check_tilt(paths.back(), plan.tilt_max);
    });
    tell(plan.progress, paths.size(), curves.size(), "laying curves on the surface");
  }
  ProgramBuilder program(plan.cuts ? 1.0 : plan.filament_diameter);
  for (int layer = 0; layer < layers; ++layer) {
    const int height = plan.cuts ? layers - 1 - layer : layer;
    for (const auto& path : paths) add_stroke(program, path, height * plan.bead_height, plan);
  }
  return program.take();
}

}  // namespace understudy::toolpath
