// The one interface of all estimators, and the table of their names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibration/problem.h"

namespace understudy::calibration {

class Estimator {
 public:
  virtual ~Estimator() = default;
  virtual Unknowns unknowns() const { return {}; }
  /// Checks the data first (identifiability.h). Never throws: `status` and `message` say what is missing.
  virtual Calibration calibrate(const Problem& problem, const Options& options = {}) const = 0;
};

struct EstimatorEntry {
  std::string name;         ///< word of --estimator
  std::string description;  ///< one line
  std::unique_ptr<Estimator> (*make)();
};

const std::vector<EstimatorEntry>& estimators();

/// Throws InputError that names the nearest known estimator.
std::unique_ptr<Estimator> make_estimator(const std::string& name);

std::unique_ptr<Estimator> make_ik_residual();
std::unique_ptr<Estimator> make_whitened();
std::unique_ptr<Estimator> make_maximum_likelihood();
std::unique_ptr<Estimator> make_robust();
std::unique_ptr<Estimator> make_with_deviation();
std::unique_ptr<Estimator> make_with_play();

}  // namespace understudy::calibration
