#include "toolpath/gcode/macros/gcode_macro_text.h"

#include <algorithm>
#include <cctype>

namespace understudy::toolpath::macro_text {

std::string upper(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

std::string shown(std::string_view text) {
  constexpr std::size_t kShown = 60;
  std::string plain(text.substr(0, kShown));
  for (char& c : plain)
    if (c < 32 || c > 126) c = '?';
  return plain;
}

}  // namespace understudy::toolpath::macro_text
