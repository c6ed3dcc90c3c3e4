#include "calibration/gap_sensor/gap_picture_table.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/number_table.h"
#include "core/file/read_file.h"
#include "core/units.h"

namespace understudy::calibration {
namespace {

using Words = std::vector<std::string>;

struct Column {
  const char* name;
  double low, high;  ///< as the file has it
};
constexpr Column kHeight{"height_mm", -50, 50}, kHeightSigma{"height_sigma_um", 0, 1000},
    kGap{"gap_mm", 0, 5}, kGapSigma{"gap_sigma_um", 0.1, 1000}, kTilt{"tilt_deg", 0, 45},
    kAzimuth{"azimuth_deg", -360, 360};
constexpr const char* kPicture = "picture";
constexpr double kSameHeight = 1e-6;                         // [m]
constexpr double kGapLowest = -0.02e-3, kGapHighest = 8e-3;  // [m], that a height may be

bool contains(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void check_header(const Words& header, const Place& place) {
  const Words known{kHeight.name,      kPicture,   kGap.name,    kGapSigma.name,
                    kHeightSigma.name, kTilt.name, kAzimuth.name};
  check_header_words(header, known, place);
  for (const char* required : {kHeight.name, kPicture, kGap.name, kGapSigma.name})
    if (!contains(header, required)) throw InputError(place, fmt::format("missing column {}", required));
  if (contains(header, kTilt.name) != contains(header, kAzimuth.name))
    throw InputError(place, fmt::format("{} and {} need each other", kTilt.name, kAzimuth.name));
}

/// One row by the names of its columns.
class Row {
 public:
  Row(const std::string& file, const Words& header, const TextRow& row) : place_{file, row.line, 0} {
    if (row.cells.size() != header.size())
      throw InputError(place_, fmt::format("{} cells, not {}", row.cells.size(), header.size()));
    for (std::size_t i = 0; i < header.size(); ++i) cells_[header[i]] = row.cells[i];
  }
  const Place& place() const { return place_; }
  std::string text(const std::string& column) const {
    const auto found = cells_.find(column);
    return found == cells_.end() ? "" : found->second.text;
  }
  double number(const Column& column) const {
    const TextRow::Cell& cell = cells_.at(column.name);
    const Place place{place_.file, place_.line, cell.column};
    const double value = table_number(cell, column.name, place);
    if (value < column.low || value > column.high)
      throw InputError(place, fmt::format("{} is {:g}, outside {:g} to {:g}", column.name, value, column.low,
                                          column.high));
    return value;
  }
  /// 0 where the column or the cell is empty.
  double optional_number(const Column& column) const {
    return text(column.name).empty() ? 0 : number(column);
  }

 private:
  Place place_;
  std::map<std::string, TextRow::Cell> cells_;
};

/// The flat's surface normal leans by the tilt from the tool axis, towards the azimuth.
Vec2 slope_of(const Row& row) {
  const double tilt = from_deg(row.optional_number(kTilt)), azimuth = from_deg(row.optional_number(kAzimuth));
  return -std::tan(tilt) * Vec2(std::cos(azimuth), std::sin(azimuth));
}

/// What rows before have told.
struct Seen {
  std::map<std::pair<double, double>, int> flats;  // by slope
  std::map<std::string, int> lines;                // by picture
};

int flat_of(const Vec2& slope, Seen& seen, std::vector<Vec2>& slopes) {
  const auto [flat, is_new] =
      seen.flats.emplace(std::pair(slope.x(), slope.y()), static_cast<int>(slopes.size()));
  if (is_new) slopes.push_back(slope);
  return flat->second;
}

void read_row(const Row& row, Seen& seen, GapPictureTable& table) {
  GapPicture shot;
  shot.line = row.place().line;
  shot.height = from_mm(row.number(kHeight));
  shot.height_sigma = kMicrometre * row.optional_number(kHeightSigma);
  shot.flat = flat_of(slope_of(row), seen, table.slopes);
  shot.picture = row.text(kPicture);
  const bool gap = !row.text(kGap.name).empty();
  if (gap != !row.text(kGapSigma.name).empty())
    throw InputError(row.place(), fmt::format("{} and {} need each other", kGap.name, kGapSigma.name));
  if (gap)
    table.known.push_back(
        {shot.flat, shot.height, from_mm(row.number(kGap)), kMicrometre * row.number(kGapSigma)});
  if (shot.picture.empty() && !gap) throw InputError(row.place(), "has neither a picture nor a gap_mm");
  if (!shot.picture.empty()) {
    const auto [other, is_new] = seen.lines.emplace(shot.picture, shot.line);
    if (!is_new)
      throw InputError(row.place(),
                       fmt::format("picture '{}' is that of line {}, too", shot.picture, other->second));
    shot.file = (std::filesystem::path(table.file).parent_path() / shot.picture).string();
  }
  table.rows.push_back(shot);
}

/// By the known gaps, every picture of their flats is where the sensor can read.
void check_gaps(const GapPictureTable& table) {
  std::vector<std::pair<double, double>> heights(table.slopes.size(), {1e9, -1e9});  // lowest and highest
  for (const GapPicture& row : table.rows) {
    auto& [lowest, highest] = heights[static_cast<std::size_t>(row.flat)];
    lowest = std::min(lowest, row.height);
    highest = std::max(highest, row.height);
  }
  for (const KnownGap& known : table.known) {
    const auto& [lowest, highest] = heights[static_cast<std::size_t>(known.flat)];
    const auto fits = [&](double height) {
      const double gap = height - known.height + known.gap;
      return gap >= kGapLowest && gap <= kGapHighest;
    };
    if (fits(lowest) && fits(highest)) continue;
    for (const GapPicture& row : table.rows) {
      const double gap = row.height - known.height + known.gap;
      if (row.flat != known.flat || (gap >= kGapLowest && gap <= kGapHighest)) continue;
      throw InputError(
          {table.file, row.line, 0},
          fmt::format("height_mm is {:g}: by the known gap of {:g} mm at {:g} mm that is a gap of "
                      "{:.3f} mm, outside {:g} to {:g} mm",
                      to_mm(row.height), to_mm(known.gap), to_mm(known.height), to_mm(gap), to_mm(kGapLowest),
                      to_mm(kGapHighest)));
    }
  }
}

}  // namespace

HeightSpread height_spread(const std::vector<GapPicture>& rows) {
  std::map<int, std::vector<double>> heights;
  for (const GapPicture& row : rows)
    if (!row.picture.empty()) heights[row.flat].push_back(row.height);
  HeightSpread best;
  for (auto& [flat, list] : heights) {
    std::sort(list.begin(), list.end());
    const double spread = list.back() - list.front();
    list.erase(std::unique(list.begin(), list.end(), [](double a, double b) { return b - a < kSameHeight; }),
               list.end());
    const int count = static_cast<int>(list.size());
    if (count > best.heights || (count == best.heights && spread > best.spread)) best = {count, spread};
  }
  return best;
}

void require_heights(const std::vector<GapPicture>& rows, const std::string& file, const std::string& of) {
  const HeightSpread found = height_spread(rows);
  if (found.heights < kHeightsNeeded)
    throw InputError({file, 0, 0}, fmt::format("{} at {} heights over one flat, at least {} are needed", of,
                                               found.heights, kHeightsNeeded));
  if (found.spread < kSpreadNeeded)
    throw InputError({file, 0, 0},
                     fmt::format("the heights of the {} spread over {:.3f} mm, at least {:g} mm "
                                 "are needed",
                                 of, to_mm(found.spread), to_mm(kSpreadNeeded)));
}

GapPictureTable read_gap_pictures(const std::string& file) {
  GapPictureTable table;
  const std::string text = read_file(file);
  table.file = file;
  table.sha256 = sha256_hex(text);
  std::istringstream in(text);
  TextRow row;
  if (!read_text_row(in, row))
    throw InputError({file, 0, 0},
                     "is empty; its first line names the columns (docs/gap-sensor-calibration.md)");
  Words header;
  for (const TextRow::Cell& cell : row.cells) header.push_back(cell.text);
  check_header(header, {file, row.line, 0});
  Seen seen;
  while (read_text_row(in, row)) read_row(Row(file, header, row), seen, table);
  require_heights(table.rows, file, "pictures");
  if (table.known.empty())
    throw InputError({file, 0, 0}, "no row has a gap_mm: at least one gap must be known");
  check_gaps(table);
  return table;
}

}  // namespace understudy::calibration
