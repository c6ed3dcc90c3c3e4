// Text of strangers' files on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace understudy {

/// One line: control characters and bytes that are no UTF-8 as a backslash with their letter or hexadecimal
/// number, so that no text of a file moves the cursor or repaints the terminal; the middle of more than
/// `limit` bytes as " ... ".
std::string printable(std::string_view text, std::size_t limit = 2000);

}  // namespace understudy
