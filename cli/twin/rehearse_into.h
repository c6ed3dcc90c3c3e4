#pragma once

#include <filesystem>

#include "rehearsal/record.h"
#include "rehearsal/request/request.h"

namespace understudy::report {
class LiveRecord;
}

namespace understudy::cli {

/// Rehearses with progress on standard error unless it is to be quiet, and writes the results into an
/// existing folder. `live`: told of the run while it goes; may be null.
rehearsal::Record rehearse_into(const rehearsal::RehearsalRequest& request,
                                const std::filesystem::path& folder, bool quiet = false,
                                report::LiveRecord* live = nullptr);

}  // namespace understudy::cli
