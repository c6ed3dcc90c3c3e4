#include "toolpath/lattice/tool_escape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "toolpath/polyline.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

constexpr double kUpright = 1 - 1e-12;
// On along the axis before the tool turns or rises. [m]
constexpr std::array<double, 5> kFurther = {0, 10e-3, 20e-3, 40e-3, 80e-3};

}  // namespace

ToolEscape::ToolEscape(const ToolEnvelope& tool, double margin, double lift)
    : tool_(tool), margin_(margin), lift_(lift) {}

bool ToolEscape::clears(const std::vector<StrutBody>& built, const ToolMotion& motion) const {
  const double around = tool_.reach() + margin_;
  return std::all_of(built.begin(), built.end(), [&](const StrutBody& strut) {
    const Vec3 middle = 0.5 * (strut.from + strut.to);
    const double half = 0.5 * (strut.to - strut.from).norm() + strut.radius;
    return segment_distance(middle, motion.from, motion.to) > around + half ||
           tool_.clears(strut, motion, margin_);
  });
}

bool ToolEscape::turn_clears(const std::vector<StrutBody>& built, const Vec3& tip, const Vec3& axis) const {
  const double around = tool_.reach() + margin_;
  return std::all_of(built.begin(), built.end(), [&](const StrutBody& strut) {
    return segment_distance(tip, strut.from, strut.to) > around + strut.radius ||
           tool_.clears_turn(strut, tip, axis, Vec3::UnitZ(), margin_);
  });
}

std::optional<std::vector<Pose>> ToolEscape::find(
    const Vec3& start, const Vec3& axis, const std::vector<StrutBody>& built,
    const std::function<bool(const std::vector<Pose>&)>& accept) const {
  double top = 0;
  Eigen::AlignedBox3d box(start);
  for (const StrutBody& strut : built) {
    top = std::max({top, strut.from.z() + strut.radius, strut.to.z() + strut.radius});
    box.extend(strut.from).extend(strut.to);
  }
  const auto at_level = [](Vec3 p, double level) {
    p.z() = std::max(p.z(), level);
    return p;
  };
  const double level = top + lift_;
  if (axis.z() > kUpright) {
    const std::vector<Pose> way = {tool_at(start, axis), tool_at(at_level(start, level), axis)};
    return accept(way) ? std::optional(way) : std::nullopt;
  }
  // Above this the tool turns upright without any body of it coming down to the struts.
  const double turning = level - tool_.lowest(axis);
  for (const double further : kFurther) {
    const Vec3 out = start + further * axis, above = at_level(out, level), high = at_level(out, turning);
    std::vector<Pose> way = {tool_at(start, axis)};
    if (further > 0) way.push_back(tool_at(out, axis));
    const Vec3 over_middle(box.center().x(), box.center().y(), high.z());
    std::vector<Pose> upright_first = way, up_first = way, over_first;
    upright_first.insert(upright_first.end(), {tool_at(out, Vec3::UnitZ()), tool_at(above, Vec3::UnitZ())});
    up_first.insert(up_first.end(), {tool_at(high, axis), tool_at(high, Vec3::UnitZ())});
    over_first = up_first;
    over_first.back() = tool_at(over_middle, axis);
    over_first.push_back(tool_at(over_middle, Vec3::UnitZ()));
    // A leaning tool rises clear of what lies beyond the plane that it has come out of.
    if (clears(built, {out, high, axis})) {
      if (accept(up_first)) return up_first;
      if (accept(over_first)) return over_first;
    }
    // The machine is asked first: it answers sooner.
    if (accept(upright_first) && clears(built, {out, above, Vec3::UnitZ()}) && turn_clears(built, out, axis))
      return upright_first;
  }
  return std::nullopt;
}

}  // namespace understudy::toolpath
