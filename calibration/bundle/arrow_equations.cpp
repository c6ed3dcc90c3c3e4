#include "calibration/bundle/arrow_equations.h"

#include <Eigen/Cholesky>

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Unknowns differ by 1e8 in size.
VectorXd scale_of(const MatrixXd& H) { return H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse(); }

constexpr double kDefinite = 1e-14;  // reciprocal condition: below, inverting leaves no digit

}  // namespace

ArrowEquations::ArrowEquations(Index shared, std::span<const Index> local_sizes)
    : S_(MatrixXd::Zero(shared, shared)), g_(VectorXd::Zero(shared)) {
  for (const Index n : local_sizes)
    blocks_.push_back({MatrixXd::Zero(n, n), MatrixXd::Zero(shared, n), VectorXd::Zero(n)});
}

long ArrowEquations::unknowns() const {
  Index count = S_.rows();
  for (const Block& block : blocks_) count += block.H.rows();
  return count;
}

void ArrowEquations::add(const VectorXd& residual, std::span<const Index> columns, const MatrixXd& by_shared,
                         std::size_t block, const MatrixXd& by_local) {
  Block& own = blocks_[block];
  own.H.noalias() += by_local.transpose() * by_local;
  own.g.noalias() += by_local.transpose() * residual;
  const MatrixXd mixed = by_shared.transpose() * by_local, square = by_shared.transpose() * by_shared;
  const VectorXd right = by_shared.transpose() * residual;
  for (std::size_t a = 0; a < columns.size(); ++a) {
    const auto i = static_cast<Index>(a);
    own.C.row(columns[a]) += mixed.row(i);
    g_[columns[a]] += right[i];
    for (std::size_t b = 0; b < columns.size(); ++b)
      S_(columns[a], columns[b]) += square(i, static_cast<Index>(b));
  }
  cost_ += residual.squaredNorm();
  equations_ += residual.size();
}

void ArrowEquations::add_prior(Index shared, double residual, double weight) {
  S_(shared, shared) += weight * weight;
  g_[shared] += weight * weight * residual;
  cost_ += weight * weight * residual * residual;
  ++equations_;
}

void ArrowEquations::add_local_prior(std::size_t block, Index row, double residual, double weight) {
  blocks_[block].H(row, row) += weight * weight;
  blocks_[block].g[row] += weight * weight * residual;
  cost_ += weight * weight * residual * residual;
  ++equations_;
}

bool ArrowEquations::solve(double damping, Step& step) const {
  MatrixXd schur = S_;
  schur.diagonal() *= 1 + damping;
  VectorXd right = -g_;
  std::vector<Eigen::LLT<MatrixXd>> factors;
  std::vector<VectorXd> scales;
  for (const Block& block : blocks_) {
    MatrixXd own = block.H;
    own.diagonal() *= 1 + damping;
    scales.push_back(scale_of(own));
    const auto scale = scales.back().asDiagonal();
    factors.emplace_back(MatrixXd(scale * own * scale));
    if (factors.back().info() != Eigen::Success) return false;
    const MatrixXd C = block.C * scale;
    schur.noalias() -= C * factors.back().solve(C.transpose());
    right.noalias() += C * factors.back().solve(VectorXd(scale * block.g));
  }
  const VectorXd scale = scale_of(schur);
  const Eigen::LLT<MatrixXd> shared(MatrixXd(scale.asDiagonal() * schur * scale.asDiagonal()));
  if (shared.info() != Eigen::Success || !(shared.rcond() > kDefinite)) return false;
  step.shared = scale.cwiseProduct(shared.solve(scale.cwiseProduct(right)));
  step.local.clear();
  step.curvature = step.shared.dot(S_ * step.shared);
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Block& block = blocks_[k];
    const VectorXd own = -block.g - block.C.transpose() * step.shared;
    step.local.push_back(scales[k].cwiseProduct(factors[k].solve(scales[k].cwiseProduct(own))));
    const VectorXd& x = step.local.back();
    step.curvature += x.dot(block.H * x) + 2 * x.dot(block.C.transpose() * step.shared);
  }
  return step.shared.allFinite();
}

bool ArrowEquations::covariance(MatrixXd& shared) const {
  MatrixXd schur = S_;
  for (const Block& block : blocks_) {
    const VectorXd scale = scale_of(block.H);
    const Eigen::LLT<MatrixXd> own(MatrixXd(scale.asDiagonal() * block.H * scale.asDiagonal()));
    if (own.info() != Eigen::Success) return false;
    const MatrixXd C = block.C * scale.asDiagonal();
    schur.noalias() -= C * own.solve(C.transpose());
  }
  const VectorXd scale = scale_of(schur);
  const Eigen::LLT<MatrixXd> factors(MatrixXd(scale.asDiagonal() * schur * scale.asDiagonal()));
  if (factors.info() != Eigen::Success || !(factors.rcond() > kDefinite)) return false;
  shared =
      scale.asDiagonal() * factors.solve(MatrixXd::Identity(schur.rows(), schur.cols())) * scale.asDiagonal();
  shared = 0.5 * (shared + shared.transpose()).eval();
  return shared.allFinite();
}

}  // namespace understudy::calibration
