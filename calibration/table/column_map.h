// How the columns of somebody's tables are to be read: the YAML of docs/measurements.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/rows/measurement_row.h"
#include "calibration/table/delimited_text.h"
#include "calibration/table/measured_orientation.h"
#include "core/yaml/map_schema.h"

namespace understudy::calibration {

struct NumberColumns {
  std::vector<std::string> columns;
  double unit = 1;                 ///< [m] or [rad] of one
  bool unit_told = true;           ///< else the columns' headers tell it: "X [mm]"
  std::vector<std::string> sigma;  ///< columns of 1 sigma: one, or one each; empty: none
  double sigma_unit = 1;           ///< [m] or [rad] of one of these, where their headers tell none
  double sigma_coverage = 1;       ///< how many sigma one of these numbers is: 2 of U95
};

struct TextOfFile {
  std::string file, text;
};

/// One table, or several that look alike.
struct TableMap {
  std::string file;  ///< as the map names it, relative to the map's folder; empty: told elsewhere
  std::optional<TextOfFile> read = {};  ///< a table that was read already: a pipe can be read once
  RowKind kind = RowKind::pose;
  TextFormat format;
  NumberColumns joints;
  bool joint_unit_told = false;  ///< of angles; else it is recognised
  /// The machine's reading is sign * number + offset, in the joints' units; empty: as they stand.
  std::vector<double> joint_signs, joint_offsets;
  double slide_unit = 1e-3;  ///< [m] of one, of sliding axes and struts
  bool slide_unit_told = false;
  std::string joint_file;  ///< where the joints stand in a file of their own, by row number
  TextFormat joint_format;
  std::optional<NumberColumns> position, distance, orientation;
  OrientationReading reading;
  bool inverse = false;  ///< poses and orientations are those of the frame, seen from the target
  std::string frame;     ///< empty: the machine's own, W
  std::string target;    ///< empty: the machine's tool
  std::string target_column, id, id_column;
  double sigma_position = 0, sigma_turn = 0;  ///< [m], [rad], of every row; 0: not told
  bool zero_unknown = false;                  ///< of distances
};

struct KnownPlace {
  std::string name;
  Vec3 position{0, 0, 0};  ///< [m], in W; of a target in T
};

struct ColumnMap {
  std::string file;
  std::vector<TableMap> tables;
  std::vector<KnownPlace> targets, points, anchors;
  std::vector<KnownDistance> distances;
};

/// Throws InputError with file, line and key.
ColumnMap read_column_map(const std::string& file);
MapSchema column_map_schema();

}  // namespace understudy::calibration
