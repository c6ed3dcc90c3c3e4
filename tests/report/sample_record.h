// Records as rehearsals leave them, made by closed forms: what the report must be able to show.
#pragma once

#include <vector>

#include "rehearsal/record.h"
#include "report/picture/scene_pictures.h"

namespace understudy::report {

rehearsal::Record sample_go();
rehearsal::Record sample_no_go();  ///< 30 findings
rehearsal::Record sample_without_gap_control();
rehearsal::Record sample_stopped_by_constraints();  ///< nothing was simulated

/// Two, with captions.
std::vector<Illustration> sample_pictures();

}  // namespace understudy::report
