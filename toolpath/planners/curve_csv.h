// A curve from a CSV file.
#pragma once

#include <filesystem>
#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

/// A polyline from a CSV file with the header x_mm,y_mm,z_mm. Throws InputError with file, line and column
/// for another header, a row without three finite numbers, or fewer than two points.
std::vector<Vec3> read_curve_csv(const std::filesystem::path& path);

}  // namespace understudy::toolpath
