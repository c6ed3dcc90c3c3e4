// Private to this folder: limits that reader and writer share.
#pragma once

namespace understudy::toolpath {

// No spool is longer; keeps sums finite.
constexpr double kLargestExtruder = 1e6;  // [m]

}  // namespace understudy::toolpath
