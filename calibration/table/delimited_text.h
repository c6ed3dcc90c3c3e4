// Tables of text as devices and spreadsheets write them: any separator, with or without a header, comma or
// point before the decimals.
#pragma once

#include <string>
#include <vector>

namespace understudy::calibration {

struct TextFormat {
  char separator = '\0';      ///< , ; tab or a space (any number of them); '\0': found
  char decimal = '\0';        ///< . or ,; '\0': found
  int header = -1;            ///< 1: the first line names the columns; 0: none does; -1: found
  std::string comment = "#";  ///< lines that begin so are passed over; empty: none
  int skip_lines = 0;         ///< at the beginning
};

class DelimitedText {
 public:
  /// A first line "sep=;", as spreadsheets write it, tells the separator. Throws InputError with `file` and
  /// line for lines of different length, for a text without rows, and for one in UTF-16.
  DelimitedText(const std::string& text, const std::string& file, const TextFormat& format);

  const std::string& file() const { return file_; }
  std::size_t rows() const { return rows_.size(); }
  std::size_t columns() const { return columns_; }
  int line(std::size_t row) const { return rows_[row].line; }
  const std::vector<std::string>& header() const { return header_; }  ///< empty: none

  /// Index of a column by its name in the header, with or without the unit behind it, or by its number
  /// from 1. Throws InputError that names the nearest one.
  std::size_t column(const std::string& name_or_number) const;
  const std::string& text(std::size_t row, std::size_t column) const { return rows_[row].cells[column]; }
  /// An empty cell, or one that says that it has no number: nan, NA, -, --, null.
  bool is_missing(std::size_t row, std::size_t column) const;
  /// Throws InputError with line, column and cell unless it is a finite number.
  double number(std::size_t row, std::size_t column) const;

 private:
  struct Row {
    int line = 0;
    std::vector<std::string> cells;
  };
  void find_decimal();
  std::string name(std::size_t column) const;

  std::string file_;
  TextFormat format_;
  std::vector<std::string> header_;
  std::vector<Row> rows_;
  std::size_t columns_ = 0;
};

}  // namespace understudy::calibration
