// What the calibration of a gap sensor prints.
#pragma once

#include <string>

#include "calibration/gap_sensor/calibrate_gap_sensor.h"

namespace understudy::report {

/// What a machine's gap sensor reads over a flat before and after a calibration.
struct GapReadingChange {
  double gap = 0;          ///< [m], as the calibrated sensor has it
  double drawn = 0;        ///< [m], what the drawn one reads there; NaN where it finds no gap
  double drawn_sigma = 0;  ///< [m], by the tolerances of mounting
  double sigma = 0;        ///< [m], by the calibration
};
GapReadingChange gap_reading_change(const calibration::GapSensorResult& result, double gap);

std::string gap_sensor_text(const calibration::GapSensorResult& result);
/// "understudy.gap-sensor/1" (docs/gap-sensor-calibration.md); what does not exist is left out.
std::string gap_sensor_json(const calibration::GapSensorResult& result, const std::string& command);

}  // namespace understudy::report
