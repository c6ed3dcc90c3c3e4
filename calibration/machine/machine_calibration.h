// What calibrating a machine yields, and what its user must know about it (docs/calibration-data.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/machine/measuring_frame.h"
#include "calibration/machine/tip_map.h"
#include "calibration/rows/calibrate_rows.h"
#include "calibration/synthetic.h"
#include "machine/calibrated_parameters.h"
#include "machine/description.h"

namespace understudy::calibration {

/// One measured pose against the model. Whitened: six numbers that are standard normal where the stated noise
/// is right and nothing was fitted.
struct PoseResidual {
  int line = 0;
  bool used = true;  ///< false: rejected as an outlier
  /// Measured less model, (tip [m], rotation vector [rad]) in B; of rows that measure less, NaN elsewhere, in
  /// the measuring frame, and of a distance or plane the first number only.
  Twist before, after;
  Twist whitened;                   ///< of `after`
  std::vector<double> strut;        ///< [m] length of each strut by the measured pose, less by its drive
  std::vector<double> strut_sigma;  ///< [m] what the pose's noise alone makes of it
};

/// A row of any kind that was left out, for it does not agree with the others.
struct SpoiledLine {
  std::string file;
  int line = 0;
  std::string kind;
  double sigmas = 0;            ///< from what the others say
  double length = 0, turn = 0;  ///< [m], [rad], as far as its kind has them
};

struct ParameterLine {
  std::string name, unit;
  double before = 0, after = 0;  ///< in `unit`
  double sigma = 0;              ///< in `unit`; NaN where a plug-in gave no covariance
};

struct ComparedFile {
  std::string file;
  std::vector<PartReport> parts;
};

struct MachineCalibration {
  machine::MachineDescription machine;  ///< calibrated, with its record
  std::string file;                     ///< of the measurements
  std::string estimator, command;
  bool noise_given = false;
  MeasurementNoise noise;               ///< that was assumed, unless given
  std::optional<MeasuringFrame> frame;  ///< as the file tells it; its share is in `tip`
  std::vector<PoseResidual> poses;
  std::vector<ParameterLine> parameters;
  std::vector<std::string> redundant;  ///< parameters that no pose can tell beside the others
  double correlation_max = 0;          ///< between any two parameters, absolute
  double chi_square = 0;
  int degrees_of_freedom = 0;
  int iterations = 0;
  TipMap tip;
  std::vector<std::string> warnings;
  // Of rows of any kind (calibration/rows); empty where whole poses in W were measured.
  std::vector<PartReport> parts;             ///< of the fitted rows
  std::vector<PartReport> compared;          ///< of rows that were not fitted
  std::vector<ComparedFile> compared_files;  ///< the same, file by file
  std::vector<TargetSigma> target_sigmas;
  double shared = 0;                         ///< RowCalibration::shared
  std::vector<FoundNumber> found;            ///< frames, targets, places
  std::vector<std::string> untold;           ///< parameters that stay near their drawing
  std::vector<std::string> untold_together;  ///< combinations of parameters that do
  std::vector<SpoiledLine> spoiled;
  std::vector<std::string> notes;        ///< units that were recognised
  machine::CalibratedParameters stored;  ///< what the calibrated file keeps besides `machine`
};

/// RMS of tip residuals [m] over the poses that were used.
double residual_rms(const MachineCalibration& result, bool before);

}  // namespace understudy::calibration
