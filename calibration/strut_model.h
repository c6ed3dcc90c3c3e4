// The strut equation and its derivatives: f_i = sqrt(|b_i - p - R a_i|^2 - dev^2) - (strut length by the
// drive). It is 0 on a machine without noise (Song 2015, eqs 3, 4 and 6).
#pragma once

#include "calibration/problem.h"

namespace understudy::calibration {

using Vec6 = Eigen::Matrix<double, 6, 1>;

struct StrutLinearisation {
  Vec6 residual;                                           ///< f [m]
  Eigen::Matrix<double, kStrutParameters, 6> by_geometry;  ///< column i: d f_i / d (b_i, a_i, l_i0)
  Vec6 by_deviation;
  Vec6 by_play;  ///< d f_i / d play_i
  Mat6 by_pose;  ///< d f / d (translation of the tip, rotation vector), both in B
};

/// At pose X_BT, for the displacements and approaches of `sample`. False where a strut is shorter than dev.
bool linearise(const HexapodParameters& machine, const PoseSample& sample, const Pose& X_BT,
               StrutLinearisation& at);

/// d f / d unknowns, without the zeros' structure.
ParameterRows<6> dense_rows(const StrutLinearisation& at, const Unknowns& unknowns);

/// d (pose that the drives make) / d unknowns at this pose: -by_pose^-1 (d f / d unknowns).
ParameterRows<6> pose_rows(const StrutLinearisation& at, const Unknowns& unknowns);

}  // namespace understudy::calibration
