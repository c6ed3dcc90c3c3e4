// Commanded beside measured positions, axis by axis.
#pragma once

#include <vector>

#include "calibration/identify/axis_fit.h"
#include "machine/load_encoders.h"
#include "machine/record/recorded_motion.h"

namespace understudy::calibration {

struct AxisSeries {
  std::vector<std::vector<AxisRow>> drives, load;  ///< by axis; `load` is empty where nothing was measured
};

/// Travel counts from where a drive reads 0. A reading at a place where the axis has just been read says
/// nothing new: rows are at least half a count of encoder or motor apart.
AxisSeries axis_series(const machine::RecordedMotion& motion, const machine::MachineDescription& machine,
                       const machine::LoadEncoderCounts& counts);

}  // namespace understudy::calibration
