// The option --noise um,mrad of commands about measured poses.
#pragma once

#include <optional>
#include <vector>

#include "calibration/synthetic.h"

namespace understudy::cli {

/// Nothing where it was not given. Throws InputError outside of its range.
std::optional<calibration::MeasurementNoise> noise_of(const std::vector<double>& um_mrad);

}  // namespace understudy::cli
