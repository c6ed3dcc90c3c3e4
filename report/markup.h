// Text as it stands in a page or a drawing.
#pragma once

#include <string>
#include <string_view>

namespace understudy::report {

/// With &, <, > and " written so that they are text, in elements and attributes.
inline std::string html_text(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

}  // namespace understudy::report
