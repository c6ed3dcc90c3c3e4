#include "rehearsal/axis_columns.h"

#include <cmath>

namespace understudy::rehearsal {

std::vector<AxisColumn> axis_columns(const kinematics::Mechanism& mechanism) {
  std::vector<AxisColumn> columns;
  for (int i = 0; i < mechanism.axis_count(); ++i) {
    const std::string name = mechanism.axis_name(i);
    const bool taken = name == "x" || name == "y" || name == "z";
    AxisColumn column{(taken ? "axis_" : "") + name + (mechanism.axis_is_angle(i) ? "_deg" : "_mm"), {}, {}};
    const kinematics::AxisRange range = mechanism.axis_range(i);
    if (std::isfinite(range.lower)) column.min = range.lower;
    if (std::isfinite(range.upper)) column.max = range.upper;
    columns.push_back(column);
  }
  return columns;
}

}  // namespace understudy::rehearsal
