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

/// Lines that are filled thinly because the extruder lags, not because too little is fed.
inline constexpr const char* kLag = "lag";
/// Of what is fed, the least that half of the neighbouring lines may have where they lie: below, a warning.
constexpr double kLeastOfFed = 0.85;

/// Lines of a layer that leave voids between them, or have no room for their material: nothing where what is
/// fed fills 85 to 115 % of the space, for slicers' users trim the flow to within some 5 %. And lines that
/// the lag makes thin, where enough is fed: a warning, and an error where they fill less than half.
std::vector<Finding> fill_findings(const std::optional<FillFigures>& fill);

}  // namespace understudy::rehearsal
