// Findings about how much material comes out.
#pragma once

#include <optional>
#include <vector>

#include "rehearsal/findings/finding.h"
#include "rehearsal/observers/fill_watch.h"
#include "rehearsal/observers/flow_watch.h"

namespace understudy::rehearsal {

/// Where the bead is thinner or thicker than programmed: warnings. Starts, ends and corners, at which an
/// extruder lags for less than 5 mm, are one finding where there are many.
std::vector<Finding> flow_findings(const std::vector<FlowStretch>& stretches);

/// Lines of a layer that leave voids between them, or have no room for their material. Nothing where they
/// fill 85 to 115 % of the space: slicers' users trim the flow to within some 5 %.
std::optional<Finding> fill_finding(const std::optional<FillFigures>& fill);

}  // namespace understudy::rehearsal
