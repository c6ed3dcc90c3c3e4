// The replay's part of the data block (docs/report-data.md#replay): machine, beads and program, packed.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/record.h"

namespace understudy::report {

/// How much of a run goes into a page: what is beyond is drawn coarser, and the block says so.
struct ReplayBudget {
  std::size_t sections = 60'000;   ///< of beads
  std::size_t points = 25'000;     ///< of the tool's path
  std::size_t triangles = 60'000;  ///< of a mesh; beyond, a body is its box and the part is left out
  std::size_t program_bytes = 4'000'000;
};

/// Null where the record has no replay.
nlohmann::ordered_json replay_data(const rehearsal::Record& record, const ReplayBudget& budget = {});

}  // namespace understudy::report
