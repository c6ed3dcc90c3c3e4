#include "calibration/rows/row_report.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include "core/quantile.h"

namespace understudy::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr double kUntold = 0.5;  // of the prior's sigma

/// The row of each equation; known distances, at the end, have none.
std::vector<std::size_t> rows_of_equations(const RowProblem& problem) {
  std::vector<std::size_t> rows;
  for (std::size_t j = 0; j < problem.rows.size(); ++j)
    rows.insert(rows.end(), static_cast<std::size_t>(equations_of(problem.rows[j].kind)), j);
  return rows;
}

/// Rows in reduced echelon form: each begins with a 1 in a column where no other has a number.
void reduce(MatrixXd& rows, std::vector<Index>& pivots) {
  for (Index i = 0; i < rows.rows(); ++i) {
    Index at_row = 0, at = 0;
    rows.bottomRows(rows.rows() - i).cwiseAbs().maxCoeff(&at_row, &at);
    rows.row(i).swap(rows.row(i + at_row));
    rows.row(i) /= rows(i, at);
    for (Index k = 0; k < rows.rows(); ++k)
      if (k != i) rows.row(k) -= rows(k, at) * rows.row(i);
    pivots.push_back(at);
  }
}

constexpr const char* kPartNames[kNoiseParts] = {"position", "turn", "distance", "point", "plane"};

}  // namespace

std::vector<PartReport> part_reports(const RowProblem& problem, const Eigen::VectorXd& before,
                                     const Eigen::VectorXd& after, const AddedNoise& added,
                                     const RowWeights& weights) {
  const auto parts = parts_of(problem);
  const auto scattered = scatter(problem, after, Eigen::VectorXd::Zero(after.size()), added, weights);
  const auto row_of = rows_of_equations(problem);
  std::vector<PartReport> reports;
  for (std::size_t part = 0; part < kNoiseParts; ++part) {
    if (scattered[part].equations == 0) continue;
    PartReport report;
    report.name = kPartNames[part];
    report.equations = scattered[part].equations;
    const bool single = part == static_cast<std::size_t>(NoisePart::distance) ||
                        part == static_cast<std::size_t>(NoisePart::plane);
    report.values = single ? report.equations : report.equations / 3;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (static_cast<std::size_t>(parts[i]) != part || weight_of(weights, row_of[i]) == 0) continue;
      report.before += std::pow(before[static_cast<Index>(i)], 2);
      report.after += std::pow(after[static_cast<Index>(i)], 2);
    }
    report.before = std::sqrt(report.before / report.values);
    report.after = std::sqrt(report.after / report.values);
    report.added = added[part];
    report.told = scattered[part].all_told;
    reports.push_back(report);
  }
  return reports;
}

std::vector<TargetSigma> target_sigmas(const RowProblem& problem, const SurroundingsLayout& layout,
                                       const std::vector<Index>& unknowns, const RowFit& fit) {
  const Index machine = fit.covariance.cols() - layout.columns();
  if (machine <= 0) return {};
  const MatrixXd by_all = jacobian(row_equations(problem, layout, fit.state, true), unknowns);
  const auto first = first_equations(problem);
  std::map<std::string, std::vector<double>> sigmas;
  for (std::size_t j = 0; j < problem.rows.size(); ++j) {
    const RowKind kind = problem.rows[j].kind;
    if (kind != RowKind::position && kind != RowKind::pose && kind != RowKind::point) continue;
    MatrixXd J = MatrixXd::Zero(3, fit.covariance.cols());
    J.leftCols(machine) = by_all.block(first[j], 0, 3, machine);
    const auto& target = layout.targets[static_cast<std::size_t>(layout.rows[j].target)];
    for (const Index column : {target.position, target.turn})
      if (column >= 0) J.middleCols<3>(machine + column) = by_all.block<3, 3>(first[j], machine + column);
    sigmas[target.name].push_back(std::sqrt((J * fit.covariance).cwiseProduct(J).sum()));
  }
  std::vector<TargetSigma> list;
  for (const auto& [name, all] : sigmas) list.push_back({name.empty() ? "tool" : name, quantile(all, 0.5)});
  return list;
}

