#include "calibration/table/delimited_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include <fmt/format.h>

#include "calibration/table/header_units.h"
#include "core/error.h"

namespace understudy::calibration {
namespace {

using Words = std::vector<std::string>;

constexpr const char* kSpaces = " \t\r";

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(kSpaces);
  if (first == std::string::npos) return "";
  std::string word = text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
  if (word.size() > 1 && word.front() == '"' && word.back() == '"') word = word.substr(1, word.size() - 2);
  return word;
}

Words split(const std::string& line, char separator) {
  Words cells;
  if (separator == ' ') {
    std::istringstream in(line);
    for (std::string word; in >> word;) cells.push_back(trimmed(word));
    return cells;
  }
  std::string cell;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == separator && !quoted) {
      cells.push_back(trimmed(cell));
      cell.clear();
    } else {
      cell += c;
    }
  }
  cells.push_back(trimmed(cell));
  // A separator behind the last cell.
  return cells;
}

bool to_number(std::string text, char decimal, double& value) {
  if (decimal == ',') {
    if (text.find('.') != std::string::npos) return false;
    std::replace(text.begin(), text.end(), ',', '.');
  }
  const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc() && stop == end && std::isfinite(value);
}

bool is_number(const std::string& text) {
  double value = 0;
  return to_number(text, '.', value) || to_number(text, ',', value);
}

/// Of the line's cells as they come out, the separator that leaves numbers.
char separator_of(const std::string& line, char decimal) {
  for (const char c : {';', '\t'})
    if (line.find(c) != std::string::npos) return c;
  if (decimal != ',' && line.find(',') != std::string::npos) {
    const Words by_comma = split(line, ','), by_space = split(line, ' ');
    // "0,5 1,25": commas before decimals, spaces between cells.
    const bool spaced = by_space.size() > 1 && std::all_of(by_space.begin(), by_space.end(), is_number);
    return spaced && line.find(", ") == std::string::npos ? ' ' : ',';
  }
  return ' ';
}

/// A name where the next line has a number. Rows of points have names, too, each of them.
bool names_columns(const Words& first, const Words& next) {
  if (std::all_of(first.begin(), first.end(), is_number)) return false;
  if (first.size() != next.size()) return true;
  for (std::size_t i = 0; i < first.size(); ++i)
    if (!is_number(first[i]) && is_number(next[i])) return true;
  return false;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

DelimitedText::DelimitedText(const std::string& text, const std::string& file, const TextFormat& format)
    : file_(file), format_(format) {
  if (text.starts_with("PK\x03\x04"))
    throw InputError({file, 0, 0}, "is a spreadsheet or an archive: export the table as CSV");
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw InputError({file, 0, 0}, "is UTF-16: save it as plain text (UTF-8, CSV)");
  std::istringstream in(text.starts_with("\xef\xbb\xbf") ? text.substr(3) : text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (number <= format.skip_lines || trimmed(line).empty()) continue;
    if (rows_.empty() && trimmed(line).size() == 5 && lower(line).starts_with("sep=")) {
      if (format_.separator == '\0') format_.separator = line[4];
      continue;
    }
    if (!format.comment.empty() && trimmed(line).starts_with(format.comment)) continue;
    rows_.push_back({number, {line}});
  }
  if (rows_.empty()) throw InputError({file, 0, 0}, "has no rows");
  if (format_.separator == '\0')
    format_.separator = separator_of(rows_[rows_.size() > 1 ? 1 : 0].cells[0], format_.decimal);
  if (format_.separator == ',' && format_.decimal == ',')
    throw InputError({file, 0, 0}, "commas cannot stand both between cells and before decimals");
  for (Row& row : rows_) row.cells = split(row.cells[0], format_.separator);
  const Words& first = rows_.front().cells;
  if (format_.header < 0)
    format_.header = names_columns(first, rows_.size() > 1 ? rows_[1].cells : Words{}) ? 1 : 0;
  columns_ = first.size();
  if (format_.header == 1) {
    header_ = first;
    rows_.erase(rows_.begin());
  }
  if (rows_.empty()) throw InputError({file, 0, 0}, "has a header but no rows");
  for (const Row& row : rows_)
    if (row.cells.size() != columns_)
      throw InputError({file, row.line, 0},
                       fmt::format("{} cells, where the first line has {}", row.cells.size(), columns_));
  if (format_.decimal == '\0') find_decimal();
}

void DelimitedText::find_decimal() {
  bool comma = false, point = false;
  double value = 0;
  for (const Row& row : rows_)
    for (const std::string& cell : row.cells) {
      comma = comma || (cell.find(',') != std::string::npos && to_number(cell, ',', value));
      point = point || (cell.find('.') != std::string::npos && to_number(cell, '.', value));
    }
  if (comma && point && format_.separator != ',')
    throw InputError(
        {file_, 0, 0},
        "some numbers have a comma and some a point before their decimals: state `decimal`, and remove "
        "what separates thousands");
  format_.decimal = comma && format_.separator != ',' ? ',' : '.';
}

std::string DelimitedText::name(std::size_t column) const {
  return column < header_.size() ? "'" + header_[column] + "'" : fmt::format("column {}", column + 1);
}

std::size_t DelimitedText::column(const std::string& wanted) const {
  std::vector<std::size_t> same;
  for (std::size_t i = 0; i < header_.size(); ++i)
    if (header_[i] == wanted) same.push_back(i);
  for (std::size_t i = 0; same.empty() && i < header_.size(); ++i)
    if (lower(header_[i]) == lower(wanted)) same.push_back(i);
  const std::string plain = lower(header_name(wanted).name);
  if (same.empty())
    for (std::size_t i = 0; i < header_.size(); ++i)
      if (lower(header_name(header_[i]).name) == plain) same.push_back(i);
  if (same.size() > 1)
    throw InputError({file_, 0, 0}, fmt::format("column '{}' is there twice: name it by its number", wanted));
  if (same.size() == 1) return same.front();
  std::size_t number = 0;
  const auto [stop, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), number);
  if (error == std::errc() && stop == wanted.data() + wanted.size()) {
    if (number >= 1 && number <= columns_) return number - 1;
    throw InputError({file_, 0, 0}, fmt::format("there is no column {}, only {}", number, columns_));
  }
  if (header_.empty())
    throw InputError(
        {file_, 0, 0},
        fmt::format("column '{}': the file has no header, give a number from 1 to {}", wanted, columns_));
  const std::string near = nearest_word(wanted, header_);
  throw InputError({file_, 0, 0}, fmt::format("there is no column '{}'{}", wanted,
                                              near.empty() ? "" : ", did you mean '" + near + "'?"));
}

bool DelimitedText::is_missing(std::size_t row, std::size_t column) const {
  const std::string word = lower(trimmed(text(row, column)));
  return word.empty() || word == "nan" || word == "na" || word == "n/a" || word == "-" || word == "--" ||
         word == "null";
}

double DelimitedText::number(std::size_t row, std::size_t column) const {
  double value = 0;
  const std::string& cell = rows_[row].cells[column];
  if (to_number(cell, format_.decimal, value)) return value;
  throw InputError({file_, rows_[row].line, 0},
                   fmt::format("{} is '{}', not a finite number{}", name(column), cell.substr(0, 40),
                               is_number(cell) ? fmt::format(" with a decimal {}",
                                                             format_.decimal == ',' ? "comma" : "point")
                                               : ""));
}

}  // namespace understudy::calibration
