// What a stated uncertainty of a measurement may be (docs/limits.md). No instrument has less or more, and the
// squares of numbers far beyond are 0 or infinite.
#pragma once

namespace understudy::calibration {

constexpr double kLeastNoise = 1e-12, kLargestNoise = 1;  ///< [m] or [rad], 1 sigma

}  // namespace understudy::calibration
