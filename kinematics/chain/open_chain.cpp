#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinematics/chain/chain_kind.h"
#include "kinematics/chain/chain_mechanism.h"

namespace understudy::kinematics {
namespace {

constexpr int kFurtherStarts = 128;
constexpr double kReachSlack = 1e-9;  // [m], rounding of a reach of metres and to spare

using Axes = AxisVector;

/// Halton's sequence: fills the box of all axes evenly, however many starts are tried.
double halton(int index, int base) {
  double fraction = 1, value = 0;
  for (; index > 0; index /= base) {
    fraction /= base;
    value += fraction * (index % base);
  }
  return value;
}

/// Where starts are worth trying: within the range, but no more than a turn, or length_scale for a slide
/// without end, about home.
AxisRange start_range(const ChainAxis& axis, double home, double length_scale) {
  const double reach = axis.angle ? std::numbers::pi : length_scale;
  AxisRange range{std::max(axis.lower, home - reach), std::min(axis.upper, home + reach)};
  if (std::isfinite(axis.lower) && std::isfinite(axis.upper) &&
      (!axis.angle || axis.upper - axis.lower <= 2 * reach))
    range = {axis.lower, axis.upper};
  return range.lower <= range.upper ? range : AxisRange{home, home};
}

/// The tip is never farther than `radius` from the point p_S: links keep the distance between their axes,
/// whatever these do. Infinite where a slide has no end.
struct Reach {
  Vec3 p_S = Vec3::Zero();
  double radius = kEndless;
};

Vec3 foot(const ChainAxis& axis, const Vec3& p) {
  return axis.point + axis.direction * axis.direction.dot(p - axis.point);
}

Reach reach_of(const Chain& chain) {
  // Only where the work stands still: a machine that moves both is seldom asked for what it cannot reach.
  if (chain.work_axis >= 0 || chain.tool_axis < 0) return {};
  std::array<const ChainAxis*, kMaxAxes> path{};  // from the tool down
  int count = 0;
  for (int i = chain.tool_axis; i >= 0; i = path[count++]->parent) path[count] = &chain.axes[i];
  const Vec3 tip = chain.X_OT_zero.translation();
  Vec3 centre = tip, p = tip;
  double radius = 0;
  bool turned = false;
  for (int k = count - 1; k >= 0; --k) {
    const ChainAxis& axis = *path[k];
    if (!axis.angle) {
      radius += std::max(std::abs(axis.lower), std::abs(axis.upper));
    } else if (!turned) {
      centre = p = foot(axis, k > 0 ? path[k - 1]->point : tip);
      turned = true;
    } else {
      const Vec3 next = foot(axis, p);
      radius += (next - p).norm();
      p = next;
    }
  }
  radius += (tip - p).norm();
  return {chain.X_OS_zero.inverse() * centre, radius};
}

class OpenChain final : public ChainMechanism {
 public:
  // A machine of five axes can place the tip and the tool's axis, but no spin.
  explicit OpenChain(const ChainDescription& description)
      : ChainMechanism(description, description.chain.size() >= 6), reach_(reach_of(description.chain)) {
    constexpr int kPrimes[kMaxAxes] = {2, 3, 5, 7, 11, 13, 17, 19};
    for (int start = 0; start < kFurtherStarts; ++start)
      for (std::size_t i = 0; i < description.chain.axes.size(); ++i) {
        const AxisRange range =
            start_range(description.chain.axes[i], description.home[i], description.length_scale);
        further_[start][i] = range.lower + halton(start + 1, kPrimes[i]) * (range.upper - range.lower);
      }
  }

  SolveStatus inverse(const Pose& X_ST, std::span<const double> previous,
                      std::span<double> axes) const override;

 private:
  std::array<Axes, kFurtherStarts> further_{};
  Reach reach_;
};

/// What the attempts have come to: a solution within the ranges ends the search, one beyond is kept. Of the
/// reasons, one that came near counts most, and a least distance more than giving up on the way.
struct Search {
  bool found = false;
  Axes axes{};
  SolveStatus reason = SolveStatus::not_converged;
};

SolveStatus OpenChain::inverse(const Pose& X_ST, std::span<const double> previous,
                               std::span<double> axes) const {
  const std::size_t n = chain().axes.size();
  if (axes.size() < n || !is_pose(X_ST) || !usable(previous)) return SolveStatus::bad_input;
  if ((X_ST.translation() - reach_.p_S).norm() > reach_.radius + kReachSlack) return SolveStatus::unreachable;
  const std::span<const double> beside = near(previous);
  Search search;
  // True: no better one will come.
  const auto attempt = [&](std::span<const double> start) {
    Axes at{};
    std::copy_n(start.begin(), n, at.begin());
    const SolveStatus status =
        solve_numerically(chain(), X_ST, follows_spin(), description().length_scale, std::span(at).first(n));
    if (status != SolveStatus::ok) {
      if (search.reason != SolveStatus::singular && status != SolveStatus::not_converged)
        search.reason = status;
      return false;
    }
    const bool settled = settle(previous, at);
    if (settled || !search.found) search.axes = at;
    search.found = true;
    return settled;
  };
  bool settled = attempt(beside);
  if (!settled && !previous.empty()) settled = attempt(description().home);
  for (std::size_t i = 0; i < further_.size() && !settled; ++i) settled = attempt(further_[i]);
  if (!search.found) return search.reason;
  std::copy_n(search.axes.begin(), n, axes.begin());
  return SolveStatus::ok;
}

}  // namespace

ChainKind open_chain_kind() {
  ChainKind kind;
  kind.name = "chain";
  kind.may_be_calibrated = true;
  kind.make = [](const ChainDescription& description) -> std::unique_ptr<Mechanism> {
    return std::make_unique<OpenChain>(description);
  };
  return kind;
}

}  // namespace understudy::kinematics
