#include "tests/kinematics/chain/finishing_follower.h"

#include <algorithm>
#include <cmath>

namespace understudy::kinematics {
namespace {

bool finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

// The error left at a point comes back multiplied by -kp period, and the integral of it by ki period^2.
bool settles(const FollowerOptions& o) {
  return o.proportional >= 0 && o.integral >= 0 && o.period > 0 && o.corrections >= 0 && o.metric > 0 &&
         o.period * (o.proportional + o.integral * o.period) < 1 && finite(o.null_space_motion);
}

}  // namespace

FinishingFollower::FinishingFollower(const Chain& chain, std::span<const double> start,
                                     const FollowerOptions& options)
    : chain_(chain), options_(options) {
  if (start.size() < chain.axes.size() || !finite(start.first(chain.axes.size())) || !settles(options))
    return;
  std::copy_n(start.begin(), chain.axes.size(), axes_.begin());
  usable_ = true;
}

SolveStatus FinishingFollower::step(const Pose& X_ST_target) {
  if (!usable_ || !X_ST_target.matrix().allFinite()) return SolveStatus::bad_input;
  const std::size_t n = chain_.axes.size();
  AxisVector q = axes_, change{};
  const std::span<double> moved(q.data(), n);
  const Twist answer = options_.period * (options_.proportional * error_ + options_.integral * sum_);
  for (int k = 0; k <= options_.corrections; ++k) {
    Twist way = task_error(forward(chain_, moved), X_ST_target);
    if (k == 0) way += answer;
    const std::span<const double> null_space =
        k == 0 ? std::span<const double>(options_.null_space_motion) : std::span<const double>();
    const SolveStatus status = minimum_norm_rates(chain_, moved, way, options_.metric, null_space, change);
    if (status != SolveStatus::ok) return status;
    for (std::size_t i = 0; i < n; ++i) q[i] += change[i];
  }
  axes_ = q;
  error_ = task_error(forward(chain_, moved), X_ST_target);
  sum_ += options_.period * error_;
  return SolveStatus::ok;
}

}  // namespace understudy::kinematics
