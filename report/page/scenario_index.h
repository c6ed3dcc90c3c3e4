// The index page of a folder of scenarios: what passed, what changed, how it went before.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "regression/scenario_outcome.h"
#include "report/scenario_history.h"

namespace understudy::report {

struct IndexedScenario {
  regression::ScenarioResult result;
  std::string description;
  std::string folder;                             ///< of its report, relative to the page; empty: it has none
  std::string picture;                            ///< relative to the page; empty: none
  std::string replay;                             ///< command that runs it alone
  std::vector<regression::MetricChange> changes;  ///< from the baseline
};

/// What tells a page of ours from another index.html.
constexpr const char* kIndexMark = "<meta name=\"generator\" content=\"understudy scenario run\">";

/// One self-contained page. `history`: runs before this one, oldest first.
std::string scenario_index_html(std::span<const IndexedScenario> scenarios, std::span<const PastRun> history);

}  // namespace understudy::report
