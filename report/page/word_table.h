// A table as rows of words: for a terminal and for a page alike.
#pragma once

#include <string>
#include <vector>

namespace understudy::report {

struct WordTable {
  std::string title, note;
  std::vector<std::string> head;
  std::size_t words = 0;  ///< first columns that are no numbers; a last column "stops" is none either
  std::vector<std::vector<std::string>> rows;
};

/// Columns aligned by spaces, the title above.
std::string plain_text(const WordTable& table);
/// A section with its heading and note.
std::string html_section(const WordTable& table);

/// With so many decimals.
std::string digits(double value, int decimals);

}  // namespace understudy::report
