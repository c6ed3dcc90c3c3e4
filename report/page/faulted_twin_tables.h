// Faults on the whole twin: the confusion table of fault and answer, what is wrong in it, and the plants.
#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "report/page/word_table.h"
#include "studies/gap/faulted_twin.h"

namespace understudy::report {

/// The confusion table of the first plant, the wrong answers of all, and the plants beside each other.
std::vector<WordTable> faulted_twin_tables(const studies::FaultedTwin& faulted);

/// Of gap.json.
nlohmann::ordered_json faulted_twin_value(const studies::FaultedTwin& faulted);

}  // namespace understudy::report
