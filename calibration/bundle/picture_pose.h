// Private to this folder: the pose that two pictures show through adjusted cameras, without the machine.
#pragma once

#include "calibration/bundle/bundle_problem.h"

namespace understudy::calibration {

/// X_BT and its covariance by the targets of a pose alone, with its displacements and sides as
/// strut_lengths() takes them. False where the pictures have no pose.
bool picture_pose(const BundleProblem& problem, const BundleState& state, std::size_t pose,
                  PoseSample& sample);

}  // namespace understudy::calibration
