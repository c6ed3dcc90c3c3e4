#include "rehearsal/flow_watch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace understudy::rehearsal {
namespace {

constexpr double kShortestPath = 50e-6;  // [m]: on less, what is fed is no bead

}  // namespace

FlowWatch::FlowWatch(const toolpath::Program& program, const machine::MachineDescription& machine) {
  const double d = machine.tool.filament_diameter, filament_area = std::numbers::pi / 4 * d * d;
  Vec3 tip = (machine.X_WB * machine.X_BT_home).translation();
  double fed = 0, most = 0;
  for (const toolpath::Step& step : program.steps) {
    fed += step.filament;
    const double fresh = std::max(0.0, fed - most);
    most = std::max(most, fed);
    const Vec3 end = step.X_WT.translation();
    const double path = toolpath::moves(step) ? (end - tip).norm() : 0;
    if (toolpath::moves(step)) tip = end;
    const auto line = static_cast<std::size_t>(std::max(0, step.line));
    if (line >= areas_.size()) areas_.resize(line + line / 2 + 64, 0);
    if (path > kShortestPath) areas_[line] = static_cast<float>(fresh * filament_area / path);
  }
}

void FlowWatch::add(const sim::LaidBead& bead) {
  const auto line = static_cast<std::size_t>(std::max(0, bead.line));
  const double asked = line < areas_.size() ? static_cast<double>(areas_[line]) : 0;
  if (!bead.follows) end();
  if (asked <= 0 || bead.path < kShortestPath) return end();
  const double ratio = bead.volume / bead.path / asked;
  if (std::abs(ratio - 1) <= kFlowTolerance) return end();
  const bool same_side = (ratio > 1) == (open_.ratio > 1);
  if (!is_open_ || !same_side) {
    end();
    open_ = {bead.start_line, bead.start_time, bead.from_W, 0, ratio, 0};
    is_open_ = true;
  }
  open_.length += bead.path;
  open_.amount += (ratio - 1) * bead.path;
  if (std::abs(ratio - 1) > std::abs(open_.ratio - 1)) open_.ratio = ratio;
}

void FlowWatch::end() {
  if (is_open_) stretches_.push_back(open_);
  is_open_ = false;
}

std::vector<FlowStretch> FlowWatch::stretches() const {
  std::vector<FlowStretch> all = stretches_;
  if (is_open_) all.push_back(open_);
  std::erase_if(
      all, [](const FlowStretch& s) { return s.length < kFlowLength && std::abs(s.amount) < kFlowLength; });
  return all;
}

}  // namespace understudy::rehearsal
