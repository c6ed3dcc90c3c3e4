// The columns of a machine's axes in records.
#pragma once

#include <vector>

#include "kinematics/mechanism.h"
#include "rehearsal/record.h"

namespace understudy::rehearsal {

/// "l1_mm", "j1_deg"; an axis called x, y or z has "axis_" before its name, because the tip has columns of
/// these.
std::vector<AxisColumn> axis_columns(const kinematics::Mechanism& mechanism);

}  // namespace understudy::rehearsal
