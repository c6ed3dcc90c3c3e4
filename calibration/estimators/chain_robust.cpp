// Maximum likelihood over the poses of an open chain that agree (trimmed_search.h).
#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "calibration/calibrated.h"
#include "calibration/estimators/chain_likelihood.h"
#include "calibration/estimators/trimmed_search.h"

namespace understudy::calibration {
namespace {

class ChainPoseFit final : public PoseFit {
 public:
  ChainPoseFit(const ChainLikelihood& likelihood, const std::vector<ChainSample>& samples)
      : likelihood_(likelihood), samples_(samples) {}

  bool fit(const std::vector<bool>& used, int iterations, std::vector<double>& distances) override {
    const ChainFit found = likelihood_.fit(used, iterations);
    if (!found.identifiable) return false;
    distances.clear();
    for (std::size_t j = 0; j < samples_.size(); ++j) {
      const ChainSample& s = samples_[j];
      const Twist e = pose_error(s.X_ST, forward(found.machine, s.axes));
      Mat6 covariance = s.covariance;
      if (!used[j]) {
        const Eigen::MatrixXd rows = chain_rows(found.machine, s.axes)(Eigen::all, likelihood_.unknowns());
        covariance += rows * found.covariance * rows.transpose();
      }
      const double distance = e.dot(covariance.llt().solve(e));
      distances.push_back(std::isfinite(distance) ? distance : std::numeric_limits<double>::infinity());
    }
    return true;
  }

 private:
  const ChainLikelihood& likelihood_;
  const std::vector<ChainSample>& samples_;
};

ChainCalibration refused(ChainCalibration result, Status status, const std::string& message) {
  result.status = status;
  result.message = message;
  return result;
}

}  // namespace

ChainCalibration calibrate_chain_robust(const ChainParameters& nominal,
                                        const std::vector<ChainSample>& samples, const Options& options) {
  const ChainLikelihood likelihood(nominal, samples);
  if (!likelihood.refusal().message.empty()) return likelihood.refusal();
  const auto parameters = static_cast<int>(likelihood.unknowns().size());
  const std::size_t start = start_poses(parameters);
  if (samples.size() <= start)
    return refused(likelihood.refusal(), Status::too_few_poses,
                   "of " + std::to_string(samples.size()) +
                       " poses none can be rejected: robust needs at least " + std::to_string(start + 1));
  ChainPoseFit model(likelihood, samples);
  const std::vector<bool> used = agreeing_poses(
      model, {samples.size(), parameters, options.max_iterations, options.seed, options.progress});
  if (used.empty())
    return refused(likelihood.refusal(), Status::not_converged,
                   "no " + std::to_string(start) +
                       " of the poses, drawn at random, tell a machine: move every axis from pose to pose");
  ChainCalibration result = likelihood.calibration(used, options.max_iterations);
  if (const std::string warning = rejection_warning(used); !warning.empty())
    result.warnings.push_back(warning);
  return result;
}

}  // namespace understudy::calibration
