// The likelihood of an open chain's measured tool poses, and Gauss-Newton on it over some of them.
#pragma once

#include <string>
#include <vector>

#include "calibration/estimators/chain_calibration.h"

namespace understudy::calibration {

struct ChainFit {
  bool identifiable = false;  ///< the poses determine all parameters: else nothing below holds
  bool settled = false;       ///< the last step was below 1e-7 of the parameters' standard deviations
  ChainParameters machine;
  Eigen::MatrixXd covariance;  ///< of the unknown parameters; [m], [rad]
  int iterations = 0;
  double chi_square = 0;
};

class ChainLikelihood {
 public:
  /// Keeps references to both.
  ChainLikelihood(const ChainParameters& nominal, const std::vector<ChainSample>& samples);

  /// Its message is empty where all poses together can be fitted; nothing below may be asked where it is not.
  const ChainCalibration& refusal() const { return refusal_; }
  /// Columns of chain_rows() that are estimated: all poses together tell them apart.
  const std::vector<Eigen::Index>& unknowns() const { return unknowns_; }

  /// Over the poses with used[j], from the nominal machine.
  ChainFit fit(const std::vector<bool>& used, int max_iterations) const;
  /// The same with all that a user gets.
  ChainCalibration calibration(const std::vector<bool>& used, int max_iterations) const;

 private:
  void stack(const ChainParameters& machine, const std::vector<bool>& used, Eigen::MatrixXd& J,
             Eigen::VectorXd& e) const;
  void check();

  const ChainParameters& nominal_;
  const std::vector<ChainSample>& samples_;
  std::vector<std::string> names_;
  std::vector<Eigen::Index> unknowns_;
  ChainCalibration refusal_;  // until a search is made, also what one begins with
};

}  // namespace understudy::calibration
