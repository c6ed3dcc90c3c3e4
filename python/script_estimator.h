// An estimator written in Python behind the interface of ours.
#pragma once

#include <memory>
#include <string>

#include <pybind11/pybind11.h>

#include "calibration/estimators/estimator.h"

namespace understudy::python {

/// A problem as a script sees it: of a hexapod the 42 parameters, of a chain offsets from its description. A
/// script may keep it, so it has its own copy.
class ScriptProblem {
 public:
  explicit ScriptProblem(const calibration::Problem& of)
      : hexapod_(std::make_shared<const calibration::Problem>(of)) {}
  explicit ScriptProblem(const calibration::ChainProblem& of)
      : chain_(std::make_shared<const calibration::ChainProblem>(of)) {}

  bool is_chain() const { return chain_ != nullptr; }
  std::vector<std::string> names() const;
  Eigen::VectorXd nominal() const;
  std::size_t sample_count() const;
  Pose measured(std::size_t sample) const;
  Mat6 covariance(std::size_t sample) const;
  std::vector<double> axes(std::size_t sample) const;  ///< displacements of a hexapod's drives, readings
  kinematics::PerStrut<calibration::Approach> approach(std::size_t sample) const;

  /// Measured less what a machine of these parameters makes, (tip [m], rotation vector [rad]); NaN where it
  /// cannot reach. Throws InputError for another number of parameters.
  std::vector<Twist> residuals(const Eigen::VectorXd& parameters) const;

  calibration::HexapodParameters hexapod(const Eigen::VectorXd& parameters) const;
  calibration::ChainParameters chain(const Eigen::VectorXd& parameters) const;

 private:
  void check(const Eigen::VectorXd& parameters) const;

  std::shared_ptr<const calibration::Problem> hexapod_;
  std::shared_ptr<const calibration::ChainProblem> chain_;
};

/// `script` is called with a ScriptProblem and returns the parameters, or a pair with their covariance; it
/// may be called from any thread, which takes the interpreter's lock. What it raises is status `no_answer`
/// with its text; KeyboardInterrupt comes out.
std::shared_ptr<calibration::Estimator> estimator_of_script(pybind11::object script);

void add_script_problem(pybind11::module_& module);

}  // namespace understudy::python
