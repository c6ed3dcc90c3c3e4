// The answer of `understudy sweep` as JSON: sweep.json, and what `--json` prints.
#pragma once

#include <string>
#include <vector>

#include "regression/sweep.h"

namespace understudy::report {

/// "understudy.sweep/1" (docs/limits.md#what-is-printed). Figures of a machine that printed nothing are left
/// out.
std::string sweep_json(const std::vector<regression::SweepRow>& rows, double accepted_min_mm,
                       double accepted_max_mm);

}  // namespace understudy::report
