#include "toolpath/surface_planner.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/curve_sampling.h"

namespace understudy::toolpath {
namespace {

using geometry::SurfacePoint;

void check_positive(const char* name, double value, const char* unit) {
  if (!(value > 0 && std::isfinite(value)))
    throw InputError(fmt::format("{} is {:g} {}, it must be above 0 {}", name, value, unit, unit));
}

void check_plan(const SurfacePlan& plan) {
  check_positive("gap", to_mm(plan.gap), "mm");
  check_positive("standoff", to_mm(plan.standoff), "mm");
  check_positive("clearance", to_mm(plan.clearance), "mm");
  check_positive("step", to_mm(plan.step), "mm");
  check_positive("chord tolerance", to_mm(plan.chord_tolerance), "mm");
  check_positive("feed", plan.feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach feed", plan.approach_feed / kMillimetrePerMinute, "mm/min");
  check_positive("bead width", to_mm(plan.bead_width), "mm");
  check_positive("bead height", to_mm(plan.bead_height), "mm");
  check_positive("filament diameter", to_mm(plan.filament_diameter), "mm");
  check_positive("largest tilt", to_deg(plan.tilt_max), "deg");
  if (plan.clearance < plan.standoff)
    throw InputError(fmt::format("clearance is {:g} mm, less than the standoff of {:g} mm",
                                 to_mm(plan.clearance), to_mm(plan.standoff)));
  if (plan.bead_width < plan.bead_height)
    throw InputError(fmt::format("bead width is {:g} mm, less than its height of {:g} mm",
                                 to_mm(plan.bead_width), to_mm(plan.bead_height)));
  if (!(plan.fan >= 0 && plan.fan <= 1))
    throw InputError(fmt::format("fan is {:g}, outside 0 to 1", plan.fan));
  if (!(plan.temperature >= 0 && std::isfinite(plan.temperature)))
    throw InputError(fmt::format("temperature is {:g} K, it must not be below 0 K", plan.temperature));
}

void check_tilt(const std::vector<SurfacePoint>& path, double tilt_max) {
  for (const SurfacePoint& s : path) {
    const double tilt = std::atan2(s.normal.head<2>().norm(), s.normal.z());
    if (tilt > tilt_max + 1e-9)  // a curve clipped at the limit lies on it to rounding
      throw InputError(
          fmt::format("the surface at ({:.3f}, {:.3f}, {:.3f}) mm tilts the tool {:.3f} deg, more than "
                      "{:.3f} deg",
                      to_mm(s.position.x()), to_mm(s.position.y()), to_mm(s.position.z()), to_deg(tilt),
                      to_deg(tilt_max)));
  }
}

class SurfaceProgram {
 public:
  explicit SurfaceProgram(const SurfacePlan& plan) : plan_(plan) {}

  Program run(const std::vector<SurfacePoint>& path) {
    // Steps that do not move leave the tool where the program will put it first.
    const Pose above = tool(path.front(), plan_.gap + plan_.clearance);
    if (plan_.temperature > 0) {
      Step& heat = add(StepKind::temperature, above);
      heat.temperature = plan_.temperature;
      heat.wait = true;
    }
    add(StepKind::fan, above).fan = plan_.fan;
    add(StepKind::travel, above);
    add(StepKind::travel, tool(path.front(), plan_.gap + plan_.standoff));
    add(StepKind::move, tool(path.front(), plan_.gap)).feed = plan_.approach_feed;
    for (std::size_t i = 1; i < path.size(); ++i) {
      Step& print = add(StepKind::print, tool(path[i], plan_.gap));
      print.feed = plan_.feed;
      print.filament = filament(path[i - 1], path[i]);
    }
    add(StepKind::travel, tool(path.back(), plan_.gap + plan_.clearance));
    return std::move(program_);
  }

 private:
  static Pose tool(const SurfacePoint& s, double height) {
    return make_pose(shortest_arc_from_z(s.normal), s.position + height * s.normal);
  }
  double filament(const SurfacePoint& from, const SurfacePoint& to) const {
    const double half = 0.5 * plan_.bead_height;
    const double length = (to.position + half * to.normal - from.position - half * from.normal).norm();
    const double d = plan_.filament_diameter;
    return bead_area(plan_.bead_width, plan_.bead_height) * length / (std::numbers::pi / 4 * d * d);
  }
  Step& add(StepKind kind, const Pose& X_WT) {
    Step step;
    step.kind = kind;
    step.X_WT = X_WT;
    program_.steps.push_back(step);
    return program_.steps.back();
  }

  SurfacePlan plan_;
  Program program_;
};

}  // namespace

double bead_area(double width, double height) {
  return (width - height) * height + std::numbers::pi / 4 * height * height;
}

Program plan_surface(const geometry::Mesh& mesh, const std::vector<Vec3>& curve, const SurfacePlan& plan) {
  check_plan(plan);
  const auto path = sample_curve(mesh, curve, {plan.gap, plan.step, plan.chord_tolerance});
  check_tilt(path, plan.tilt_max);
  return SurfaceProgram(plan).run(path);
}

}  // namespace understudy::toolpath
