#include "machine/file/covariance_key.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include <fmt/format.h>

namespace understudy::machine {
namespace {

// The file has ten digits of each number; what they leave of a zero eigenvalue of the correlations is below.
constexpr double kRounding = 1e-7;

/// What is wrong with it, judged by correlations, for which units do not matter; empty where nothing is.
std::string why_not_semidefinite(const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(covariance.rows());
  for (Eigen::Index k = 0; k < covariance.rows(); ++k) {
    const double variance = covariance(k, k);
    if (variance < 0) return fmt::format("the variance of number {} is {:g}", k + 1, variance);
    if (variance > 0) weight[k] = 1 / std::sqrt(variance);
    if (variance == 0 && covariance.row(k).cwiseAbs().maxCoeff() > 0)
      return fmt::format("the variance of number {} is 0, its covariances are not", k + 1);
  }
  const Eigen::MatrixXd correlation = weight.asDiagonal() * covariance * weight.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation, Eigen::EigenvaluesOnly);
  const double least = eigen.eigenvalues()[0];
  if (least < -kRounding * static_cast<double>(covariance.rows()))
    return fmt::format("an eigenvalue of its correlations is {:.3g}", least);
  return "";
}

Eigen::MatrixXd symmetric(const std::vector<double>& triangle, const Eigen::VectorXd& units) {
  Eigen::MatrixXd full(units.size(), units.size());
  std::size_t at = 0;
  for (Eigen::Index i = 0; i < units.size(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) full(i, j) = full(j, i) = units[i] * units[j] * triangle[at++];
  return full;
}

}  // namespace

Eigen::MatrixXd read_covariance(YamlMap& map, const std::string& key, const Eigen::VectorXd& units,
                                const std::string& command, bool listed) {
  const auto rows = static_cast<std::size_t>(units.size());
  const auto triangle =
      map.numbers(key, map.recording() && listed ? 0 : rows * (rows + 1) / 2, {-1e6, 1e6},
                  "of the numbers of this section: the lower triangle, row by row, in mm and rad");
  if (!map.complete()) return Eigen::MatrixXd();
  const Eigen::MatrixXd covariance = symmetric(triangle, units);
  if (const std::string why = why_not_semidefinite(covariance); !why.empty())
    throw InputError(map.place(key), fmt::format("{} is not positive semi-definite: {}; write it with {}",
                                                 map.path(key), why, command));
  return covariance;
}

std::string covariance_text(const std::string& key, const Eigen::MatrixXd& covariance,
                            const Eigen::VectorXd& units, const std::string& page) {
  std::string out = fmt::format("  {}: [   # lower triangle; {} has the order\n", key, page);
  for (Eigen::Index i = 0; i < units.size(); ++i) {
    out += "    ";
    for (Eigen::Index j = 0; j <= i; ++j) {
      if (j > 0) out += ", ";
      out += fmt::format("{:.10g}", covariance(i, j) / (units[i] * units[j]));
    }
    out += i + 1 < units.size() ? ",\n" : "]\n";
  }
  return out;
}

}  // namespace understudy::machine
