// Measured poses as a lab brings them: the CSV of docs/calibration-data.md.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/estimators/chain_calibration.h"
#include "calibration/machine/measuring_frame.h"
#include "calibration/problem.h"
#include "calibration/synthetic.h"
#include "machine/description.h"

namespace understudy::calibration {

/// One pose held still and measured.
struct MeasuredPose {
  int line = 0;                        ///< of the file; 0: none
  Pose X_WT = Pose::Identity();        ///< measured
  Mat6 covariance = Mat6::Identity();  ///< as PoseSample::covariance, but in W
  std::vector<double> axes;            ///< as commanded [m] or [rad]; of a hexapod strut lengths
  kinematics::PerStrut<Approach> approach{};
};

struct Measurements {
  std::string file;    ///< as it was named
  std::string sha256;  ///< of its bytes, hexadecimal
  std::vector<MeasuredPose> poses;
  bool noise_given = false;             ///< by columns of the file
  bool approach_told = false;           ///< likewise
  std::optional<MeasuringFrame> frame;  ///< likewise
};

/// Throws InputError with file and line: columns that are missing (all named) or unknown (with the nearest
/// known one), numbers that are none, quaternions that are not of unit length, metres or inches under a
/// millimetre column, and poses that this machine cannot have been near. `assumed` is the noise where the
/// file has none.
Measurements read_measurements(const std::string& file, const machine::MachineDescription& machine,
                               const MeasurementNoise& assumed);
/// The same, of a file whose text was read already: a pipe can be read once.
Measurements parse_measurements(const std::string& text, const std::string& file,
                                const machine::MachineDescription& machine, const MeasurementNoise& assumed);

/// The same file back, with `comment` in its first line. The noise is written as six standard deviations
/// where covariances are diagonal, else whole; not at all where `noise_given` is false.
std::string measurements_csv(const Measurements& measurements, const machine::MachineDescription& machine,
                             const std::string& comment);

/// A pose's covariance told in B, told in W; the other way with R_BW.
Mat6 told_in(const Mat3& R_WB, const Mat6& covariance_B);

/// For the estimators.
Problem hexapod_problem(const Measurements& measurements, const machine::MachineDescription& machine);
std::vector<ChainSample> chain_samples(const Measurements& measurements,
                                       const machine::MachineDescription& machine);

}  // namespace understudy::calibration
