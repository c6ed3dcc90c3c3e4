// Findings by the feature that a line prints, where the slicer's comments say it.
#pragma once

#include <vector>

#include "rehearsal/findings/finding.h"
#include "toolpath/inspection/feature_types.h"

namespace understudy::rehearsal {

/// Sag of a strand in air that is no longer than ten bores.
inline constexpr const char* kShortStrand = "short strand";
/// So many in a whole print are few.
inline constexpr int kFewStrands = 3;

/// Adds the feature type to findings about the printed lines. What does not stick to its place or sags in a
/// skirt, a brim, a purge line or a prime tower spoils no part: such errors become warnings. All other kinds
/// stay errors, as they tell of the machine or of the print as a whole. Few short strands of a sparse infill
/// that sag, and none that is long, are warnings, too: the layers above cross them and close the cell.
void tell_features(const toolpath::FeatureTypes& types, std::vector<Finding>& findings);

}  // namespace understudy::rehearsal
