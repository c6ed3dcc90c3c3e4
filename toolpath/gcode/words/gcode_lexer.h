// Characters of G-code to words: a letter, a number, and where it stands.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace understudy::toolpath {

struct Word {
  char letter = 0;        ///< upper case
  double value = 0;       ///< as written, finite
  std::string_view text;  ///< letter and number as written, for messages
  int column = 0;         ///< from 1
  bool bare = false;      ///< a letter without a number, which few commands take; value is 0
  bool quoted = false;    ///< P "text"; value is 0
};

/// The words of one line (without its line end), comments left out. Throws InputError with place for a
/// character that starts no word, a malformed or non-finite number, or a comment that is not closed.
std::vector<Word> lex_line(std::string_view line, const std::string& file, int line_number);

}  // namespace understudy::toolpath
