#include "toolpath/planners/curve_csv.h"

#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/number_table.h"
#include "core/file/read_file.h"
#include "core/units.h"

namespace understudy::toolpath {

std::vector<Vec3> read_curve_csv(const std::filesystem::path& path) {
  std::istringstream text(read_file(path));
  std::vector<Vec3> curve;
  for (const NumberRow& row : read_number_table(text, path.string(), {"x_mm", "y_mm", "z_mm"}))
    curve.push_back(kMillimetre * Vec3(row.values[0], row.values[1], row.values[2]));
  if (curve.size() < 2)
    throw InputError(Place{path.string()}, fmt::format("{} points, a curve needs 2", curve.size()));
  return curve;
}

}  // namespace understudy::toolpath
