// Private to this folder: a pose's commands as the drives carry them out.
#pragma once

#include "calibration/bundle/bundle_problem.h"

namespace understudy::calibration {

/// u, u^2 and u^3 of BundleState::warming at a pose; 0 at the last one.
Vec3 time_left(const BundleProblem& problem, std::size_t pose);

/// Displacements with leads and warming, as linearise() takes them.
PoseSample strut_sample(const BundleProblem& problem, const BundleState& state, std::size_t pose);

}  // namespace understudy::calibration
