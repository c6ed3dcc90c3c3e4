// H = sum of G^T M G and g = sum of G^T v over poses, with G = d f / d unknowns. A strut's equation knows its
// own 7 parameters only, so a pose adds 36 blocks of 7 x 7 instead of a dense product.
#pragma once

#include "calibration/strut_model.h"

namespace understudy::calibration {

class NormalEquations {
 public:
  explicit NormalEquations(const Unknowns& unknowns);

  void clear();
  /// M: weight of the pose's six equations, symmetric; v: M times their residuals.
  void add(const StrutLinearisation& at, const Mat6& M, const Vec6& v);

  /// (H + damping diag H) step = -g; false where that has no solution.
  bool solve(double damping, ParameterVector& step) const;
  /// step^T H step: twice what an undamped step takes off the linearised cost sum / 2.
  double curvature(const ParameterVector& step) const;
  /// H^-1; false where H is not positive definite.
  bool invert(ParameterMatrix& inverse) const;
  ParameterMatrix information() const;

 private:
  Unknowns unknowns_;
  Eigen::Matrix<double, kGeometryParameters, kGeometryParameters> geometry_;  // lower blocks
  ParameterMatrix border_;                                                    // rows of dev and play
  ParameterVector gradient_;
};

}  // namespace understudy::calibration
