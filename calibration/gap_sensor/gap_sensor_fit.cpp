#include "calibration/gap_sensor/gap_sensor_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/NonLinearOptimization>

#include "calibration/gap_sensor/waist_fit.h"
#include "core/units.h"
#include "machine/optics_mounting.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using machine::kMountingFreedoms;

constexpr double kUnseen = 1e6;  // residual where the optics see no dot: steps that way are refused
constexpr double kGapLow = -1e-3, kGapHigh = 8e-3;  // [m], in which a flat is looked for

/// Unknowns: errors of the mounting in their tolerances, then the zero of each flat [mm].
machine::MountingVector error_of(const GapSensorProblem& problem, const VectorXd& x) {
  return problem.tolerance.cwiseProduct(x.head<kMountingFreedoms>());
}
double zero_of(const VectorXd& x, int flat) { return kMillimetre * x[kMountingFreedoms + flat]; }

Flat flat_of(const GapSensorProblem& problem, const SeenDot& dot, double zero) {
  return {problem.slopes[static_cast<std::size_t>(dot.flat)], dot.height + zero};
}

Eigen::Matrix2d square_root(const Eigen::Matrix2d& covariance) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).operatorSqrt();
}

/// [px/m], how the dot runs with the gap.
Vec2 rate_of(const GapSensorProblem& problem, Flat flat) {
  constexpr double kStep = 1e-6;  // [m]
  flat.gap += kStep;
  const auto ahead = dot_pixel(problem.drawn, problem.camera, flat);
  flat.gap -= 2 * kStep;
  const auto behind = dot_pixel(problem.drawn, problem.camera, flat);
  return ahead && behind ? Vec2((*ahead - *behind) / (2 * kStep)) : Vec2::Zero();
}

std::vector<double> zeros_of(const GapSensorProblem& problem, const VectorXd& x) {
  std::vector<double> zeros;
  for (std::size_t flat = 0; flat < problem.slopes.size(); ++flat)
    zeros.push_back(zero_of(x, static_cast<int>(flat)));
  return zeros;
}

/// Of all dots' coordinates: speckle, and heights.
MatrixXd noise_covariance(const GapSensorProblem& problem, const VectorXd& start) {
  const auto n = static_cast<Index>(problem.dots.size());
  const MatrixXd alike = speckle_correlation(problem, zeros_of(problem, start));
  MatrixXd covariance = MatrixXd::Zero(2 * n, 2 * n);
  std::vector<Eigen::Matrix2d> root(problem.dots.size());
  for (std::size_t i = 0; i < root.size(); ++i) {
    const SeenDot& dot = problem.dots[i];
    root[i] = square_root(dot.covariance_px2);
    const Vec2 rate = dot.height_sigma * rate_of(problem, flat_of(problem, dot, zero_of(start, dot.flat)));
    const auto row = static_cast<Index>(i);
    covariance.block<2, 2>(2 * row, 2 * row) = dot.covariance_px2 + rate * rate.transpose();
    for (std::size_t j = 0; j < i; ++j) {
      const auto column = static_cast<Index>(j);
      const double share = alike(row, column);
      covariance.block<2, 2>(2 * row, 2 * column) = share * root[i] * root[j];
      covariance.block<2, 2>(2 * column, 2 * row) = share * root[j] * root[i];
    }
  }
  return covariance;
}

/// What Eigen's Levenberg-Marquardt asks for: residuals in standard deviations.
struct Residuals {
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const GapSensorProblem& problem;
  MatrixXd whitener;  ///< lower root of the noise

  Index dots() const { return 2 * static_cast<Index>(problem.dots.size()); }
  int inputs() const { return kMountingFreedoms + static_cast<int>(problem.slopes.size()); }
  int values() const {
    return static_cast<int>(dots()) + static_cast<int>(problem.known.size()) + kMountingFreedoms;
  }

  /// Measured less fitted [px]; false where a dot is not seen.
  bool miss(const VectorXd& x, VectorXd& px) const {
    const machine::OpticsMounting mounting = moved(problem.drawn, error_of(problem, x));
    px.resize(dots());
    for (std::size_t i = 0; i < problem.dots.size(); ++i) {
      const SeenDot& dot = problem.dots[i];
      const auto pixel =
          calibration::dot_pixel(mounting, problem.camera, flat_of(problem, dot, zero_of(x, dot.flat)));
      if (!pixel) return false;
      px.segment<2>(2 * static_cast<Index>(i)) = dot.position_px - *pixel;
    }
    return true;
  }

  int operator()(const VectorXd& x, VectorXd& out) const {
    out.resize(values());
    VectorXd px;
    if (miss(x, px))
      out.head(dots()) = whitener.triangularView<Eigen::Lower>().solve(px);
    else
      out.head(dots()).setConstant(kUnseen);
    Index at = dots();
    for (const KnownGap& known : problem.known)
      out[at++] = (known.height + zero_of(x, known.flat) - known.gap) / known.sigma;
    out.tail<kMountingFreedoms>() = x.head<kMountingFreedoms>();
    return 0;
  }

