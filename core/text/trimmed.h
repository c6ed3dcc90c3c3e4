// Text without what surrounds it.
#pragma once

#include <string_view>

namespace understudy {

/// A view into `text` without blanks, tabs and line ends at its two ends.
constexpr std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) + 1 - first);
}

}  // namespace understudy
