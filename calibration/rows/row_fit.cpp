#include "calibration/rows/row_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStepDone = 1e-10;     // of step^T H step: 1e-5 standard deviations
constexpr double kDampingMax = 1e12;    // no step that can be told from none lowers the cost
constexpr double kNoiseSettled = 1e-3;  // relative change of the found noise
constexpr int kNoiseRounds = 30;

double cost_of(const VectorXd& e, const VectorXd& by, const VectorXd& prior) {
  return e.squaredNorm() + by.head(prior.size()).cwiseQuotient(prior).squaredNorm();
}

}  // namespace

RowLikelihood::RowLikelihood(const RowProblem& problem, const SurroundingsLayout& layout,
                             std::vector<Index> unknowns)
    : problem_(problem), layout_(layout), unknowns_(std::move(unknowns)) {
  const auto parameters = problem.nominal.parameters();
  prior_.resize(static_cast<Index>(unknowns_.size()));
  for (std::size_t k = 0; k < unknowns_.size(); ++k)
    prior_[static_cast<Index>(k)] =
        parameters[static_cast<std::size_t>(unknowns_[k])].angle ? problem.prior.angle : problem.prior.length;
}

RowLikelihood::Linear RowLikelihood::linear(const RowState& at, const AddedNoise& noise, bool machine_too,
                                            const RowWeights& weights) const {
  RowEquations equations = row_equations(problem_, layout_, at, machine_too);
  Linear out;
  out.error = equations.error;
  whiten(problem_, noise, equations);
  out.J = jacobian(equations, unknowns_);
  out.e = std::move(equations.error);
  if (weights.empty()) return out;
  const auto first = first_equations(problem_);
  for (std::size_t j = 0; j < weights.size(); ++j) {
    const double root = std::sqrt(weights[j]);
    out.e.segment(first[j], first[j + 1] - first[j]) *= root;
    if (out.J.cols() > 0) out.J.middleRows(first[j], first[j + 1] - first[j]) *= root;
  }
  return out;
}

RowState RowLikelihood::step_from(const RowState& at, const VectorXd& step, Index machine) const {
  RowState to{at.machine, moved(at.around, layout_, step.tail(layout_.columns()))};
  if (machine == 0) return to;
  VectorXd by = VectorXd::Zero(static_cast<Index>(at.machine.parameters().size()));
  for (Index k = 0; k < machine; ++k) by[unknowns_[static_cast<std::size_t>(k)]] = step[k];
  to.machine = at.machine.moved(by);
  return to;
}

RowFit RowLikelihood::fit(const RowState& start, const AddedNoise& noise, bool machine_too,
                          int max_iterations, const RowWeights& weights) const {
  RowFit found;
  found.state = start;
  const Index machine = machine_too ? prior_.size() : 0, unknowns = machine + layout_.columns();
  const VectorXd prior = prior_.head(machine);
  VectorXd by = VectorXd::Zero(unknowns);
  Linear at = linear(found.state, noise, machine_too, weights);
  if (unknowns == 0) {  // Eigen's reductions over no columns are undefined
    found.settled = true;
    found.covariance.resize(0, 0);
    found.moved = by;
    found.chi_square = at.e.squaredNorm();
    found.error = at.error;
    tell(noise, machine_too, weights, found);
    return found;
  }
  double cost = cost_of(at.e, by, prior), damping = 1e-6;
  VectorXd weight = VectorXd::Zero(unknowns);
  weight.head(machine) = prior.cwiseAbs2().cwiseInverse();
  MatrixXd H;
  for (; found.iterations < max_iterations && !found.settled; ++found.iterations) {
    H = at.J.transpose() * at.J;
    H.diagonal() += weight;
    const VectorXd g = at.J.transpose() * at.e - weight.cwiseProduct(by);
    const VectorXd scale = H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const MatrixXd scaled = scale.asDiagonal() * H * scale.asDiagonal();
    bool better = false;
    while (!better && damping < kDampingMax) {
      MatrixXd damped = scaled;
      damped.diagonal().array() += damping;
      const VectorXd step = scale.cwiseProduct(damped.ldlt().solve(scale.cwiseProduct(g)));
      const double curvature = step.dot(H * step);
      if (!std::isfinite(curvature)) {
        damping = std::max(1e-12, 10 * damping);
        continue;
      }
      const RowState next = step_from(found.state, step, machine);
      Linear after = linear(next, noise, machine_too, weights);
      const double lower = cost_of(after.e, by + step, prior);
      // Rounding of the cost itself is no reason against a step that hardly moves.
      better = lower < cost || (curvature < kStepDone && std::isfinite(lower));
      if (!better) {
        damping *= 10;
        continue;
      }
      found.settled = curvature < kStepDone;
      found.state = next;
      by += step;
      at = std::move(after);
      cost = lower;
      damping = std::max(1e-14, damping / 10);
    }
    if (!better) break;
  }
  H = at.J.transpose() * at.J;
  H.diagonal() += weight;
  const VectorXd scale = H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const MatrixXd inverse = MatrixXd(scale.asDiagonal() * H * scale.asDiagonal())
                               .ldlt()
                               .solve(MatrixXd::Identity(unknowns, unknowns));
  found.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  found.covariance = 0.5 * (found.covariance + found.covariance.transpose()).eval();
  found.moved = by;
  found.chi_square = at.e.squaredNorm();
  found.error = at.error;
  tell(noise, machine_too, weights, found);
  return found;
}

