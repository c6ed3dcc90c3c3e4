// What a printer's start block does before the first layer: it heats, homes and purges.
#pragma once

#include <string_view>
#include <vector>

#include "rehearsal/findings/finding.h"
#include "toolpath/inspection/feature_types.h"

namespace understudy::rehearsal {

/// The line at which a slicer's comments say that the first layer or the first feature of the part begins; 0:
/// they do not say it. IceSL says it by its name, which it writes behind the start block.
int start_block_end(std::string_view text, const toolpath::FeatureTypes& features);

/// What does not stick or sags on lines before `end` is purged, and spoils no part: a warning. So is a nozzle
/// that touches the table there by less than 0.05 mm, as a `G1 Z0` does by the machine's errors, and one that
/// later ploughs through what was purged.
void tell_start_block(int end, std::vector<Finding>& findings);

}  // namespace understudy::rehearsal
