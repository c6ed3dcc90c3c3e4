// The strut-length residual with the six of each pose weighed by the inverse of their covariance, J S J^T
// (docs/reference.md#whitening): one strut's residual tells of all six pose errors, so they are correlated
// and unequal. Reaches the efficiency of maximum likelihood without forward kinematics.
#include "calibration/calibrated.h"
#include "calibration/estimators/estimator.h"
#include "calibration/estimators/whitened_residuals.h"
#include "calibration/identifiability.h"

namespace understudy::calibration {
namespace {

class Whitened final : public Estimator {
 public:
  Calibration calibrate(const Problem& problem, const Options& options) const override {
    const Identifiability found = check_identifiability(problem, {});
    if (found.status != Status::ok) return refused(problem, found);
    const std::vector<bool> all(problem.samples.size(), true);
    WhitenedResiduals objective(problem);
    Calibration result =
        calibrated(problem, fit(objective, problem.nominal, {}, all, options.max_iterations), {}, all);
    result.warnings.insert(result.warnings.begin(), found.warnings.begin(), found.warnings.end());
    return result;
  }
};

}  // namespace

std::unique_ptr<Estimator> make_whitened() { return std::make_unique<Whitened>(); }

}  // namespace understudy::calibration
