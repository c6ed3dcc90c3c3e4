// Characters of Klipper's configuration.
#pragma once

#include <string>
#include <string_view>

namespace understudy::toolpath::macro_text {

std::string upper(std::string_view text);
bool is_blank(char c);
bool is_name(char c);  ///< letters, digits and _
/// For messages: 60 characters at most, all of them printable.
std::string shown(std::string_view text);

}  // namespace understudy::toolpath::macro_text
