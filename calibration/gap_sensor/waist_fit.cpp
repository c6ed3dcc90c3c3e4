#include "calibration/gap_sensor/waist_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;

constexpr double kSameSpeckle = 0.99;  // correlation of two dots on one place: a hundredth is the camera's
constexpr double kPixel = 1.0 / 12;    // [px^2], second moment of a pixel's own square
constexpr int kRounds = 4;             // weights change with the width: by its error squared in each round

Flat flat_of(const GapSensorProblem& problem, const SeenDot& dot, const std::vector<double>& zero) {
  const auto flat = static_cast<std::size_t>(dot.flat);
  return {problem.slopes[flat], dot.height + zero[flat]};
}

/// The share q of the drawn beam's second moments, q times `beam` beside `blur`, that a dot shows.
struct Share {
  Index dot = 0;
  double q = 0, sigma = 0;
};

/// Least squares of the moments weighed by those expected, and the most that their noise can move it.
Share share_of(const SeenDot& dot, const Matrix2d& beam, double blur, double expected) {
  const Matrix2d weight = (expected * beam + blur * Matrix2d::Identity()).inverse();
  const Matrix2d gain = weight * beam * weight;
  const double hold = (gain * beam).trace();
  Share share;
  share.q = (gain * (dot.spread_px2 - blur * Matrix2d::Identity())).trace() / hold;
  share.sigma = dot.spread_sigma * (weight * beam).trace() / hold;
  return share;
}

struct Mean {
  double q = 1, sigma = 0;
};

/// Generalised least squares of one number.
Mean mean_of(const std::vector<Share>& shares, const Eigen::MatrixXd& alike) {
  const auto n = static_cast<Index>(shares.size());
  Eigen::MatrixXd covariance(n, n);
  Eigen::VectorXd q(n);
  for (Index i = 0; i < n; ++i) {
    const Share& share = shares[static_cast<std::size_t>(i)];
    q[i] = share.q;
    for (Index j = 0; j < n; ++j) {
      const Share& other = shares[static_cast<std::size_t>(j)];
      covariance(i, j) = (i == j ? 1 : alike(share.dot, other.dot)) * share.sigma * other.sigma;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::VectorXd weight = root.solve(Eigen::VectorXd::Ones(n));
  Mean mean;
  mean.q = weight.dot(q) / weight.sum();
  const Eigen::VectorXd off = q.array() - mean.q;
  const double scatter = n > 1 ? off.dot(root.solve(off)) / static_cast<double>(n - 1) : 1;
  mean.sigma = std::sqrt(std::max(1.0, scatter) / weight.sum());
  return mean;
}

}  // namespace

Eigen::MatrixXd speckle_correlation(const GapSensorProblem& problem, const std::vector<double>& zero) {
  const auto n = static_cast<Index>(problem.dots.size());
  Eigen::MatrixXd alike = Eigen::MatrixXd::Identity(n, n);
  std::vector<Vec3> place;  // of the dot on its flat, which stands still
  for (const SeenDot& dot : problem.dots) {
    const Flat flat = flat_of(problem, dot, zero);
    place.push_back(dot_on_flat(problem.drawn, flat).value_or(Vec3::Zero()) + flat.gap * Vec3::UnitZ());
  }
  for (std::size_t i = 0; i < place.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (problem.dots[j].flat != problem.dots[i].flat) continue;
      const double travelled = (place[i] - place[j]).norm();
      const auto row = static_cast<Index>(i), column = static_cast<Index>(j);
      alike(row, column) = kSameSpeckle * std::max(0.0, 1 - travelled / problem.speckle_length);
      alike(column, row) = alike(row, column);
    }
  return alike;
}

std::optional<Waist> fit_waist(const GapSensorProblem& problem, const machine::OpticsMounting& mounting,
                               const std::vector<double>& zero) {
  if (!(problem.waist > 0)) return std::nullopt;
  const Eigen::MatrixXd alike = speckle_correlation(problem, zero);
  const double blur = problem.blur_px * problem.blur_px + kPixel;
  Mean mean;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Share> shares;
    for (std::size_t i = 0; i < problem.dots.size(); ++i) {
      const SeenDot& dot = problem.dots[i];
      if (!(dot.spread_sigma > 0) || !std::isfinite(dot.spread_sigma)) continue;
      const auto beam = dot_spread(mounting, problem.waist, problem.camera, flat_of(problem, dot, zero));
      if (!beam) continue;
      shares.push_back(share_of(dot, *beam, blur, mean.q));
      shares.back().dot = static_cast<Index>(i);
    }
    if (shares.empty()) return std::nullopt;
    mean = mean_of(shares, alike);
    if (!(mean.q > 0)) return std::nullopt;
  }
  const double diameter = problem.waist * std::sqrt(mean.q);
  return Waist{diameter, 0.5 * diameter * mean.sigma / mean.q};
}

}  // namespace understudy::calibration
