// The contract's summary of a rehearsal.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/record.h"

namespace understudy::report {

/// Keys whose value is absent are left out. A number that is not finite is our own mistake and throws
/// std::logic_error. Numbers carry six significant digits, counts all; equal records give equal bytes.
nlohmann::ordered_json summary_value(const rehearsal::Record& record);
std::string summary_json(const rehearsal::Record& record);

/// What differs from run to run: how long it took.
std::string timing_json(const rehearsal::Record& record);
constexpr const char* kTimingFile = "timing.json";

}  // namespace understudy::report
