#include "calibration/bundle/session_time.h"

#include <algorithm>

namespace understudy::calibration {

Vec3 time_left(const BundleProblem& problem, std::size_t pose) {
  const auto [first, last] =
      std::minmax_element(problem.poses.begin(), problem.poses.end(),
                          [](const BundlePose& a, const BundlePose& b) { return a.time < b.time; });
  const double session = last->time - first->time;
  const double u = session > 0 ? (last->time - problem.poses[pose].time) / session : 0;
  return {u, u * u, u * u * u};
}

PoseSample strut_sample(const BundleProblem& problem, const BundleState& state, std::size_t pose) {
  const BundlePose& own = problem.poses[pose];
  PoseSample sample;
  sample.approach = own.approach;
  const double shorter = problem.warms() ? state.warming.dot(time_left(problem, pose)) : 0;
  for (std::size_t i = 0; i < kStruts; ++i)
    sample.displacement[i] = (1 + state.lead[i]) * own.displacement[i] - shorter;
  return sample;
}

}  // namespace understudy::calibration
