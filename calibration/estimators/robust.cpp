// Maximum likelihood over the poses that agree (trimmed_search.h).
#include <limits>

#include "calibration/calibrated.h"
#include "calibration/estimators/estimator.h"
#include "calibration/estimators/pose_error_fit.h"
#include "calibration/estimators/trimmed_search.h"
#include "calibration/identifiability.h"

namespace understudy::calibration {
namespace {

class HexapodPoseFit final : public PoseFit {
 public:
  explicit HexapodPoseFit(const Problem& problem) : problem_(problem), objective_(problem) {}

  bool fit(const std::vector<bool>& used, int iterations, std::vector<double>& distances) override {
    const Fit found = calibration::fit(objective_, problem_.nominal, {}, used, iterations);
    ParameterMatrix covariance;
    if (!found.equations.invert(covariance)) return false;
    distances.assign(problem_.samples.size(), std::numeric_limits<double>::infinity());
    PoseTerm term;
    for (std::size_t j = 0; j < problem_.samples.size(); ++j) {
      if (!objective_.term(j, found.machine, term)) continue;
      const Twist& e = objective_.error(j);
      const auto rows = pose_rows(term.at, {});
      const Mat6 predicted = problem_.samples[j].covariance + rows * covariance * rows.transpose();
      distances[j] = used[j] ? objective_.distance(j) : e.dot(predicted.llt().solve(e));
    }
    return true;
  }

 private:
  const Problem& problem_;
  PoseErrorObjective objective_;
};

class Robust final : public Estimator {
 public:
  Calibration calibrate(const Problem& problem, const Options& options) const override {
    const Identifiability found = check_identifiability(problem, {});
    if (found.status != Status::ok) return refused(problem, found);
    HexapodPoseFit model(problem);
    const std::vector<bool> used =
        agreeing_poses(model, {problem.samples.size(), kGeometryParameters, options.max_iterations,
                               options.seed, options.progress});
    if (used.empty())
      return refused(problem, Status::not_converged,
                     "no 8 of the poses agree on a machine: check their order");
    PoseErrorObjective objective(problem);
    Calibration result =
        calibrated(problem, fit(objective, problem.nominal, {}, used, options.max_iterations), {}, used);
    result.warnings.insert(result.warnings.begin(), found.warnings.begin(), found.warnings.end());
    if (const std::string warning = rejection_warning(used); !warning.empty())
      result.warnings.push_back(warning);
    return result;
  }
  ChainCalibration calibrate_chain(const ChainProblem& problem, const Options& options) const override {
    return calibrate_chain_robust(problem.nominal, problem.samples, options);
  }
};

}  // namespace

std::unique_ptr<Estimator> make_robust() { return std::make_unique<Robust>(); }

}  // namespace understudy::calibration