std::vector<FoundNumber> found_numbers(const SurroundingsLayout& layout, const Surroundings& around,
                                       const MatrixXd& covariance) {
  std::vector<FoundNumber> numbers;
  for (const std::string& name : layout.names) numbers.push_back({name, 0, 0, false});
  const auto set = [&](Index column, const Vec3& values, bool angle) {
    for (Index k = 0; column >= 0 && k < 3; ++k) {
      numbers[static_cast<std::size_t>(column + k)].value = values[k];
      numbers[static_cast<std::size_t>(column + k)].angle = angle;
    }
  };
  const auto poses = [&](const auto& slots, const std::vector<Pose>& at) {
    for (std::size_t i = 0; i < slots.size(); ++i) {
      set(slots[i].position, at[i].translation(), false);
      set(slots[i].turn, log_rotation(at[i].linear()), true);
    }
  };
  poses(layout.frames, around.frames);
  poses(layout.targets, around.targets);
  for (std::size_t i = 0; i < layout.points.size(); ++i)
    set(layout.points[i].position, around.points[i], false);
  for (std::size_t i = 0; i < layout.anchors.size(); ++i) {
    set(layout.anchors[i].position, around.anchors[i], false);
    if (layout.anchors[i].turn >= 0)
      numbers[static_cast<std::size_t>(layout.anchors[i].turn)].value = around.zeros[i];
  }
  for (std::size_t i = 0; i < layout.planes.size(); ++i) {
    const Index column = layout.planes[i].position;
    set(column, {0, 0, around.planes[i].offset}, false);
    numbers[static_cast<std::size_t>(column)].angle = numbers[static_cast<std::size_t>(column + 1)].angle =
        true;
  }
  const Index first = covariance.rows() - layout.columns();
  for (std::size_t k = 0; k < numbers.size(); ++k)
    numbers[k].sigma = std::sqrt(covariance(first + static_cast<Index>(k), first + static_cast<Index>(k)));
  return numbers;
}

std::vector<SpoiledRow> spoiled_list(const RowProblem& problem, const RowFit& fit,
                                     const RowWeights& weights) {
  std::vector<SpoiledRow> list;
  const auto first = first_equations(problem);
  for (std::size_t j = 0; j < weights.size(); ++j) {
    if (weights[j] > 0) continue;
    const RowKind kind = problem.rows[j].kind;
    const Eigen::VectorXd e = fit.error.segment(first[j], first[j + 1] - first[j]);
    SpoiledRow row{j, std::sqrt(fit.apart[j]), 0, 0};
    const bool turns = kind == RowKind::pose || kind == RowKind::orientation;
    if (turns) row.turn = e.tail<3>().norm();
    if (kind != RowKind::orientation) row.length = turns ? e.head<3>().norm() : e.norm();
    list.push_back(row);
  }
  return list;
}

void name_untold(const std::vector<std::string>& names, const MatrixXd& covariance,
                 const Eigen::VectorXd& prior, RowCalibration& result) {
  constexpr double kNamed = 0.1;  // of the parameter that moves most
  constexpr std::size_t kWords = 5;
  const Eigen::VectorXd scale = prior.cwiseInverse();
  const MatrixXd share = scale.asDiagonal() * covariance * scale.asDiagonal();
  for (Index k = 0; k < prior.size(); ++k)
    if (share(k, k) > kUntold * kUntold) result.untold.push_back(names[static_cast<std::size_t>(k)]);
  if (prior.size() == 0) return;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(share);
  const Index weak = (eigen.eigenvalues().array() > kUntold * kUntold).count();
  MatrixXd rows = eigen.eigenvectors().rightCols(weak).transpose();
  std::vector<Index> pivots;
  reduce(rows, pivots);
  for (Index i = 0; i < weak; ++i) {
    std::vector<std::string> words;
    std::size_t beside = 0;
    for (Index k = 0; k < rows.cols(); ++k) {
      if (k == pivots[static_cast<std::size_t>(i)] || std::abs(rows(i, k)) < kNamed) continue;
      if (++beside <= kWords)
        words.push_back(fmt::format("{} ({:.2f})", names[static_cast<std::size_t>(k)], rows(i, k)));
    }
    if (words.empty()) continue;  // it is told as a single one
    std::string text = names[static_cast<std::size_t>(pivots[static_cast<std::size_t>(i)])] + " with ";
    for (std::size_t w = 0; w < words.size(); ++w) text += (w > 0 ? ", " : "") + words[w];
    if (beside > kWords) text += fmt::format(" and {} more", beside - kWords);
    result.untold_together.push_back(text);
  }
}

}  // namespace understudy::calibration
