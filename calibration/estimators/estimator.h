// The one interface of all estimators, ours and plug-ins (calibration/plugin), and the table of the names of
// ours.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibration/estimators/chain_calibration.h"
#include "calibration/problem.h"

namespace understudy::calibration {

/// Hexapods have struts in closed loops, chains a tree of axes.
enum class MachineKind { hexapod, chain };

class Estimator {
 public:
  virtual ~Estimator() = default;
  /// Of a hexapod.
  virtual Unknowns unknowns() const { return {}; }
  /// These check the data first (identifiability.h). They never throw for data: `status` and `message` say
  /// what is missing.
  virtual Calibration calibrate(const Problem& problem, const Options& options = {}) const = 0;
  /// Status `unsupported` unless the estimator is made for chains.
  virtual ChainCalibration calibrate_chain(const ChainProblem& problem, const Options& options = {}) const;
};

struct EstimatorEntry {
  std::string name;         ///< word of --estimator
  std::string description;  ///< one line
  bool chains = false;      ///< calibrates open chains as well as hexapods
  std::unique_ptr<Estimator> (*make)();
};

const std::vector<EstimatorEntry>& estimators();
std::vector<std::string> estimator_names(MachineKind kind);

/// Throws InputError that names the nearest known estimator, or those for this kind of machine.
std::unique_ptr<Estimator> make_estimator(const std::string& name, MachineKind kind = MachineKind::hexapod);

std::unique_ptr<Estimator> make_ik_residual();
std::unique_ptr<Estimator> make_whitened();
std::unique_ptr<Estimator> make_maximum_likelihood();
std::unique_ptr<Estimator> make_robust();
std::unique_ptr<Estimator> make_with_deviation();
std::unique_ptr<Estimator> make_with_play();

}  // namespace understudy::calibration
