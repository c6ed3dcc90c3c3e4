// The summary as a value, shared by summary.json and the report's data block.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rehearsal/record.h"

namespace understudy::rehearsal {

nlohmann::ordered_json summary_value(const Record& record);

/// Rounded to `digits` significant digits, so that the bytes do not hang on the last bit; no negative zero.
/// Throws std::logic_error naming `what` when the value is not finite.
double stable_number(double value, const char* what, int digits = 6);

/// JSON text; bytes that are not UTF-8 become U+FFFD. `indent` -1: one line.
std::string to_text(const nlohmann::ordered_json& value, int indent);

}  // namespace understudy::rehearsal
