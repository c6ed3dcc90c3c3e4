// Lines of a text, whatever ends them.
#pragma once

#include <algorithm>
#include <string_view>

namespace understudy {

/// The first line of `rest`, which begins behind it afterwards. A line ends at CR, LF or both.
constexpr std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end);
  if (rest.starts_with("\r\n"))
    rest.remove_prefix(2);
  else if (!rest.empty())
    rest.remove_prefix(1);
  return line;
}

}  // namespace understudy
