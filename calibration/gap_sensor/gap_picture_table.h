// The table that a gap sensor is calibrated with: pictures of the dot at heights over flats
// (docs/gap-sensor-calibration.md).
#pragma once

#include <string>
#include <vector>

#include "calibration/gap_sensor/gap_sensor_fit.h"

namespace understudy::calibration {

/// One line: a picture, a known gap, or both.
struct GapPicture {
  int line = 0;
  int flat = 0;             ///< index into GapPictureTable::slopes
  double height = 0;        ///< [m]
  double height_sigma = 0;  ///< [m]
  std::string picture;      ///< as the table names it; empty: none
  std::string file;         ///< the same beside the table
};

struct GapPictureTable {
  std::string file;    ///< as it was named
  std::string sha256;  ///< of its bytes, hexadecimal
  std::vector<GapPicture> rows;
  std::vector<Vec2> slopes;     ///< of the flats: as Flat::slope
  std::vector<KnownGap> known;  ///< of all flats
};

/// Heights over one flat that a calibration needs, and how far apart at least.
constexpr int kHeightsNeeded = 5;
constexpr double kSpreadNeeded = 0.5e-3;  // [m]

/// Throws InputError with file, line, value and limit: columns that are missing, unknown or given in part,
/// numbers that are none or out of range, a picture that is named twice, a row with neither picture nor gap,
/// no known gap, known gaps that heights put out of range, too few heights, heights without spread.
GapPictureTable read_gap_pictures(const std::string& file);

/// The distinct heights of pictures over the flat that has most of them, and their spread [m].
struct HeightSpread {
  int heights = 0;
  double spread = 0;
};
HeightSpread height_spread(const std::vector<GapPicture>& rows);

/// Throws InputError naming `file` unless the rows with a picture have enough of both; `of` says what they
/// are: "pictures", "pictures with a dot".
void require_heights(const std::vector<GapPicture>& rows, const std::string& file, const std::string& of);

}  // namespace understudy::calibration
