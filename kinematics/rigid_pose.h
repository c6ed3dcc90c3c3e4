// Whether a matrix that came from outside is a pose.
#pragma once

#include "core/frames.h"

namespace understudy::kinematics {

constexpr double kRigidTolerance = 1e-6;  // of R^T R - 1: far above rounding, far below a wrong matrix

/// Finite, right-handed and orthonormal.
inline bool is_rigid(const Pose& X) {
  return X.matrix().allFinite() &&
         (X.linear().transpose() * X.linear() - Mat3::Identity()).cwiseAbs().maxCoeff() < kRigidTolerance &&
         X.linear().determinant() > 0;
}

}  // namespace understudy::kinematics
