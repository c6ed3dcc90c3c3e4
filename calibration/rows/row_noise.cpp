#include "calibration/rows/row_noise.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace understudy::calibration {
namespace {

using Eigen::Index;

constexpr double kExplained = 3;  // standard deviations of chi-square, above which noise is understated
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kLeast = 1e-9;  // [m] or [rad]: rows without any scatter still have a covariance

NoisePart position_part(RowKind kind) {
  switch (kind) {
    case RowKind::distance:
      return NoisePart::distance;
    case RowKind::point:
      return NoisePart::point;
    case RowKind::plane:
      return NoisePart::plane;
    default:
      return NoisePart::position;
  }
}

double square(double v) { return v * v; }

/// First of the six numbers of the row's covariance that its equations have.
Index offset_of(RowKind kind) { return kind == RowKind::orientation ? 3 : 0; }

/// Told variance of every equation.
Eigen::VectorXd told_variances(const RowProblem& problem) {
  const auto first = first_equations(problem);
  Eigen::VectorXd told(first.back() + static_cast<Index>(problem.distances.size()));
  for (std::size_t j = 0; j < problem.rows.size(); ++j) {
    const MeasurementRow& row = problem.rows[j];
    const int n = equations_of(row.kind);
    told.segment(first[j], n) = row.covariance.diagonal().segment(offset_of(row.kind), n);
  }
  for (std::size_t k = 0; k < problem.distances.size(); ++k)
    told[first.back() + static_cast<Index>(k)] = square(problem.distances[k].sigma);
  return told;
}

/// Of each equation, whether its row counts; known distances do.
std::vector<bool> counted(const RowProblem& problem, const RowWeights& weights) {
  std::vector<bool> counts;
  for (std::size_t j = 0; j < problem.rows.size(); ++j)
    counts.insert(counts.end(), static_cast<std::size_t>(equations_of(problem.rows[j].kind)),
                  weight_of(weights, j) > 0);
  counts.insert(counts.end(), problem.distances.size(), true);
  return counts;
}

std::vector<bool> noise_told(const RowProblem& problem) {
  std::vector<bool> told;
  for (const MeasurementRow& row : problem.rows)
    told.insert(told.end(), static_cast<std::size_t>(equations_of(row.kind)), row.noise_told);
  told.insert(told.end(), problem.distances.size(), true);
  return told;
}

/// The variance that, added to `told`, brings the sum of squares by their variances to `wanted`.
double added_variance(const std::vector<double>& squares, const std::vector<double>& told, double wanted) {
  const auto sum = [&](double added) {
    double total = 0;
    for (std::size_t i = 0; i < squares.size(); ++i) total += squares[i] / (told[i] + added);
    return total;
  };
  double low = square(kLeast), high = low;
  if (sum(low) <= wanted) return low;
  while (sum(high) > wanted && high < 1e6) high *= 4;
  for (int halving = 0; halving < 100; ++halving) {
    const double middle = std::sqrt(low * high);
    (sum(middle) > wanted ? low : high) = middle;
  }
  return high;
}

}  // namespace

std::vector<NoisePart> parts_of(const RowProblem& problem) {
  std::vector<NoisePart> parts;
  for (const MeasurementRow& row : problem.rows) {
    if (row.kind != RowKind::orientation)
      parts.insert(parts.end(),
                   row.kind == RowKind::pose ? 3U : static_cast<std::size_t>(equations_of(row.kind)),
                   position_part(row.kind));
    if (row.kind == RowKind::pose || row.kind == RowKind::orientation)
      parts.insert(parts.end(), 3U, NoisePart::turn);
  }
  parts.insert(parts.end(), problem.distances.size(), NoisePart::exact);
  return parts;
}

void whiten(const RowProblem& problem, const AddedNoise& added, RowEquations& equations) {
  const auto first = first_equations(problem);
  const auto parts = parts_of(problem);
  for (std::size_t j = 0; j < problem.rows.size(); ++j) {
    const MeasurementRow& row = problem.rows[j];
    const Index n = equations_of(row.kind), at = offset_of(row.kind);
    Eigen::MatrixXd covariance = row.covariance.block(at, at, n, n);
    for (Index i = 0; i < n; ++i)
      covariance(i, i) += square(
          std::max(kLeast, added[static_cast<std::size_t>(parts[static_cast<std::size_t>(first[j] + i)])]));
    const Eigen::LLT<Eigen::MatrixXd> root(covariance);
    const auto divide = [&](auto&& block) { block = root.matrixL().solve(Eigen::MatrixXd(block)); };
    divide(equations.error.middleRows(first[j], n));
    if (equations.machine.cols() > 0) divide(equations.machine.middleRows(first[j], n));
    if (equations.around.cols() > 0) divide(equations.around.middleRows(first[j], n));
  }
  for (std::size_t k = 0; k < problem.distances.size(); ++k) {
    const Index row = first.back() + static_cast<Index>(k);
    equations.error[row] /= problem.distances[k].sigma;
    if (equations.machine.cols() > 0) equations.machine.row(row) /= problem.distances[k].sigma;
    if (equations.around.cols() > 0) equations.around.row(row) /= problem.distances[k].sigma;
  }
}

