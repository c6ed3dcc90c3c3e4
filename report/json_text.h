// JSON values as text.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace understudy::report {

/// Bytes that are not UTF-8 become U+FFFD. `indent` -1: one line.
std::string to_text(const nlohmann::ordered_json& value, int indent);

}  // namespace understudy::report
