#include "calibration/rows/held_columns.h"

#include <algorithm>
#include <cmath>

namespace understudy::calibration {
namespace {

using Eigen::Index;
using kinematics::Chain;
using kinematics::ChainAxis;

constexpr double kLever = 0.17;  // [m], at which a shift counts as much as a turn
constexpr double kMoved = 0.2;   // of the motion, above which a line follows it

/// Of a body, in O: about the line through `centre`.
struct Motion {
  Vec3 turn, centre, shift;
};

Motion along_axis(const ChainAxis& axis) {
  if (axis.angle) return {axis.direction, axis.point, Vec3::Zero()};
  return {Vec3::Zero(), Vec3::Zero(), axis.direction * kLever};
}

class Holder {
 public:
  Holder(const Chain& chain, const StationaryAxes& stands) : chain_(chain), stands_(stands) {
    for (const ChainAxis& axis : chain.axes) {
      first_.push_back(count_);
      count_ += axis.angle ? 5 : 3;
    }
  }

  bool moves(std::size_t axis) const { return stands_.empty() || !stands_[axis]; }
  std::size_t first_moving() const {
    std::size_t axis = 0;
    while (axis < chain_.axes.size() && !moves(axis)) ++axis;
    return axis;
  }
  void hold_axis(std::size_t axis) {
    for (Index k = first(axis); k < end(axis); ++k) held_.push_back(k);
  }

  Index first(std::size_t axis) const { return first_[axis]; }
  Index end(std::size_t axis) const { return first_[axis] + (chain_.axes[axis].angle ? 5 : 3); }

  /// The parameter that follows the motion most, of the first line that follows it of those behind `axis`, or
  /// of those that it carries.
  bool hold_line(std::size_t axis, const Motion& motion, bool carried_only) {
    for (std::size_t j = axis + 1; j < chain_.axes.size(); ++j) {
      if (!moves(j) || (carried_only && !carries(axis, static_cast<int>(j)))) continue;
      const ChainAxis& line = chain_.axes[j];
      const auto [u, v] = across(line);
      if (hold_most({{first_[j] + 1, motion.turn.dot(u)}, {first_[j] + 2, motion.turn.dot(v)}})) return true;
      if (!line.angle) continue;
      const Vec3 by = motion.shift + motion.turn.cross(line.point - motion.centre);
      if (hold_most({{first_[j] + 3, by.dot(u) / kLever}, {first_[j] + 4, by.dot(v) / kLever}})) return true;
    }
    return false;
  }

  void hold_tool(const Motion& motion) {
    const Mat3 R = chain_.X_OT_zero.linear().transpose();
    const Vec3 turn = R * motion.turn, shift = R * motion.shift / kLever;
    std::vector<Share> shares;
    for (Index k = 0; k < 3; ++k) shares.push_back({count_ + k, shift[k]});
    for (Index k = 0; k < 3; ++k) shares.push_back({count_ + 3 + k, turn[k]});
    hold_most(shares);
  }

  bool carries(std::size_t axis, int last) const {
    for (int k = last; k >= 0; k = chain_.axes[static_cast<std::size_t>(k)].parent)
      if (k == static_cast<int>(axis)) return true;
    return false;
  }

  void hold(Index column) { held_.push_back(column); }
  std::vector<Index> held() const { return held_; }

 private:
  struct Share {
    Index column;
    double moved;
  };

  bool hold_most(std::vector<Share> shares) {
    std::erase_if(shares, [this](const Share& share) {
      return std::find(held_.begin(), held_.end(), share.column) != held_.end();
    });
    const auto most = std::max_element(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
      return std::abs(a.moved) < std::abs(b.moved);
    });
    if (most == shares.end() || std::abs(most->moved) < kMoved) return false;
    held_.push_back(most->column);
    return true;
  }

  const Chain& chain_;
  const StationaryAxes& stands_;
  std::vector<Index> first_, held_;
  Index count_ = 0;
};

/// What the base can do beside its first axis's own motion, when that axis stays where it is.
std::vector<Motion> motions_of_base(const ChainAxis& axis) {
  if (axis.angle) return {{Vec3::Zero(), Vec3::Zero(), axis.direction * kLever}};
  const auto [u, v] = across(axis);
  return {{axis.direction, Vec3::Zero(), Vec3::Zero()},
          {Vec3::Zero(), Vec3::Zero(), u * kLever},
          {Vec3::Zero(), Vec3::Zero(), v * kLever}};
}

}  // namespace

std::vector<Index> held_columns(const Chain& chain, bool base_free, bool tool_free,
                                const StationaryAxes& stands) {
  Holder holder(chain, stands);
  for (std::size_t i = 0; i < chain.axes.size(); ++i) {
    const Motion motion = along_axis(chain.axes[i]);
    if (!holder.moves(i) || holder.hold_line(i, motion, true)) continue;
    const bool with_tool = holder.carries(i, chain.tool_axis);
    if (with_tool ? tool_free : base_free)  // the target's motion, or that of the measuring frame
      holder.hold(holder.first(i));
    else if (with_tool)
      holder.hold_tool(motion);
  }
  const std::size_t base = holder.first_moving();
  if (base_free && base < chain.axes.size()) {
    for (const Motion& motion : motions_of_base(chain.axes[base]))
      if (!holder.hold_line(base, motion, false) && !tool_free) holder.hold_tool(motion);
    holder.hold_axis(base);
  }
  for (std::size_t i = 0; i < chain.axes.size(); ++i)
    if (!holder.moves(i)) holder.hold_axis(i);
  return holder.held();
}

}  // namespace understudy::calibration
