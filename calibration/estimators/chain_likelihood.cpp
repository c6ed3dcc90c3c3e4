#include "calibration/estimators/chain_likelihood.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "calibration/calibrated.h"
#include "calibration/estimators/independent_columns.h"
#include "kinematics/rigid_pose.h"

namespace understudy::calibration {
namespace {

constexpr double kStepDone = 1e-14;  // of step^T H step: 1e-7 standard deviations

Fault input_fault(const ChainParameters& nominal, const std::vector<ChainSample>& samples) {
  for (std::size_t j = 0; j < samples.size(); ++j) {
    const ChainSample& s = samples[j];
    if (s.axes.size() != nominal.chain.axes.size())
      return fault_of_pose(j, std::to_string(s.axes.size()) + " axis readings for " +
                                  std::to_string(nominal.chain.axes.size()) + " axes");
    if (!std::all_of(s.axes.begin(), s.axes.end(), [](double q) { return std::isfinite(q); }))
      return fault_of_pose(j, "an axis reading is not finite");
    if (!kinematics::is_rigid(s.X_ST)) return fault_of_pose(j, "the measured pose is not finite and rigid");
    if (!s.covariance.allFinite() || s.covariance.llt().info() != Eigen::Success)
      return fault_of_pose(j, "the covariance is not positive definite");
  }
  return {};
}

}  // namespace

ChainLikelihood::ChainLikelihood(const ChainParameters& nominal, const std::vector<ChainSample>& samples)
    : nominal_(nominal), samples_(samples), names_(chain_parameter_names(nominal.chain)) {
  refusal_.parameters = nominal;
  refusal_.used.assign(samples.size(), true);
  const Fault fault = input_fault(nominal, samples);
  refusal_.message = fault.message;
  refusal_.pose = fault.pose;
  if (refusal_.message.empty())
    check();
  else
    refusal_.status = Status::bad_input;
}

/// Finds the unknowns, and whether they are all that a chain of these axes has.
void ChainLikelihood::check() {
  Eigen::MatrixXd J;
  Eigen::VectorXd e;
  stack(nominal_, refusal_.used, J, e);
  unknowns_ = independent_columns(J);
  for (std::size_t k = 0; k < names_.size(); ++k)
    (std::binary_search(unknowns_.begin(), unknowns_.end(), static_cast<Eigen::Index>(k))
         ? refusal_.estimated
         : refusal_.redundant)
        .push_back(names_[k]);
  const int possible = independent_parameters(nominal_.chain);
  if (static_cast<int>(unknowns_.size()) >= possible) return;
  const bool few = 6 * static_cast<int>(samples_.size()) < possible;
  refusal_.status = few ? Status::too_few_poses : Status::rank_deficient;
  refusal_.message = std::to_string(samples_.size()) + " poses tell " + std::to_string(unknowns_.size()) +
                     " of " + std::to_string(possible) +
                     " independent parameters: move every axis, in at least " +
                     std::to_string((possible + 5) / 6) + " poses that differ";
}

/// Errors and derivatives of the poses in use, each whitened by its covariance.
void ChainLikelihood::stack(const ChainParameters& machine, const std::vector<bool>& used, Eigen::MatrixXd& J,
                            Eigen::VectorXd& e) const {
  const auto rows = 6 * static_cast<Eigen::Index>(std::count(used.begin(), used.end(), true));
  J.resize(rows, static_cast<Eigen::Index>(names_.size()));
  e.resize(rows);
  Eigen::Index row = 0;
  for (std::size_t j = 0; j < samples_.size(); ++j) {
    if (!used[j]) continue;
    const ChainSample& s = samples_[j];
    const Eigen::LLT<Mat6> root(s.covariance);
    J.middleRows<6>(row) = root.matrixL().solve(chain_rows(machine, s.axes));
    e.segment<6>(row) = root.matrixL().solve(pose_error(s.X_ST, forward(machine, s.axes)));
    row += 6;
  }
}

ChainFit ChainLikelihood::fit(const std::vector<bool>& used, int max_iterations) const {
  ChainFit found;
  found.machine = nominal_;
  Eigen::MatrixXd J;
  Eigen::VectorXd e;
  stack(nominal_, used, J, e);
  found.identifiable = independent_columns(J(Eigen::all, unknowns_)).size() == unknowns_.size();
  if (!found.identifiable) return found;
  Eigen::LLT<Eigen::MatrixXd> factors;
  double curvature = 1;
  for (; found.iterations < max_iterations && curvature > kStepDone; ++found.iterations) {
    const Eigen::MatrixXd A = J(Eigen::all, unknowns_);
    factors.compute(A.transpose() * A);
    const Eigen::VectorXd step = factors.solve(A.transpose() * e);
    curvature = (A * step).squaredNorm();
    if (factors.info() != Eigen::Success || !std::isfinite(curvature)) break;
    Eigen::VectorXd by = Eigen::VectorXd::Zero(J.cols());
    for (std::size_t k = 0; k < unknowns_.size(); ++k) by[unknowns_[k]] = step[static_cast<Eigen::Index>(k)];
    found.machine = moved(found.machine, by);
    stack(found.machine, used, J, e);
  }
  found.chi_square = e.squaredNorm();
  found.identifiable = factors.info() == Eigen::Success && std::isfinite(found.chi_square);
  found.settled = found.identifiable && curvature <= kStepDone;
  if (found.identifiable)
    found.covariance = factors.solve(Eigen::MatrixXd::Identity(factors.rows(), factors.rows()));
  return found;
}

ChainCalibration ChainLikelihood::calibration(const std::vector<bool>& used, int max_iterations) const {
  ChainCalibration result = refusal_;
  const ChainFit found = fit(used, max_iterations);
  result.used = used;
  result.parameters = found.machine;
  result.iterations = found.iterations;
  result.chi_square = found.chi_square;
  result.degrees_of_freedom =
      6 * static_cast<int>(std::count(used.begin(), used.end(), true)) - static_cast<int>(unknowns_.size());
  for (const ChainSample& s : samples_)
    result.residuals.push_back(pose_error(s.X_ST, forward(found.machine, s.axes)));
  if (!found.settled) {
    result.message = "the search did not settle after " + std::to_string(found.iterations) +
                     " iterations: are readings and poses of the same rows, and the machine the right one?";
    return result;
  }
  result.covariance = found.covariance;
  result.status = Status::ok;
  return result;
}

ChainCalibration calibrate_chain(const ChainParameters& nominal, const std::vector<ChainSample>& samples,
                                 int max_iterations) {
  const ChainLikelihood likelihood(nominal, samples);
  if (!likelihood.refusal().message.empty()) return likelihood.refusal();
  return likelihood.calibration(std::vector<bool>(samples.size(), true), max_iterations);
}

}  // namespace understudy::calibration
