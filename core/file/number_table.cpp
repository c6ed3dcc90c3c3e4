#include "core/file/number_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/text/trimmed.h"

namespace understudy {
namespace {

using Cell = TextRow::Cell;

std::vector<Cell> cells_of(const std::string& line) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  while (true) {
    const auto comma = line.find(',', at);
    cells.push_back({std::string(trimmed(
                         std::string_view(line).substr(at, comma == std::string::npos ? comma : comma - at))),
                     static_cast<int>(at) + 1});
    if (comma == std::string::npos) return cells;
    at = comma + 1;
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

}  // namespace

void check_header_words(const std::vector<std::string>& header, const std::vector<std::string>& known,
                        const Place& place) {
  std::set<std::string> seen;
  for (const std::string& word : header) {
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      const std::string near = nearest_word(word, known);
      throw InputError(place, fmt::format("unknown column '{}'{}", word.substr(0, 40),
                                          near.empty() ? "" : ", did you mean '" + near + "'?"));
    }
    if (!seen.insert(word).second) throw InputError(place, fmt::format("column '{}' is given twice", word));
  }
}

double table_number(const Cell& cell, const std::string& name, const Place& place) {
  const char* const begin = cell.text.data() + (cell.text.starts_with('+') ? 1 : 0);
  const char* const end = cell.text.data() + cell.text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    throw InputError(place, name + " is '" + cell.text.substr(0, 40) + "', not a finite number");
  return value;
}

bool read_text_row(std::istream& in, TextRow& row) {
  std::string line;
  while (std::getline(in, line)) {
    ++row.line;
    const std::string text(trimmed(line));
    if (text.empty() || text[0] == '#') continue;
    row.cells = cells_of(line);
    return true;
  }
  return false;
}

std::vector<NumberRow> read_number_table(std::istream& in, const std::string& name,
                                         const std::vector<std::string>& header) {
  TextRow line;
  if (!read_text_row(in, line))
    throw InputError({name, 0, 0}, "is empty; the header is '" + joined(header) + "'");
  std::vector<std::string> words;
  for (const Cell& cell : line.cells) words.push_back(cell.text);
  if (words != header)
    throw InputError({name, line.line, 0},
                     "the header is '" + joined(words) + "', not '" + joined(header) + "'");
  std::vector<NumberRow> rows;
  while (read_text_row(in, line)) {
    const auto& cells = line.cells;
    if (cells.size() != header.size())
      throw InputError({name, line.line, 0},
                       std::to_string(cells.size()) + " cells, not " + std::to_string(header.size()));
    NumberRow row{line.line, {}};
    for (std::size_t i = 0; i < cells.size(); ++i)
      row.values.push_back(table_number(cells[i], header[i], {name, line.line, cells[i].column}));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace understudy
