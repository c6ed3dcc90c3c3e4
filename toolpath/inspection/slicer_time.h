// How long a print takes, as the slicer estimates it in a comment of its program.
#pragma once

#include <optional>
#include <string_view>

namespace understudy::toolpath {

/// [s], of "1h 16m 11s", "0 hours 25 minutes", "12.5 minutes" or "4711", which are seconds. Nothing for other
/// text.
std::optional<double> written_time(std::string_view text);

}  // namespace understudy::toolpath
