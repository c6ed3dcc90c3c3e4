// Small drawings of a calibration's report, as SVG text.
#pragma once

#include <string>
#include <vector>

#include "calibration/machine/machine_calibration.h"

namespace understudy::report {

/// Tip residuals x, y, z after the calibration, pose by pose.
std::string pose_chart(const calibration::MachineCalibration& result);
/// Residuals in units of the stated noise: strut by strut, or coordinate by coordinate of a chain's poses.
std::string spread_chart(const calibration::MachineCalibration& result);
/// Ordered whitened residuals against a normal distribution.
std::string quantile_chart(const calibration::MachineCalibration& result);
/// The colours of a slice, from 0 to `top` [m].
std::string heat_key(double top);
/// Tip uncertainty on one plane of the work space; `top` is the scale's end [m].
std::string slice_chart(const calibration::TipMap::Slice& slice, double top);

/// Whitened residuals of the used poses, ascending, each enlarged for the parameters that were fitted.
std::vector<double> ordered_residuals(const calibration::MachineCalibration& result);

}  // namespace understudy::report
