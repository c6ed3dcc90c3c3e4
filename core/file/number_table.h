// Tables of numbers in CSV, as poses, axes and curves come in.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "core/error.h"

namespace understudy {

/// A line of a table in CSV that is neither empty nor a comment.
struct TextRow {
  struct Cell {
    std::string text;  ///< without spaces around it
    int column = 0;    ///< where it begins in its line, from 1
  };
  int line = 0;
  std::vector<Cell> cells;
};

/// The next row, whatever its cells are; `row` holds the one before, or none yet. False: the table ends.
/// Empty lines and lines that begin with # are passed over.
bool read_text_row(std::istream& in, TextRow& row);

/// Throws InputError at `place`, the header's, for a word that is not known, with the nearest one that is,
/// and for one that stands twice.
void check_header_words(const std::vector<std::string>& header, const std::vector<std::string>& known,
                        const Place& place);

/// Throws InputError at `place`, calling it `name`, unless the cell is a finite number.
double table_number(const TextRow::Cell& cell, const std::string& name, const Place& place);

struct NumberRow {
  int line = 0;
  std::vector<double> values;
};

/// Reads a CSV whose first line is exactly `header` (words separated by commas, spaces ignored). Empty lines
/// and lines that begin with # are passed over. Throws InputError with `name`, line and column for a missing
/// or different header, a wrong number of cells, and cells that are not finite numbers.
std::vector<NumberRow> read_number_table(std::istream& in, const std::string& name,
                                         const std::vector<std::string>& header);

}  // namespace understudy
