// The answer of `understudy pose` as JSON (docs/workspace.md).
#pragma once

#include <string>

#include "kinematics/mechanism.h"
#include "rehearsal/inspection/pose_look.h"

namespace understudy::report {

/// Positions and ranges in mm and degrees. An axis without ends has no range; what a pose does not have (axes
/// of one that cannot be reached, clearance where no bodies may meet) is left out.
std::string pose_json(const rehearsal::PoseLook& look, const kinematics::Mechanism& mechanism,
                      const std::string& machine, const std::string& command);

}  // namespace understudy::report
