// Words as a shell takes them.
#pragma once

#include <string>
#include <string_view>

namespace understudy {

/// The word as a shell reads it, in single quotes where it needs them.
std::string shell_quoted(std::string_view word);

}  // namespace understudy
