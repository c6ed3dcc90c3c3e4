#include "rehearsal/observers/flow_watch.h"

#include <algorithm>
#include <cmath>

#include "rehearsal/program/programmed_areas.h"

namespace understudy::rehearsal {
namespace {

constexpr double kShortestPath = 50e-6;  // [m]: on less, what is fed is no bead

}  // namespace

FlowWatch::FlowWatch(const toolpath::Program& program, const machine::MachineDescription& machine)
    : areas_(programmed_areas(program, machine)) {}

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
