#include "calibration/estimators/estimator.h"
#include "calibration/estimators/pose_error_fit.h"

namespace understudy::calibration {
namespace {

// A play shows as the difference of strut lengths between the two approaches; l_i0 takes their mean.
class WithPlay final : public Estimator {
 public:
  Unknowns unknowns() const override { return {.play = true}; }
  Calibration calibrate(const Problem& problem, const Options& options) const override {
    return maximum_likelihood(problem, unknowns(), options);
  }
};

}  // namespace

std::unique_ptr<Estimator> make_with_play() { return std::make_unique<WithPlay>(); }

}  // namespace understudy::calibration
