// Records as rehearsals leave them, made by closed forms: what the report must be able to show.
#pragma once

#include "rehearsal/record.h"

namespace understudy::rehearsal {

Record sample_go();
Record sample_no_go();  ///< 30 findings
Record sample_without_gap_control();
Record sample_stopped_by_constraints();  ///< nothing was simulated

}  // namespace understudy::rehearsal
