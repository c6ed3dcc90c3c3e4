// The calibration of a gap sensor from start to end: a table of pictures and a machine in, the machine as
// calibrated out (docs/gap-sensor-calibration.md).
#pragma once

#include <string>
#include <vector>

#include "calibration/gap_sensor/gap_picture_table.h"
#include "vision/dot/dot.h"

namespace understudy::calibration {

/// A row with a picture, and what became of it.
struct MeasuredGapPicture {
  GapPicture row;
  vision::DotMeasurement dot;  ///< unless its status is ok, the row is left out
};

struct GapSensorResult {
  machine::MachineDescription machine;  ///< calibrated, with its record
  std::string file;                     ///< the table
  std::vector<MeasuredGapPicture> pictures;
  std::vector<KnownGap> known;
  GapSensorFit fit;                   ///< residuals of the pictures that are used, in their order
  machine::MountingVector tolerance;  ///< 1 sigma, before
  std::vector<std::string> warnings;
};

/// Of the tolerance that a freedom keeps: above this share the pictures do not show it.
constexpr double kUnshown = 0.9;

/// Throws InputError for a machine without a microscope or without tolerances of its mounting, a table or a
/// picture that cannot be used, too few dots, and dots that no plausible mounting explains.
GapSensorResult calibrate_gap_sensor(const std::string& table, const machine::MachineDescription& machine);

/// From dots to the result. `machine` is the one that the dots were looked for with; its drawing is where the
/// tolerances begin.
GapSensorProblem gap_sensor_problem(const machine::MachineDescription& machine);
SeenDot seen_dot(const GapPicture& row, const vision::DotMeasurement& dot);
/// Gives `machine` what the fit found, and a record that names no table.
void set_gap_sensor(const GapSensorProblem& problem, const GapSensorFit& fit,
                    machine::MachineDescription& machine);

}  // namespace understudy::calibration
