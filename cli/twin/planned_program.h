// Programs of scenarios that name a part and a planner in place of a file.
#pragma once

#include "regression/scenario.h"

namespace understudy::cli {

/// Writes to `output` what `understudy plan WORDS --machine M -o NAME` makes of the scenario's `plan`. A word
/// that is a file beside the scenario stands for that file. Throws InputError that begins with the scenario's
/// file; Interrupted passes through.
void write_planned(const regression::Scenario& scenario, const std::filesystem::path& output);

}  // namespace understudy::cli