/// What each row and equation says about the fit.
void RowLikelihood::tell(const AddedNoise& noise, bool machine_too, const RowWeights& weights,
                         RowFit& found) const {
  constexpr double kUntested =
      1e-3;  // a direction of which the fit took all but this tells nothing of the row
  const Index unknowns = found.covariance.rows();
  RowEquations equations = row_equations(problem_, layout_, found.state, machine_too);
  found.fitted = VectorXd::Zero(equations.error.size());
  if (unknowns > 0) {
    const MatrixXd J = jacobian(equations, unknowns_);
    found.fitted = (J * found.covariance).cwiseProduct(J).rowwise().sum();
  }
  whiten(problem_, noise, equations);
  const MatrixXd J = jacobian(equations, unknowns_);
  const auto first = first_equations(problem_);
  found.apart.assign(problem_.rows.size(), 0.0);
  for (std::size_t j = 0; j < problem_.rows.size(); ++j) {
    const Index n = first[j + 1] - first[j];
    const VectorXd e = equations.error.segment(first[j], n);
    if (unknowns == 0) {
      found.apart[j] = e.squaredNorm();
      continue;
    }
    const auto rows = J.middleRows(first[j], n);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> share(MatrixXd(rows * found.covariance * rows.transpose()));
    const double w = weight_of(weights, j);
    for (Index i = 0; i < n; ++i) {
      const double h = share.eigenvalues()[i], left = 1 - w * h;
      if (left > kUntested)
        found.apart[j] += std::pow(share.eigenvectors().col(i).dot(e), 2) / (left * (1 + (1 - w) * h));
    }
    if (!std::isfinite(found.apart[j])) found.apart[j] = 1e300;
  }
}

RowFit RowLikelihood::fit_with_noise(const RowState& start, AddedNoise& noise, bool machine_too,
                                     int max_iterations, const RowWeights& weights) const {
  RowFit found = fit(start, noise, machine_too, max_iterations, weights);
  for (int round = 0; round < kNoiseRounds; ++round) {
    const AddedNoise next = explaining_noise(problem_, found.error, found.fitted, noise, weights);
    bool same = true;
    for (std::size_t part = 0; part < kNoiseParts; ++part)
      same = same && std::abs(next[part] - noise[part]) <= kNoiseSettled * noise[part];
    noise = next;
    // Always from the nominal machine, where the prior has its middle; what stands around is near already.
    found = fit({start.machine, found.state.around}, noise, machine_too, max_iterations, weights);
    if (same) break;
  }
  return found;
}

}  // namespace understudy::calibration
