#include "calibration/bundle/bundle_problem.h"

#include "calibration/bundle/session_time.h"

namespace understudy::calibration {

BundleState start_of(const BundleProblem& problem) {
  BundleState state;
  state.cameras = problem.rig.cameras;
  state.boards.resize(problem.boards.size());
  state.machine = problem.nominal;
  for (const BundlePose& pose : problem.poses) state.poses.push_back(pose.X_BT);
  return state;
}

StrutLengths strut_lengths(const BundleProblem& problem, const BundleState& state, std::size_t pose) {
  return strut_lengths(state.machine, strut_sample(problem, state, pose));
}

}  // namespace understudy::calibration
