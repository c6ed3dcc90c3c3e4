#include "calibration/bound.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "calibration/calibrated.h"
#include "calibration/residual_covariance.h"

namespace understudy::calibration {

ParameterMatrix information(const HexapodParameters& machine, std::span<const PoseSample> samples,
                            const Unknowns& unknowns) {
  NormalEquations sum(unknowns);
  StrutLinearisation at;
  for (const PoseSample& sample : samples) {
    if (!linearise(machine, sample, sample.X_BT, at)) continue;
    const Mat6 M = residual_covariance(at, sample).llt().solve(Mat6::Identity());
    sum.add(at, M, Vec6::Zero());
  }
  return sum.information();
}

ParameterMatrix parameter_bound(const HexapodParameters& machine, std::span<const PoseSample> samples,
                                const Unknowns& unknowns) {
  const ParameterMatrix H = information(machine, samples, unknowns);
  const Eigen::LLT<ParameterMatrix> factors(H);
  constexpr double kDefinite = 1e-14;  // reciprocal condition: below, inverting leaves no digit
  if (factors.info() != Eigen::Success || factors.rcond() < kDefinite) return {};
  return factors.solve(ParameterMatrix::Identity(H.rows(), H.cols()));
}

TipUncertainty tip_uncertainty(const HexapodParameters& machine, const ParameterMatrix& covariance,
                               const Unknowns& unknowns, std::span<const Pose> poses) {
  TipUncertainty result;
  StrutLinearisation at;
  double sum = 0;
  for (const Pose& X_BT : poses) {
    if (!linearise(machine, {}, X_BT, at)) continue;
    const ParameterRows<3> rows = pose_rows(at, unknowns).topRows<3>();
    result.covariances.push_back(rows * covariance * rows.transpose());
    sum += result.covariances.back().trace();
  }
  if (!result.covariances.empty())
    result.rms = std::sqrt(sum / static_cast<double>(result.covariances.size()));
  return result;
}

bool driven_error(const HexapodParameters& truth, const HexapodParameters& model, const Pose& X_BT,
                  Twist& error) {
  StrutLengths lengths;
  if (kinematics::inverse(model.geometry, X_BT, lengths) != kinematics::SolveStatus::ok) return false;
  PoseSample asked;
  asked.displacement = displacements(model.geometry, lengths);
  const auto reached = kinematics::forward(truth.geometry, strut_lengths(truth, asked), X_BT);
  if (reached.status != kinematics::SolveStatus::ok) return false;
  error = pose_error(reached.X_BT, X_BT);
  return true;
}

}  // namespace understudy::calibration
