// The peer: the same maximum-likelihood problem handed to Ceres Solver with automatic differentiation.
#pragma once

#include "calibration/problem.h"

namespace understudy::bench {

struct CeresAnswer {
  bool converged = false;
  kinematics::HexapodGeometry geometry;
  int iterations = 0;
  double cost = 0;  ///< sum of e^T S^-1 e
};

/// Poses of forward kinematics are found in plain numbers; one Newton step in Jets then gives the exact
/// derivatives (implicit differentiation), which is far cheaper than Newton's method in Jets all the way.
CeresAnswer solve_with_ceres(const calibration::Problem& problem, bool normal_equations);

}  // namespace understudy::bench
