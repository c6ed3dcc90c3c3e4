#include "calibration/estimators/estimator.h"
#include "calibration/estimators/pose_error_fit.h"

namespace understudy::calibration {
namespace {

// dev is common to all struts: it bends the strut equation where lengths differ much, and nothing else does.
class WithDeviation final : public Estimator {
 public:
  Unknowns unknowns() const override { return {.deviation = true}; }
  Calibration calibrate(const Problem& problem, const Options& options) const override {
    return maximum_likelihood(problem, unknowns(), options);
  }
};

}  // namespace

std::unique_ptr<Estimator> make_with_deviation() { return std::make_unique<WithDeviation>(); }

}  // namespace understudy::calibration
