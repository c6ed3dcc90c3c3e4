#include "toolpath/planners/spiral.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/bead.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kSwingPerStep = 5 * kDegree;  // of the tool's axis between points

void check(const SpiralPlan& plan) {
  check_positive("radius", to_mm(plan.radius), "mm");
  check_positive("pitch", to_mm(plan.pitch), "mm");
  check_within("number of turns", plan.turns, 0.01, 1000, "turns");
  check_positive("gap", to_mm(plan.gap), "mm");
  check_within("lean", to_deg(plan.lean), 0, 60, "deg");
  check_within("turns to take the lean up", plan.lean_turns, 0, 1000, "turns");
  check_positive("strand diameter", to_mm(plan.strand_diameter), "mm");
  check_within("chord tolerance", to_mm(plan.chord_tolerance), 1e-3, 10, "mm");
  check_positive("feed", plan.feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach feed", plan.approach_feed / kMillimetrePerMinute, "mm/min");
  check_positive("clearance", to_mm(plan.clearance), "mm");
  check_within("dwell at the end", plan.end_dwell, 0, 3600, "s");
  check_positive("filament diameter", to_mm(plan.filament_diameter), "mm");
  check_nozzle(plan.temperature, plan.fan);
  if (plan.turns > 1 && plan.pitch < 2 * plan.strand_diameter)
    throw InputError(fmt::format("pitch is {:g} mm, less than two strands of {:g} mm", to_mm(plan.pitch),
                                 to_mm(plan.strand_diameter)));
}

}  // namespace

Pose spiral_pose(const SpiralPlan& plan, double phi) {
  const double c = std::cos(phi), s = std::sin(phi), turns = phi / kTurn;
  const Vec3 tip = plan.centre + Vec3(plan.radius * c, plan.radius * s, plan.gap + plan.pitch * turns);
  const double done = plan.lean_turns > 0 ? std::clamp(turns / plan.lean_turns, 0.0, 1.0) : 1.0;
  const double tangent = std::atan2(kTurn * plan.radius, plan.pitch);  // from vertical
  const double lean = std::min(plan.lean * done * done * (3 - 2 * done), tangent);
  return tool_at(tip, std::sin(lean) * Vec3(-s, c, 0) + std::cos(lean) * Vec3::UnitZ());
}

double spiral_length(const SpiralPlan& plan) {
  return plan.turns * std::hypot(kTurn * plan.radius, plan.pitch);
}

Program plan_spiral(const SpiralPlan& plan) {
  check(plan);
  // A chord over the angle a of the circle lies r (1 - cos(a / 2)) inside.
  const double chord = 2 * std::acos(std::max(0.0, 1 - plan.chord_tolerance / plan.radius));
  const double angle = plan.turns * kTurn;
  const int parts = static_cast<int>(std::ceil(angle / std::min(chord, kSwingPerStep)));
  const double volume = strand_area(plan.strand_diameter) * spiral_length(plan) / parts;
  const auto above = [&](Pose X_WT) {
    X_WT.translation() += plan.clearance * tool_axis(X_WT);
    return X_WT;
  };
  const Pose start = spiral_pose(plan, 0);
  ProgramBuilder program(plan.filament_diameter);
  program.begin(above(start), plan.temperature, plan.fan);
  program.travel(above(start));
  program.move(start, plan.approach_feed);
  for (int i = 1; i <= parts; ++i) program.print(spiral_pose(plan, angle * i / parts), plan.feed, volume);
  program.dwell(plan.end_dwell);
  program.travel(above(program.tool()));
  return program.take();
}

}  // namespace understudy::toolpath
