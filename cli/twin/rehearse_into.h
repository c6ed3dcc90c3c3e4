#pragma once

#include <filesystem>

#include "rehearsal/record.h"
#include "rehearsal/request/request.h"

namespace understudy::cli {

/// Rehearses with progress on standard error unless it is to be quiet, and writes the results into an
/// existing folder.
rehearsal::Record rehearse_into(const rehearsal::RehearsalRequest& request,
                                const std::filesystem::path& folder, bool quiet = false);

}  // namespace understudy::cli
