// From a table of measured poses to a calibrated machine, and what the user must know about it
// (docs/calibration-data.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/estimators/estimator.h"
#include "calibration/machine/calibrate_table.h"

namespace understudy::rehearsal {

struct CalibrateRequest {
  std::string measurements;                            ///< path of a CSV
  std::string machine = "hexapod";                     ///< name or path
  std::string estimator;                               ///< empty: maximum_likelihood
  std::optional<calibration::MeasurementNoise> noise;  ///< of poses, where the file has none
  std::string command;                                 ///< for the record: how a user repeats this
};

/// One measured pose against the model. Whitened: six numbers that are standard normal where the stated noise
/// is right and nothing was fitted.
struct PoseResidual {
  int line = 0;
  bool used = true;                 ///< false: rejected as an outlier
  Twist before, after;              ///< measured less model, (tip [m], rotation vector [rad]) in B
  Twist whitened;                   ///< of `after`
  std::vector<double> strut;        ///< [m] length of each strut by the measured pose, less by its drive
  std::vector<double> strut_sigma;  ///< [m] what the pose's noise alone makes of it
};

struct ParameterLine {
  std::string name, unit;
  double before = 0, after = 0, sigma = 0;  ///< in `unit`
};

/// 3D uncertainty of the tip, 1 sigma, that is left by the calibration and by the measuring frame.
struct TipMap {
  double median = 0, worst = 0, rms = 0;     ///< [m], over poses drawn from the work space
  double moved_median = 0, moved_worst = 0;  ///< [m], of the same poses between old and new model
  int poses = 0;
  /// At home's orientation: upright planes through home, across y and across z. NaN: cannot be reached.
  struct Slice {
    char u = 'x', v = 'y';
    double u0 = 0, v0 = 0, step = 0;  ///< [m], first point in W
    int columns = 0, rows = 0;
    std::vector<double> sigma;  ///< [m], row by row
  };
  std::vector<Slice> slices;
};

struct CalibrateResult {
  machine::MachineDescription machine;  ///< calibrated, with its record
  std::string file;                     ///< of the measurements
  std::string estimator, command;
  bool noise_given = false;
  calibration::MeasurementNoise noise;  ///< that was assumed, unless told
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
};

/// Throws InputError, with file and line where one row is at fault, for all that check_identifiability() and
/// read_measurements() refuse.
CalibrateResult calibrate(const CalibrateRequest& request);

/// RMS of tip residuals [m] over the poses that were used.
double residual_rms(const CalibrateResult& result, bool before);

/// What is printed.
std::string calibration_text(const CalibrateResult& result);
/// summary.json, schema "understudy.calibration/1".
std::string calibration_json(const CalibrateResult& result);
/// One page that opens from disk without a network.
std::string calibration_html(const CalibrateResult& result);

}  // namespace understudy::rehearsal
