#include "cli/options/noise_option.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::cli {

std::optional<calibration::MeasurementNoise> noise_of(const std::vector<double>& um_mrad) {
  if (um_mrad.empty()) return std::nullopt;
  for (const double v : um_mrad)
    if (!(v > 0) || v > 1e5)
      throw InputError(fmt::format("--noise {:g} is outside 0 (not included) to 1e5", v));
  return calibration::MeasurementNoise{um_mrad[0] * kMicrometre, um_mrad[1] * 1e-3};
}

}  // namespace understudy::cli
