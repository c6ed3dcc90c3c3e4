// Text as a YAML value.
#pragma once

#include <string>
#include <string_view>

namespace understudy {

/// `text` in double quotes, read back as the same, unless it is empty: readers refuse that.
inline std::string yaml_quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n')
      result += "\\n";
    else if (c == '\t')
      result += "\\t";
    else if (c == '\r')
      result += "\\r";
    else
      result += c;
  }
  return result + "\"";
}

}  // namespace understudy
