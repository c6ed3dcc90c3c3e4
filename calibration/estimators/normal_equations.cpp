#include "calibration/estimators/normal_equations.h"

#include <Eigen/Cholesky>

namespace understudy::calibration {

NormalEquations::NormalEquations(const Unknowns& unknowns) : unknowns_(unknowns) { clear(); }

void NormalEquations::clear() {
  geometry_.setZero();
  border_.setZero(unknowns_.count() - kGeometryParameters, unknowns_.count());
  gradient_.setZero(unknowns_.count());
}

void NormalEquations::add(const StrutLinearisation& at, const Mat6& M, const Vec6& v) {
  using Column = Eigen::Matrix<double, kStrutParameters, 1>;
  for (Eigen::Index i = 0; i < kStruts; ++i) {
    const Column own = at.by_geometry.col(i);
    gradient_.segment<kStrutParameters>(kStrutParameters * i) += v[i] * own;
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Column weighed = M(i, j) * at.by_geometry.col(j);
      geometry_.block<kStrutParameters, kStrutParameters>(kStrutParameters * i, kStrutParameters * j)
          .noalias() += own * weighed.transpose();
    }
  }
  if (border_.rows() == 0) return;
  const ParameterRows<6> rows = dense_rows(at, unknowns_);
  const auto extra = rows.rightCols(border_.rows());
  border_.noalias() += (extra.transpose() * M) * rows;
  gradient_.tail(border_.rows()).noalias() += extra.transpose() * v;
}

ParameterMatrix NormalEquations::information() const {
  const Eigen::Index n = unknowns_.count(), extra = border_.rows();
  ParameterMatrix H(n, n);
  H.topLeftCorner<kGeometryParameters, kGeometryParameters>() = geometry_.selfadjointView<Eigen::Lower>();
  H.bottomRows(extra) = border_;
  H.rightCols(extra) = border_.transpose();
  return H;
}

bool NormalEquations::solve(double damping, ParameterVector& step) const {
  ParameterMatrix H = information();
  H.diagonal() *= 1 + damping;
  const Eigen::LLT<ParameterMatrix> factors(H);
  if (factors.info() != Eigen::Success) return false;
  step = factors.solve(-gradient_);
  return step.allFinite();
}

double NormalEquations::curvature(const ParameterVector& step) const {
  const auto n = kGeometryParameters;
  const Eigen::Index extra = border_.rows();
  const double geometry = step.head<n>().dot(geometry_.selfadjointView<Eigen::Lower>() * step.head<n>());
  const ParameterVector by_extra = border_ * step;
  // The border's rows hold the mixed terms once; H holds them twice.
  const double mixed = step.tail(extra).dot(border_.leftCols<n>() * step.head<n>());
  return geometry + mixed + step.tail(extra).dot(by_extra);
}

bool NormalEquations::invert(ParameterMatrix& inverse) const {
  const Eigen::LLT<ParameterMatrix> factors(information());
  if (factors.info() != Eigen::Success) return false;
  inverse = factors.solve(ParameterMatrix::Identity(unknowns_.count(), unknowns_.count()));
  return inverse.allFinite();
}

}  // namespace understudy::calibration
