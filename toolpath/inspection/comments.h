// The comments of a program, in which slicers write what they know.
#pragma once

#include <functional>
#include <string_view>

namespace understudy::toolpath {

/// Of each line that begins with a semicolon: its number in the file, from 1, as the reader counts lines, and
/// the text behind the semicolon, trimmed.
void for_each_comment(std::string_view text,
                      const std::function<void(int line, std::string_view comment)>& see);

}  // namespace understudy::toolpath
