#include "machine/draft/table_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/random.h"

namespace understudy::machine {
namespace {

using kinematics::AxisVector;
using kinematics::ChainAxis;
using kinematics::ChainDescription;
using kinematics::Mechanism;

constexpr double kAbove = 0.05;        // [m], of home above the table
constexpr double kLowest = 0.02;       // [m], of a joint above the table
constexpr double kLeastMargin = 0.03;  // share of a range that stays on either side
constexpr int kStarts = 12;            // branches that are tried at each place

/// Within the range, and a turn or a metre to either side of 0 where that lies in it.
double random_position(const ChainAxis& axis, Random& random) {
  const double most = axis.angle ? std::numbers::pi : 1;
  const double lower = std::max(axis.lower, -most), upper = std::min(axis.upper, most);
  return lower < upper ? random.uniform(lower, upper) : random.uniform(axis.lower, axis.upper);
}

AxisVector random_posture(const ChainDescription& d, Random& random) {
  AxisVector axes{};
  for (std::size_t i = 0; i < d.chain.axes.size(); ++i) axes[i] = random_position(d.chain.axes[i], random);
  return axes;
}

class PlaceSearch {
 public:
  PlaceSearch(const ChainDescription& description, double half)
      : d_(description),
        n_(description.chain.axes.size()),
        half_(half),
        mechanism_(make_chain_mechanism(d_)) {}

  TablePlace search() {
    const double reach = horizontal_reach();
    TablePlace best;
    for (const double turn : {0.0, 0.5, -0.5, 1.0}) {
      for (const double height : {0.0, 0.1, 0.25, -0.1})
        for (const double far : {0.5, 0.6, 0.4, 0.7})
          try_place(
              far * reach * Vec3(std::cos(turn * std::numbers::pi), std::sin(turn * std::numbers::pi), 0) +
                  Vec3(axis_B_.x(), axis_B_.y(), height * reach),
              best);
      if (best.found) break;
    }
    if (!best.found) best.home = middle();
    return best;
  }
  TablePlace at_origin() {
    TablePlace best;
    try_place(Vec3::Zero(), best);
    if (!best.found) best.home = middle();
    return best;
  }

 private:
  AxisVector middle() const {
    AxisVector home{};
    for (std::size_t i = 0; i < n_; ++i) {
      const ChainAxis& axis = d_.chain.axes[i];
      const bool bounded = std::isfinite(axis.lower) && std::isfinite(axis.upper);
      home[i] = bounded ? 0.5 * (axis.lower + axis.upper) : std::clamp(0.0, axis.lower, axis.upper);
    }
    return home;
  }

  double horizontal_reach() {
    Random random(1, "reach of a new machine");
    axis_B_ = d_.chain.X_OS_zero.inverse() *
              Vec3(d_.chain.axes.front().angle ? d_.chain.axes.front().point : Vec3(Vec3::Zero()));
    double reach = 0;
    for (int k = 0; k < 1000; ++k) {
      const AxisVector axes = random_posture(d_, random);
      const Vec3 tip = kinematics::forward(d_.chain, std::span(axes).first(n_)).translation() - axis_B_;
      reach = std::max(reach, std::hypot(tip.x(), tip.y()));
    }
    return reach;
  }

  /// Least share of a range that is left on either side; of an axis without range, all.
  double margin(const AxisVector& axes) const {
    double least = 1;
    for (std::size_t i = 0; i < n_; ++i) {
      const ChainAxis& axis = d_.chain.axes[i];
      if (!std::isfinite(axis.lower) || !std::isfinite(axis.upper)) continue;
      least = std::min({least, (axes[i] - axis.lower) / (axis.upper - axis.lower),
                        (axis.upper - axes[i]) / (axis.upper - axis.lower)});
    }
    return least;
  }

  bool above_table(const AxisVector& axes, double table) const {
    std::array<Pose, kinematics::kMaxAxes> X_OL;
    kinematics::link_poses(d_.chain, std::span(axes).first(n_), std::span(X_OL).first(n_));
    const Pose X_BO = d_.chain.X_OS_zero.inverse();
    for (std::size_t i = 1; i < n_; ++i)
      if (d_.chain.axes[i].angle && (X_BO * (X_OL[i] * d_.chain.axes[i].point)).z() < table + kLowest)
        return false;
    return true;
  }

  /// Axes of the tool upright at a point, from axes beside them; their condition number. Nothing where it
  /// cannot be.
  std::optional<double> stand(const Vec3& p_B, double table, AxisVector& axes) const {
    const Pose X_BT = make_pose(Quat::Identity(), p_B);
    const AxisVector previous = axes;
    if (mechanism_->inverse(X_BT, std::span(previous).first(n_), std::span(axes).first(n_)) !=
        kinematics::SolveStatus::ok)
      return std::nullopt;
    if (margin(axes) < kLeastMargin || !above_table(axes, table)) return std::nullopt;
    return mechanism_->condition_number(X_BT, std::span(axes).first(n_));
  }

  void try_place(const Vec3& centre_B, TablePlace& best) const {
    Random random(2, "starts of a new machine");
    for (int start = 0; start < kStarts; ++start) {
      AxisVector home = random_posture(d_, random);
      auto worst = stand(centre_B + Vec3(0, 0, kAbove), centre_B.z(), home);
      if (!worst) continue;
      for (const double x : {0.0, -half_, half_})
        for (const double y : {0.0, -half_, half_}) {
          AxisVector axes = home;
          const auto here = worst ? stand(centre_B + Vec3(x, y, 0), centre_B.z(), axes) : std::nullopt;
          worst = here ? std::optional(std::max(*here, *worst)) : std::nullopt;
        }
      if (worst && (!best.found || *worst < best.condition)) best = {true, centre_B, home, *worst};
    }
  }

  ChainDescription d_;
  std::size_t n_;
  double half_;
  std::unique_ptr<Mechanism> mechanism_;
  Vec3 axis_B_{0, 0, 0};
};

}  // namespace

TablePlace find_table_place(const ChainDescription& description, double half) {
  PlaceSearch search(description, half);
  return description.chain.work_axis >= 0 ? search.at_origin() : search.search();
}

}  // namespace understudy::machine
