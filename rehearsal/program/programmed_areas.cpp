#include "rehearsal/program/programmed_areas.h"

#include <algorithm>
#include <numbers>

namespace understudy::rehearsal {
namespace {

constexpr double kShortestPath = 50e-6;  // [m]: on less, what is fed is no bead

}  // namespace

std::vector<float> programmed_areas(const toolpath::Program& program,
                                    const machine::MachineDescription& machine) {
  const double d = machine.tool.filament_diameter, filament_area = std::numbers::pi / 4 * d * d;
  Vec3 tip = (machine.X_WB * machine.X_BT_home).translation();
  double fed = 0, most = 0;
  int last_line = 0;
  for (const toolpath::Step& step : program.steps) last_line = std::max(last_line, step.line);
  std::vector<float> areas(static_cast<std::size_t>(last_line) + 1, 0);
  for (const toolpath::Step& step : program.steps) {
    fed += step.filament;
    const double fresh = std::max(0.0, fed - most);
    most = std::max(most, fed);
    const Vec3 end = step.X_WT.translation();
    const double path = toolpath::moves(step) ? (end - tip).norm() : 0;
    if (toolpath::moves(step)) tip = end;
    const auto line = static_cast<std::size_t>(std::max(0, step.line));
    if (path > kShortestPath) areas[line] = static_cast<float>(fresh * filament_area / path);
  }
  return areas;
}

}  // namespace understudy::rehearsal
