// The paper's estimator: least squares of the inverse-kinematic strut-length residual by Gauss-Newton, every
// residual weighed alike (Zhuang 1998; Song 2015, eq 6). Needs no forward kinematics and no covariance.
#include "calibration/calibrated.h"
#include "calibration/estimators/estimator.h"
#include "calibration/identifiability.h"
#include "calibration/residual_covariance.h"

namespace understudy::calibration {
namespace {

class StrutResiduals final : public Objective {
 public:
  explicit StrutResiduals(const Problem& problem) : samples_(problem.samples) {
    // One weight for all: it makes the cost dimensionless and moves no parameter.
    double variance = 0;
    StrutLinearisation at;
    for (const PoseSample& sample : samples_)
      if (linearise(problem.nominal, sample, sample.X_BT, at))
        variance += residual_covariance(at, sample).trace() / kStruts;
    weight_ = static_cast<double>(samples_.size()) / variance;
  }
  bool term(std::size_t j, const HexapodParameters& machine, PoseTerm& term) override {
    if (!linearise(machine, samples_[j], samples_[j].X_BT, term.at)) return false;
    term.M = weight_ * Mat6::Identity();
    term.v = weight_ * term.at.residual;
    term.cost = weight_ * term.at.residual.squaredNorm();
    return true;
  }
  double weight() const { return weight_; }

 private:
  const std::vector<PoseSample>& samples_;
  double weight_ = 1;
};

/// Of an estimate whose weights are not the noise's: H^-1 (sum of G^T M C M G) H^-1.
ParameterMatrix covariance_of_equal_weights(const Problem& problem, const HexapodParameters& machine,
                                            double weight, const ParameterMatrix& inverse) {
  NormalEquations spread({});
  StrutLinearisation at;
  for (const PoseSample& sample : problem.samples)
    if (linearise(machine, sample, sample.X_BT, at))
      spread.add(at, weight * weight * residual_covariance(at, sample), Vec6::Zero());
  return inverse * spread.information() * inverse;
}

class IkResidual final : public Estimator {
 public:
  Calibration calibrate(const Problem& problem, const Options& options) const override {
    const Identifiability found = check_identifiability(problem, {});
    if (found.status != Status::ok) return refused(problem, found);
    const std::vector<bool> all(problem.samples.size(), true);
    StrutResiduals objective(problem);
    Calibration result =
        calibrated(problem, fit(objective, problem.nominal, {}, all, options.max_iterations), {}, all);
    if (result.ok())
      result.covariance =
          covariance_of_equal_weights(problem, result.parameters, objective.weight(), result.covariance);
    result.warnings.insert(result.warnings.begin(), found.warnings.begin(), found.warnings.end());
    return result;
  }
};

}  // namespace

std::unique_ptr<Estimator> make_ik_residual() { return std::make_unique<IkResidual>(); }

}  // namespace understudy::calibration
