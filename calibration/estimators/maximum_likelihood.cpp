#include "calibration/estimators/estimator.h"
#include "calibration/estimators/pose_error_fit.h"

namespace understudy::calibration {
namespace {

class MaximumLikelihood final : public Estimator {
 public:
  Calibration calibrate(const Problem& problem, const Options& options) const override {
    return maximum_likelihood(problem, unknowns(), options);
  }
  ChainCalibration calibrate_chain(const ChainProblem& problem, const Options& options) const override {
    return calibration::calibrate_chain(problem.nominal, problem.samples, options.max_iterations);
  }
};

}  // namespace

std::unique_ptr<Estimator> make_maximum_likelihood() { return std::make_unique<MaximumLikelihood>(); }

}  // namespace understudy::calibration
