// Small drawings of a calibration's report, as SVG text.
#pragma once

#include <string>
#include <vector>

#include "calibration/machine/calibrate.h"

namespace understudy::rehearsal {

/// Tip residuals x, y, z after the calibration, pose by pose.
std::string pose_chart(const CalibrateResult& result);
/// Residuals in units of the stated noise: strut by strut, or coordinate by coordinate of a chain's poses.
std::string spread_chart(const CalibrateResult& result);
/// Ordered whitened residuals against a normal distribution.
std::string quantile_chart(const CalibrateResult& result);
/// The colours of a slice, from 0 to `top` [m].
std::string heat_key(double top);
/// Tip uncertainty on one plane of the work space; `top` is the scale's end [m].
std::string slice_chart(const TipMap::Slice& slice, double top);

/// Whitened residuals of the used poses, ascending, each enlarged for the parameters that were fitted.
std::vector<double> ordered_residuals(const CalibrateResult& result);
/// Of the standard normal distribution (Acklam's rational approximation, 1e-9 relative); p within (0, 1).
double normal_quantile(double p);

}  // namespace understudy::rehearsal