  /// Central differences over a step far below every curvature: 1e-4 of a tolerance, or 0.1 um of a zero.
  int df(const VectorXd& x, MatrixXd& J) const {
    constexpr double kStep = 1e-4;
    J.resize(values(), inputs());
    VectorXd ahead, behind;
    for (Index k = 0; k < inputs(); ++k) {
      VectorXd by = x;
      by[k] += kStep;
      (*this)(by, ahead);
      by[k] -= 2 * kStep;
      (*this)(by, behind);
      J.col(k) = (ahead - behind) / (2 * kStep);
    }
    return 0;
  }
};

/// The gap at which the drawn optics have the dot nearest, less its height.
double zero_by_drawing(const GapSensorProblem& problem, const SeenDot& dot) {
  constexpr int kPoints = 181;  // every 50 um
  double best = std::numeric_limits<double>::infinity(), zero = 0;
  for (int k = 0; k < kPoints; ++k) {
    const double gap = kGapLow + (kGapHigh - kGapLow) * k / (kPoints - 1);
    const auto pixel =
        dot_pixel(problem.drawn, problem.camera, {problem.slopes[static_cast<std::size_t>(dot.flat)], gap});
    const double distance = pixel ? (*pixel - dot.position_px).norm() : best;
    if (distance >= best) continue;
    best = distance;
    zero = gap - dot.height;
  }
  return zero;
}

VectorXd start_of(const GapSensorProblem& problem) {
  VectorXd x = VectorXd::Zero(kMountingFreedoms + static_cast<Index>(problem.slopes.size()));
  for (auto dot = problem.dots.rbegin(); dot != problem.dots.rend(); ++dot)
    x[kMountingFreedoms + dot->flat] = to_mm(zero_by_drawing(problem, *dot));
  for (const KnownGap& known : problem.known)
    x[kMountingFreedoms + known.flat] = to_mm(known.gap - known.height);
  return x;
}

void fill_residuals(const GapSensorProblem& problem, const MatrixXd& noise, const VectorXd& px,
                    GapSensorFit& fit) {
  for (Index i = 0; i < px.size() / 2; ++i) {
    const Vec2 residual = px.segment<2>(2 * i);
    const Eigen::Matrix2d covariance = noise.block<2, 2>(2 * i, 2 * i);
    fit.residual_px.push_back(residual);
    fit.residual_sigmas.push_back(std::sqrt(residual.dot(covariance.llt().solve(residual))));
  }
  fit.degrees_of_freedom = static_cast<int>(px.size() + static_cast<Index>(problem.known.size())) -
                           static_cast<int>(problem.slopes.size());
}

}  // namespace

GapSensorFit fit_gap_sensor(const GapSensorProblem& problem) {
  GapSensorFit fit;
  VectorXd x = start_of(problem);
  const MatrixXd noise = noise_covariance(problem, x);
  const Eigen::LLT<MatrixXd> root(noise);
  if (root.info() != Eigen::Success) return fit;
  Residuals residuals{problem, root.matrixL()};
  Eigen::LevenbergMarquardt<Residuals> search(residuals);
  search.parameters.xtol = 1e-9;
  search.parameters.ftol = 1e-12;
  const auto status = search.minimize(x);
  VectorXd px, values;
  residuals(x, values);
  if (status <= 0 || !residuals.miss(x, px)) return fit;
  MatrixXd J;
  residuals.df(x, J);
  const MatrixXd covariance =
      (J.transpose() * J).ldlt().solve(MatrixXd::Identity(residuals.inputs(), residuals.inputs()));
  fit.converged = true;
  fit.iterations = static_cast<int>(search.iter);
  fit.error = error_of(problem, x);
  fit.mounting = moved(problem.drawn, fit.error);
  fit.covariance = problem.tolerance.asDiagonal() *
                   covariance.topLeftCorner<kMountingFreedoms, kMountingFreedoms>() *
                   problem.tolerance.asDiagonal();
  fit.zero = zeros_of(problem, x);
  for (std::size_t flat = 0; flat < problem.slopes.size(); ++flat) {
    const auto at = kMountingFreedoms + static_cast<Index>(flat);
    fit.zero_sigma.push_back(kMillimetre * std::sqrt(covariance(at, at)));
  }
  fit.chi_square = values.squaredNorm();
  fill_residuals(problem, noise, px, fit);
  if (const auto waist = fit_waist(problem, fit.mounting, fit.zero)) {
    fit.waist = waist->diameter;
    fit.waist_sigma = waist->sigma;
  }
  return fit;
}

}  // namespace understudy::calibration
