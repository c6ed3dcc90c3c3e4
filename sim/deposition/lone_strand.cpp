#include "sim/deposition/lone_strand.h"

#include <algorithm>
#include <limits>

namespace understudy::sim {
namespace {

constexpr double kEndOn = 0.1;  // sine of the angle to the tool axis: it is its end that is below
constexpr double kLevel = 0.2;  // of the width: how much lower a neighbour of a floor of strands may be felt

Vec3 wide(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

double carrier_width(const Workpiece& workpiece, const Pose& X_WT, const Workpiece::Hit& below,
                     std::size_t before) {
  constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  const Bead bead = workpiece.beads().bead(below.bead);
  const auto width = static_cast<double>(bead.width);
  const Vec3 axis = tool_axis(X_WT), along = wide(bead.to_W) - wide(bead.from_W);
  const Vec3 across = axis.cross(along);
  const bool end_on = across.norm() <= kEndOn * along.norm();
  const Vec3 step = width * (end_on ? axis.unitOrthogonal() : Vec3(across.normalized()));
  for (const double side : {1.0, -1.0}) {
    Pose beside = X_WT;
    beside.translation() += side * step;
    const double lowest = below.distance + kLevel * width;
    const auto found = workpiece.below(beside, before, BeadIndex::kAll, std::max(0.0, lowest));
    if (!found || found->distance > lowest) return width;
  }
  return kNoLimit;
}

}  // namespace understudy::sim
