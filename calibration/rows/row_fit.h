// The most likely machine and surroundings for rows of measurements: Levenberg-Marquardt on the likelihood,
// with a wide normal prior on the machine's parameters that matters only where rows tell nothing.
#pragma once

#include "calibration/rows/row_noise.h"

namespace understudy::calibration {

struct RowFit {
  RowState state;
  bool settled = false;  ///< the last step was below 1e-5 standard deviations
  int iterations = 0;
  double chi_square = 0;       ///< by the told and added noise
  Eigen::VectorXd error;       ///< of every equation, in SI
  Eigen::VectorXd fitted;      ///< variance of the model's value in every equation
  Eigen::VectorXd moved;       ///< of the unknowns, from the start
  Eigen::MatrixXd covariance;  ///< of the unknowns: machine first, then surroundings
  /// Of each row, squared: how far it is from what the others say, by its noise and theirs. Chi-square with
  /// as many degrees as it has equations where nothing is spoiled; directions that no other row tells are
  /// left out.
  std::vector<double> apart;
};

class RowLikelihood {
 public:
  /// `unknowns` are numbers of RowMachine::parameters(); keeps a reference to `problem`.
  RowLikelihood(const RowProblem& problem, const SurroundingsLayout& layout,
                std::vector<Eigen::Index> unknowns);

  /// From `start`, whose machine is the nominal one. With `machine_too` false only the surroundings move.
  RowFit fit(const RowState& start, const AddedNoise& noise, bool machine_too, int max_iterations,
             const RowWeights& weights = {}) const;
  /// The same, the noise found from the residuals in turns with the fit. `noise` in: where that begins.
  RowFit fit_with_noise(const RowState& start, AddedNoise& noise, bool machine_too, int max_iterations,
                        const RowWeights& weights = {}) const;

  const std::vector<Eigen::Index>& unknowns() const { return unknowns_; }
  /// 1 sigma of the prior of each of them.
  const Eigen::VectorXd& prior() const { return prior_; }

 private:
  struct Linear {
    Eigen::MatrixXd J;  // whitened: machine's unknowns, then the surroundings
    Eigen::VectorXd e;
    Eigen::VectorXd error;  // not whitened
  };
  Linear linear(const RowState& at, const AddedNoise& noise, bool machine_too,
                const RowWeights& weights) const;
  void tell(const AddedNoise& noise, bool machine_too, const RowWeights& weights, RowFit& found) const;
  RowState step_from(const RowState& at, const Eigen::VectorXd& step, Eigen::Index machine) const;

  const RowProblem& problem_;
  const SurroundingsLayout& layout_;
  std::vector<Eigen::Index> unknowns_;
  Eigen::VectorXd prior_;
};

}  // namespace understudy::calibration
