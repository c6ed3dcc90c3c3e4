#include "kinematics/chain/finishing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "kinematics/chain/chain_kind.h"
#include "kinematics/chain/chain_mechanism.h"
#include "kinematics/chain/minimum_norm.h"
#include "kinematics/rigid_pose.h"

namespace understudy::kinematics {
namespace {

constexpr double kTolerance = 1e-12;  // [m] and [rad], left of the pose error
constexpr double kTurnMax = 0.2;      // [rad] per step: how finely the way of the smallest norm is followed
constexpr int kStepsMax = 64;         // a half turn takes 16 steps; more than this is creeping
constexpr double kVertical = 1e-12;   // cosine of the pitch below which yaw is free

using Axes = std::array<double, kFinishingAxes>;
enum Axis : std::size_t { kZ, kC, kX, kY, kYaw, kPitch };

/// Along the twist that is left, or about any axis across the tool where it points the opposite way.
Twist turn_to(const Pose& X, const Pose& X_wanted) {
  Twist error = task_error(X, X_wanted);
  const double sine = error.tail<3>().norm(), angle = tool_axis_angle(X, X_wanted);
  if (sine > 1e-9)
    error.tail<3>() *= angle / sine;
  else if (angle > 1)
    error.tail<3>() = angle * X.linear().col(0);
  return error;
}

class Finishing final : public ChainMechanism {
 public:
  explicit Finishing(const ChainDescription& description)
      : ChainMechanism(description, false), geometry_{description.parameters[0], description.parameters[1]} {}

  // Steps of the smallest norm from `previous`, which end as Newton's. Where they stall (a vertical tool
  // leaves yaw no way to turn its axis) the bed keeps its turn and the rest follows in closed form. Without a
  // previous position nothing binds the bed: it may turn elsewhere if that keeps all axes within range.
  SolveStatus inverse(const Pose& X_ST, std::span<const double> previous,
                      std::span<double> axes) const override {
    if (axes.size() < kFinishingAxes || !is_rigid(X_ST)) return SolveStatus::bad_input;
    Axes from;
    std::copy_n(near(previous).begin(), kFinishingAxes, from.begin());
    if (!std::all_of(from.begin(), from.end(), [](double v) { return std::isfinite(v); }))
      return SolveStatus::bad_input;
    Axes found = from;
    if (!follow(X_ST, found)) {
      const SolveStatus status = finishing_at_bed_turn(geometry_, X_ST, from[kC], from[kYaw], found);
      if (status != SolveStatus::ok) return status;
    }
    if (previous.size() < kFinishingAxes && !within_ranges(found)) search_bed_turn(X_ST, from, found);
    std::copy(found.begin(), found.end(), axes.begin());
    return SolveStatus::ok;
  }

  // Of the same norm as the steps of inverse().
  SolveStatus axis_rates(const Pose& X_ST, std::span<const double> axes,
                         Eigen::Ref<Eigen::Matrix<double, Eigen::Dynamic, 6>> rates) const override {
    if (axes.size() < kFinishingAxes || rates.rows() < kFinishingAxes || !is_rigid(X_ST))
      return SolveStatus::bad_input;
    SolveStatus status = SolveStatus::ok;
    for (Eigen::Index k = 0; k < 6; ++k) {
      Axes column;
      const SolveStatus one =
          minimum_norm_rates(chain(), axes, Twist::Unit(k), description().length_scale, {}, column);
      if (one == SolveStatus::bad_input) return one;
      if (one != SolveStatus::ok) status = one;
      for (std::size_t i = 0; i < kFinishingAxes; ++i) rates(static_cast<Eigen::Index>(i), k) = column[i];
    }
    return status;
  }

