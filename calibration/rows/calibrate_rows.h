// Calibration of a machine from rows of any kind, with the frames, targets and places that are unknown.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/rows/row_outliers.h"
#include "core/progress.h"

namespace understudy::calibration {

/// What one part of the rows (positions, turns, ...) shows.
struct PartReport {
  std::string name;  ///< "position", "turn", "distance", "point", "plane"
  int equations = 0;
  int values = 0;                ///< vectors of three, or single numbers
  double before = 0, after = 0;  ///< RMS of the values' lengths [m] or [rad]
  double added = 0;              ///< noise on each axis that the residuals show beyond the told one
  bool told = false;             ///< all rows told their noise
};

/// What was found besides the machine, with its 1 sigma.
struct FoundNumber {
  std::string name;
  double value = 0, sigma = 0;  ///< [m] or [rad]; turns: of the rotation vector
  bool angle = false;
};

/// How well the machine places what was measured on it, about its base.
struct TargetSigma {
  std::string name;
  double median = 0;  ///< [m], 1 sigma of its 3D position, over the rows that saw it
};

/// A row that was left out, since it does not agree with the others.
struct SpoiledRow {
  std::size_t row = 0;          ///< of the problem
  double sigmas = 0;            ///< root of RowFit::apart
  double length = 0, turn = 0;  ///< [m], [rad], of its residual, as far as its kind has them
};

/// Of the base class `residuals` are empty and `used` is false of spoiled rows.
struct RowCalibration : Estimation {
  RowMachine machine;                  ///< the nominal one unless ok or not converged
  std::vector<std::string> estimated;  ///< names of the machine's parameters that were
  std::vector<std::string> redundant;  ///< those that whole poses could not tell beside them either
  Eigen::MatrixXd covariance;          ///< of `estimated`; [m], [rad]
  Eigen::VectorXd changes;             ///< of `estimated`, from the drawing [m] or [rad]
  Surroundings around;
  Surroundings around_nominal;  ///< as the nominal machine has them
  std::vector<FoundNumber> found;
  std::vector<TargetSigma> target_sigmas;
  std::vector<PartReport> parts;
  /// Parameters of which the rows tell less than the prior of row_fit.h: they stay near their drawing.
  std::vector<std::string> untold;
  /// Combinations of parameters, likewise, in words: "length offset 1, with base joint 1 z (-0.97)".
  std::vector<std::string> untold_together;
  std::vector<SpoiledRow> spoiled;
  /// Of each row, in SI, as row_equations.h orders them; `before`: with the nominal machine.
  std::vector<Eigen::VectorXd> before, after;
  std::vector<Eigen::VectorXd> whitened;  ///< of `after`
  AddedNoise added{};
  double shared = 0;  ///< of the errors of one pose's rows, what they have in common (shared_error.h)
};

struct RowOptions {
  int max_iterations = 100;
  /// False: the machine stays, and only what stands around it is found.
  bool machine = true;
  AddedNoise start{1e-3, 2e-3, 1e-3, 1e-3, 1e-3};  ///< where the search for the noise begins
  Progress progress = {};                          ///< by stages
};

/// Never throws for data: `status` and `message` say what is missing, `pose` which row.
RowCalibration calibrate_rows(const RowProblem& problem, const RowOptions& options = {});

struct ComparedRows {
  std::vector<PartReport> all;
  std::vector<std::vector<PartReport>> by_table;  ///< by MeasurementRow::table
};

/// What rows that were not fitted say: `problem` against the machine and the surroundings that `fitted` found
/// from `from`, each with its own. What stands around the new rows only is found from them.
ComparedRows compared_rows(const RowProblem& problem, const RowProblem& from, const RowCalibration& fitted);

}  // namespace understudy::calibration
