#include "core/number_table.h"

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

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::size_t at = 0;
  while (true) {
    const auto comma = line.find(',', at);
    cells.push_back(trimmed(line.substr(at, comma == std::string::npos ? comma : comma - at)));
    if (comma == std::string::npos) return cells;
    at = comma + 1;
  }
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

double number(const std::string& cell, const Place& place) {
  double value = 0;
  const char* end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    throw InputError(place, "'" + cell + "' is not a finite number");
  return value;
}

}  // namespace

std::vector<NumberRow> read_number_table(std::istream& in, const std::string& name, const std::vector<std::string>& header) {
  std::vector<NumberRow> rows;
  bool headed = false;
  std::string line;
  for (int count = 1; std::getline(in, line); ++count) {
    if (trimmed(line).empty() || trimmed(line)[0] == '#') continue;
    const auto cells = cells_of(line);
    if (!headed) {
      if (cells != header)
        throw InputError({name, count, 0}, "the header is '" + trimmed(line) + "', not '" + joined(header) + "'");
      headed = true;
      continue;
    }
    if (cells.size() != header.size())
      throw InputError({name, count, 0}, std::to_string(cells.size()) + " cells, not " + std::to_string(header.size()));
    NumberRow row{count, {}};
    for (std::size_t i = 0; i < cells.size(); ++i)
      row.values.push_back(number(cells[i], {name, count, static_cast<int>(i) + 1}));
    rows.push_back(std::move(row));
  }
  if (!headed) throw InputError({name, 0, 0}, "is empty; the header is '" + joined(header) + "'");
  return rows;
}

}  // namespace understudy