 private:
  bool follow(const Pose& X_ST, Axes& q) const {
    for (int step = 0; step <= kStepsMax; ++step) {
      const Twist error = turn_to(kinematics::forward(chain(), q), X_ST);
      if (error.head<3>().norm() <= kTolerance && error.tail<3>().norm() <= kTolerance) return true;
      Axes change;
      if (minimum_norm_rates(chain(), q, error, description().length_scale, {}, change) != SolveStatus::ok)
        return false;
      const double turn = std::max({std::abs(change[kC]), std::abs(change[kYaw]), std::abs(change[kPitch])});
      const double share = turn > kTurnMax ? kTurnMax / turn : 1.0;
      for (std::size_t i = 0; i < kFinishingAxes; ++i) q[i] += share * change[i];
    }
    return false;
  }

  bool within_ranges(const Axes& q) const {
    for (std::size_t i = 0; i < kFinishingAxes; ++i)
      if (q[i] < chain().axes[i].lower || q[i] > chain().axes[i].upper) return false;
    return true;
  }

  /// The bed's turn nearest to `from` that keeps every axis within its range; `found` stays where none does.
  void search_bed_turn(const Pose& X_ST, const Axes& from, Axes& found) const {
    for (int n = 0; n < 360; ++n) {
      const int degrees = n % 2 == 0 ? n / 2 : -(n + 1) / 2;
      const double c = from[kC] + degrees * kDegree;
      Axes q;
      if (finishing_at_bed_turn(geometry_, X_ST, c, from[kYaw], q) == SolveStatus::ok && within_ranges(q)) {
        found = q;
        return;
      }
    }
  }

  FinishingGeometry geometry_;
};

}  // namespace

Chain finishing_chain(const FinishingGeometry& geometry) {
  Chain chain;
  const Vec3 wrist(-geometry.l3, 0, 0);
  chain.axes.push_back(sliding_axis("z", -Vec3::UnitZ(), -1));
  chain.axes.push_back(turning_axis("c", -Vec3::UnitZ(), Vec3::Zero(), 0));
  chain.axes.push_back(sliding_axis("x", Vec3::UnitX(), -1));
  chain.axes.push_back(sliding_axis("y", Vec3::UnitY(), 2));
  chain.axes.push_back(turning_axis("yaw", Vec3::UnitZ(), wrist, 3));
  chain.axes.push_back(turning_axis("pitch", Vec3::UnitY(), wrist, 4));
  chain.work_axis = 1;
  chain.tool_axis = 5;
  Mat3 R_bT;
  R_bT << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  chain.X_OT_zero = make_pose(R_bT, Vec3(wrist + geometry.le * Vec3::UnitX()));
  return chain;
}

SolveStatus finishing_at_bed_turn(const FinishingGeometry& geometry, const Pose& X_ST, double c,
                                  double yaw_near, std::span<double> axes) {
  if (axes.size() < kFinishingAxes || !is_rigid(X_ST) || !std::isfinite(c) || !std::isfinite(yaw_near))
    return SolveStatus::bad_input;
  const Vec3 mill =
      -tool_axis(X_ST).normalized();  // x_b in S: (cos A cos P, sin A cos P, -sin P), A = c + yaw
  const double level = std::hypot(mill.x(), mill.y());
  const Vec3 wrist = X_ST.translation() - geometry.le * mill;
  axes[kZ] = wrist.z();
  axes[kC] = c;
  axes[kX] = std::cos(c) * wrist.x() + std::sin(c) * wrist.y() + geometry.l3;
  axes[kY] = -std::sin(c) * wrist.x() + std::cos(c) * wrist.y();
  axes[kYaw] = level < kVertical ? yaw_near : nearest_turn(std::atan2(mill.y(), mill.x()) - c, yaw_near);
  axes[kPitch] = std::atan2(-mill.z(), level);
  return SolveStatus::ok;
}

ChainKind finishing_kind() {
  ChainKind kind;
  kind.name = "finishing";
  kind.parameters = {{"l3_mm", 1, 10'000, "the bed's turning axis to the wrist at home"},
                     {"le_mm", 1, 2'000, "wrist to the end mill's tip"}};
  kind.chain = [](std::span<const double> p) { return finishing_chain({p[0], p[1]}); };
  kind.make = [](const ChainDescription& description) -> std::unique_ptr<Mechanism> {
    return std::make_unique<Finishing>(description);
  };
  return kind;
}

}  // namespace understudy::kinematics
