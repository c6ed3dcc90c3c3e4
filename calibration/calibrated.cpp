#include "calibration/calibrated.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace understudy::calibration {
namespace {

/// Standard score of a chi-square value (Wilson and Hilferty 1931).
double standard_score(double chi_square, int degrees) {
  const double n = degrees, v = 2 / (9 * n);
  return (std::cbrt(chi_square / n) - (1 - v)) / std::sqrt(v);
}

constexpr double kUnsupported = 4;  // standard scores: 3 in 100 000 good calibrations

void warn_of_play(const Unknowns& unknowns, Calibration& result) {
  for (std::size_t i = 0; unknowns.play && i < kStruts; ++i) {
    const Eigen::Index row = unknowns.first_play() + static_cast<Eigen::Index>(i);
    const double play = result.parameters.play[i];
    if (play >= 0 || result.covariance.size() == 0) continue;
    const double sigma = std::sqrt(result.covariance(row, row));
    if (-play < 3 * sigma) continue;
    result.warnings.push_back(
        fmt::format("strut {}: play of {:.1f} um is below 0 by {:.1f} standard deviations: are its "
                    "approaches named the wrong way "
                    "round?",
                    i + 1, play * 1e6, -play / sigma));
  }
}

}  // namespace

Twist pose_error(const Pose& measured, const Pose& reached) {
  Twist e;
  e.head<3>() = measured.translation() - reached.translation();
  e.tail<3>() = log_rotation(measured.linear() * reached.linear().transpose());
  return e;
}

std::string misfit_warning(double chi_square, int degrees, const char* lacking) {
  const double score = degrees > 0 ? standard_score(chi_square, degrees) : 0;
  if (std::abs(score) < kUnsupported) return {};
  const std::string much = fmt::format(
      "residuals are {:.2f} times what the stated noise explains (chi-square {:.1f} for {} degrees of "
      "freedom): ",
      std::sqrt(chi_square / degrees), chi_square, degrees);
  if (score > 0)
    return much + fmt::format("the noise is understated or the model lacks something ({})", lacking);
  return much +
         "the noise is overstated, or most of it is the same in all poses, and then the tip's uncertainty is "
         "larger "
         "than told";
}

Calibration refused(const Problem& problem, Status status, const std::string& message) {
  Calibration result;
  result.status = status;
  result.message = message;
  result.parameters = problem.nominal;
  result.used.assign(problem.samples.size(), true);
  return result;
}

Calibration refused(const Problem& problem, const Identifiability& found) {
  Calibration result = refused(problem, found.status, found.message);
  result.pose = found.pose;
  return result;
}

std::optional<std::size_t> add_residuals(const Problem& problem, const Unknowns& unknowns,
                                         Calibration& result) {
  result.residuals.clear();
  result.chi_square = 0;
  std::optional<std::size_t> beyond_reach;
  for (std::size_t j = 0; j < problem.samples.size(); ++j) {
    const PoseSample& sample = problem.samples[j];
    const HexapodParameters& machine = result.parameters;
    const auto reached = kinematics::forward(machine.geometry, strut_lengths(machine, sample), sample.X_BT);
    if (!beyond_reach && reached.status != kinematics::SolveStatus::ok) beyond_reach = j;
    result.residuals.push_back(pose_error(sample.X_BT, reached.X_BT));
    if (!result.used[j]) continue;
    const Twist& e = result.residuals.back();
    result.chi_square += e.dot(sample.covariance.llt().solve(e));
  }
  const auto used = std::count(result.used.begin(), result.used.end(), true);
  result.degrees_of_freedom = 6 * static_cast<int>(used) - unknowns.count();
  return beyond_reach;
}

Calibration calibrated(const Problem& problem, const Fit& fit, const Unknowns& unknowns,
                       const std::vector<bool>& used) {
  Calibration result;
  result.parameters = fit.machine;
  result.iterations = fit.iterations;
  result.used = used;
  add_residuals(problem, unknowns, result);
  result.status = fit.converged ? Status::ok : Status::not_converged;
  if (!fit.converged) {
    result.message =
        "the search did not settle after " + std::to_string(fit.iterations) +
        " iterations: are displacements and poses of the same rows, and the machine the right one?";
    return result;
  }
  if (!fit.equations.invert(result.covariance)) {
    result.status = Status::rank_deficient;
    result.message =
        "at the solution the poses no longer tell all parameters apart: add poses with more tilt";
    return result;
  }
  const std::string misfit =
      misfit_warning(result.chi_square, result.degrees_of_freedom, "outliers, dev, play");
  if (!misfit.empty()) result.warnings.push_back(misfit);
  warn_of_play(unknowns, result);
  return result;
}

}  // namespace understudy::calibration