std::array<PartScatter, kNoiseParts> scatter(const RowProblem& problem, const Eigen::VectorXd& error,
                                             const Eigen::VectorXd& fitted, const AddedNoise& added,
                                             const RowWeights& weights) {
  const auto parts = parts_of(problem);
  const auto counts = counted(problem, weights);
  const auto is_told = noise_told(problem);
  const Eigen::VectorXd told = told_variances(problem);
  std::array<PartScatter, kNoiseParts> found;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i] == NoisePart::exact || !counts[i]) continue;
    const auto part = static_cast<std::size_t>(parts[i]);
    const auto row = static_cast<Index>(i);
    PartScatter& s = found[part];
    ++s.equations;
    s.degrees += 1 - std::min(1.0, fitted[row] / (told[row] + square(std::max(kLeast, added[part]))));
    if (told[row] > 0)
      s.told += square(error[row]) / told[row];
    else
      s.told = kNever;
    s.all_told = s.all_told && is_told[i];
  }
  return found;
}

AddedNoise explaining_noise(const RowProblem& problem, const Eigen::VectorXd& error,
                            const Eigen::VectorXd& fitted, const AddedNoise& before,
                            const RowWeights& weights) {
  const auto parts = parts_of(problem);
  const auto counts = counted(problem, weights);
  const Eigen::VectorXd told = told_variances(problem);
  const auto found = scatter(problem, error, fitted, before, weights);
  AddedNoise added = before;
  for (std::size_t part = 0; part < kNoiseParts; ++part) {
    const PartScatter& s = found[part];
    if (s.equations == 0 || s.degrees < 1) continue;
    if (s.all_told && s.told < s.degrees + kExplained * std::sqrt(2 * s.degrees)) {
      added[part] = 0;
      continue;
    }
    std::vector<double> squares, variances;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (static_cast<std::size_t>(parts[i]) != part || !counts[i]) continue;
      squares.push_back(square(error[static_cast<Index>(i)]));
      variances.push_back(told[static_cast<Index>(i)]);
    }
    added[part] = std::sqrt(added_variance(squares, variances, s.degrees));
  }
  return added;
}

AddedNoise median_noise(const RowProblem& problem, const Eigen::VectorXd& error,
                        const Eigen::VectorXd& fitted, const AddedNoise& before) {
  constexpr double kMedian = 0.4549;  // of the square of a standard normal number
  constexpr double kSpread = 2.3;     // relative, times 1 / sqrt(n): 1 sigma of that median as an estimate
  constexpr double kLeastShare = 0.05;
  const auto parts = parts_of(problem);
  const Eigen::VectorXd told = told_variances(problem);
  const auto all = scatter(problem, error, fitted, before);
  AddedNoise added = before;
  for (std::size_t part = 0; part < kNoiseParts; ++part) {
    if (all[part].equations == 0) continue;
    std::vector<double> squares, variances;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (static_cast<std::size_t>(parts[i]) != part) continue;
      const auto row = static_cast<Index>(i);
      // What the fit has not taken of a residual that it was made from.
      const double share = 1 - fitted[row] / (told[row] + square(std::max(kLeast, before[part])));
      squares.push_back(square(error[row]) / std::max(kLeastShare, share));
      variances.push_back(told[row]);
    }
    const auto median_with = [&](double variance) {
      std::vector<double> ratio;
      for (std::size_t i = 0; i < squares.size(); ++i)
        ratio.push_back(squares[i] / (variances[i] + variance));
      const auto middle = ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2);
      std::nth_element(ratio.begin(), middle, ratio.end());
      return *middle;
    };
    double low = square(kLeast), high = low;
    const double n = static_cast<double>(squares.size());
    if (all[part].all_told && median_with(0) < kMedian * (1 + kExplained * kSpread / std::sqrt(n))) {
      added[part] = 0;
      continue;
    }
    while (median_with(high) > kMedian && high < 1e6) high *= 4;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = std::sqrt(low * high);
      (median_with(middle) > kMedian ? low : high) = middle;
    }
    added[part] = std::sqrt(high);
  }
  return added;
}

}  // namespace understudy::calibration
