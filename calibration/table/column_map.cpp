#include "calibration/table/column_map.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "core/yaml/yaml_map.h"

namespace understudy::calibration {
namespace {

double length_unit(YamlMap& map, const char* key = "unit") {
  const std::string unit = map.word(key, {"mm", "m", "um", "inch"}, "of lengths");
  if (unit == "m") return 1;
  return unit == "um" ? kMicrometre : unit == "inch" ? kInch : kMillimetre;
}

double angle_unit(YamlMap& map) {
  return map.word("unit", {"deg", "rad"}, "of angles") == "rad" ? 1 : kDegree;
}

void check_count(YamlMap& map, const std::vector<std::string>& columns, std::size_t count) {
  if (map.complete() && columns.size() != count)
    throw InputError(map.place("columns"),
                     fmt::format("{} names {} columns, not {}", map.path("columns"), columns.size(), count));
}

void read_sigma(YamlMap& map, NumberColumns& numbers) {
  numbers.sigma_unit = numbers.unit;
  if (map.has("sigma_coverage"))
    numbers.sigma_coverage =
        map.number("sigma_coverage", {0.1, 10}, "sigma that a number of sigma_columns is: 2 of U95");
  if (map.has("sigma_columns")) numbers.sigma = map.texts("sigma_columns", "1 sigma in the same unit");
  if (!numbers.sigma.empty() && numbers.sigma.size() != 1 && numbers.sigma.size() != 3)
    throw InputError(
        map.place("sigma_columns"),
        fmt::format("{} names {} columns, not 1 or 3", map.path("sigma_columns"), numbers.sigma.size()));
}

void read_format(YamlMap& map, TextFormat& format) {
  if (map.has("separator")) {
    const std::string word = map.word("separator", {"comma", "semicolon", "tab", "space"}, "between cells");
    format.separator = word == "comma" ? ',' : word == "semicolon" ? ';' : word == "tab" ? '\t' : ' ';
  }
  if (map.has("decimal"))
    format.decimal = map.word("decimal", {"point", "comma"}, "before decimals") == "comma" ? ',' : '.';
  if (map.has("header"))
    format.header = map.word("header", {"yes", "no"}, "a line with names") == "yes" ? 1 : 0;
  if (map.has("comment")) format.comment = map.text("comment", "lines that begin so are passed over");
  if (map.has("skip_lines")) format.skip_lines = map.integer("skip_lines", 0, 100000, "at the beginning");
}

void read_joints(YamlMap& map, TableMap& table) {
  table.joints.columns = map.texts("columns", "one for each axis, in the machine's order");
  table.joint_unit_told = map.has("unit");
  if (table.joint_unit_told) table.joints.unit = angle_unit(map);
  table.slide_unit_told = map.has("slide_unit");
  if (table.slide_unit_told) table.slide_unit = length_unit(map, "slide_unit");
  const std::size_t axes = table.joints.columns.size();
  if (map.has("signs")) {
    table.joint_signs = map.numbers("signs", axes, {-1, 1}, "1, or -1 of an axis that counts the other way");
    for (const double sign : table.joint_signs)
      if (map.complete() && std::abs(sign) != 1) map.fail("signs", "are 1 or -1");
  }
  if (map.has("offsets"))
    table.joint_offsets =
        map.numbers("offsets", axes, {-10000, 10000}, "added behind the signs, in the columns' units");
  table.joint_format = table.format;
  if (!map.has("file")) return;
  table.joint_file = map.text("file", "with the joints of each row, in the same order");
  table.joint_format = TextFormat{};
  read_format(map, table.joint_format);
}

void read_orientation(YamlMap& map, TableMap& table) {
  NumberColumns& numbers = table.orientation.emplace();
  const std::string form =
      map.word("form", {"quaternion", "euler", "rotation_vector", "matrix"}, "how it is written");
  OrientationReading& reading = table.reading;
  reading.form = form == "euler"             ? OrientationForm::euler
                 : form == "rotation_vector" ? OrientationForm::rotation_vector
                 : form == "matrix"          ? OrientationForm::matrix
                                             : OrientationForm::quaternion;
  numbers.columns = map.texts("columns", "in the order of `order`; of a matrix row by row");
  check_count(map, numbers.columns, numbers_of(reading.form));
  if (form == "quaternion") reading.order = map.word("order", {"wxyz", "xyzw"}, "of the columns");
  if (form == "euler") {
    reading.order = map.word(
        "order", {"xyz", "zyx", "zxz", "zyz", "xzy", "yxz", "yzx", "zxy", "xyx", "xzx", "yxy", "yzy"},
        "of the turns, first column first");
    reading.fixed =
        map.word("axes", {"fixed", "moving"}, "fixed: R = R3 R2 R1; moving: R = R1 R2 R3") == "fixed";
  }
  if (form == "euler" || form == "rotation_vector") {
    numbers.unit_told = map.has("unit");
    if (numbers.unit_told) numbers.unit = angle_unit(map);
  }
  read_sigma(map, numbers);
}

void read_lengths(YamlMap& map, std::optional<NumberColumns>& to, std::size_t count) {
  NumberColumns& numbers = to.emplace();
  numbers.columns = map.texts("columns", "of x, y, z, or of the distance");
  check_count(map, numbers.columns, count);
  numbers.unit_told = map.has("unit");
  if (numbers.unit_told) numbers.unit = length_unit(map);
  read_sigma(map, numbers);
}

RowKind read_kind(YamlMap& map) {
  const std::string kind = map.word("kind", {"pose", "position", "orientation", "distance", "point", "plane"},
                                    "what a row measures");
  for (const RowKind known :
       {RowKind::position, RowKind::orientation, RowKind::distance, RowKind::point, RowKind::plane})
    if (kind == to_string(known)) return known;
  return RowKind::pose;
}

void read_table(YamlMap& map, TableMap& table) {
  table.kind = read_kind(map);
  if (map.has("file")) table.file = map.text("file", "relative to this one");
  read_format(map, table.format);
  map.section("joints", "readings of the axes", [&](YamlMap& joints) { read_joints(joints, table); });
  if (table.kind == RowKind::pose || table.kind == RowKind::position)
    map.section("position", "of the target", [&](YamlMap& at) { read_lengths(at, table.position, 3); });
  if (table.kind == RowKind::pose || table.kind == RowKind::orientation)
    map.section("orientation", "of the target", [&](YamlMap& at) { read_orientation(at, table); });
  if (table.kind == RowKind::distance)
    map.section("distance", "from an anchor", [&](YamlMap& at) {
      read_lengths(at, table.distance, 1);
      if (at.has("zero"))
        table.zero_unknown = at.word("zero", {"known", "unknown"}, "of the device's readings") == "unknown";
    });
  if (table.orientation && map.has("seen_from"))
    table.inverse = map.word("seen_from", {"frame", "target"},
                             "target: the frame's pose as a camera on the tool sees it") == "target";
  const bool in_frame = table.position || table.orientation;
  table.frame = in_frame ? "device" : "";
  if (in_frame && map.has("frame")) table.frame = map.text("frame", "world, or the name of an unknown one");
  if (table.frame == "world") table.frame.clear();
  table.target = "target";
  if (map.has("target")) table.target = map.text("target", "tool, or what was measured on it");
  if (table.target == "tool") table.target.clear();
  if (map.has("target_column"))
    table.target_column = map.text("target_column", "names the target of each row");
  if (!in_frame && map.has("id")) table.id = map.text("id", "of the point, anchor or plane");
  if (!in_frame && map.has("id_column")) table.id_column = map.text("id_column", "the same, row by row");
  if (map.has("sigma_um"))
    table.sigma_position = map.quantity("sigma_um", {1e-3, 1e6}, "1 sigma on each axis");
  if (map.has("sigma_mrad"))
    table.sigma_turn = map.quantity("sigma_mrad", {1e-6, 1e4}, "1 sigma about each axis");
}

void read_places(YamlMap& root, const char* key, const char* about, std::vector<KnownPlace>& places) {
  if (!root.has(key)) return;
  root.list(key, 0, about, [&](YamlMap& map, std::size_t) {
    KnownPlace place;
    place.name = map.text("name", "as rows name it");
    place.position =
        map.vector("position_mm", {-100000, 100000}, "in W; of a target from the tool's tip, in T");
    places.push_back(place);
  });
}

void read_map(YamlMap& root, ColumnMap& map) {
  if (root.has("tables"))
    root.list("tables", 0, "each with a file", [&](YamlMap& table, std::size_t) {
      read_table(table, map.tables.emplace_back());
      if (table.complete() && map.tables.back().file.empty())
        throw InputError(table.place(), fmt::format("{} is missing: of several tables each names its file",
                                                    table.path("file")));
    });
  else
    read_table(root, map.tables.emplace_back());
  read_places(root, "targets", "whose places on the tool are known", map.targets);
  read_places(root, "points", "that are known", map.points);
  read_places(root, "anchors", "that are known", map.anchors);
  if (root.has("distances"))
    root.list("distances", 0, "between points", [&](YamlMap& item, std::size_t) {
      const auto between = item.texts("between", "two points");
      if (item.complete() && between.size() != 2)
        throw InputError(item.place("between"),
                         fmt::format("{} names {} points, not 2", item.path("between"), between.size()));
      KnownDistance distance;
      distance.length = item.quantity("length_mm", {1e-3, 100000}, "from one to the other");
      distance.sigma = item.quantity("sigma_um", {1e-3, 1e6}, "1 sigma of it");
      if (!item.complete()) return;
      distance.a = between[0];
      distance.b = between[1];
      map.distances.push_back(distance);
    });
}

}  // namespace

ColumnMap read_column_map(const std::string& file) {
  ColumnMap map;
  map.file = file;
  YamlMap::read_text(read_file(file), file, [&](YamlMap& root) { read_map(root, map); });
  return map;
}

MapSchema column_map_schema() {
  return YamlMap::schema([](YamlMap& root) {
    ColumnMap map;
    read_map(root, map);
  });
}

}  // namespace understudy::calibration
