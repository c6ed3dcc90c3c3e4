#include "core/number_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace understudy {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

struct Cell {
  std::string text;
  int column;  ///< where the cell begins in its line, from 1
};

std::vector<Cell> cells_of(const std::string& line) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  while (true) {
    const auto comma = line.find(',', at);
    cells.push_back({trimmed(line.substr(at, comma == std::string::npos ? comma : comma - at)),
                     static_cast<int>(at) + 1});
    if (comma == std::string::npos) return cells;
    at = comma + 1;
  }
}

bool is_header(const std::vector<Cell>& cells, const std::vector<std::string>& header) {
  return std::equal(cells.begin(), cells.end(), header.begin(), header.end(),
                    [](const Cell& cell, const std::string& word) { return cell.text == word; });
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

double number(const Cell& cell, const std::string& name, const Place& place) {
  const char* const begin = cell.text.data() + (cell.text.starts_with('+') ? 1 : 0);
  const char* const end = cell.text.data() + cell.text.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    throw InputError(place, name + " is '" + cell.text.substr(0, 40) + "', not a finite number");
  return value;
}

}  // namespace

std::vector<NumberRow> read_number_table(std::istream& in, const std::string& name,
                                         const std::vector<std::string>& header) {
  std::vector<NumberRow> rows;
  bool headed = false;
  std::string line;
  for (int count = 1; std::getline(in, line); ++count) {
    if (trimmed(line).empty() || trimmed(line)[0] == '#') continue;
    const auto cells = cells_of(line);
    if (!headed) {
      if (!is_header(cells, header))
        throw InputError({name, count, 0},
                         "the header is '" + trimmed(line) + "', not '" + joined(header) + "'");
      headed = true;
      continue;
    }
    if (cells.size() != header.size())
      throw InputError({name, count, 0},
                       std::to_string(cells.size()) + " cells, not " + std::to_string(header.size()));
    NumberRow row{count, {}};
    for (std::size_t i = 0; i < cells.size(); ++i)
      row.values.push_back(number(cells[i], header[i], {name, count, cells[i].column}));
    rows.push_back(std::move(row));
  }
  if (!headed) throw InputError({name, 0, 0}, "is empty; the header is '" + joined(header) + "'");
  return rows;
}

}  // namespace understudy
