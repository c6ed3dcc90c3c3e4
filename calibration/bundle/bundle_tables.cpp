#include "calibration/bundle/bundle_tables.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file/number_table.h"
#include "core/file/read_file.h"

namespace understudy::calibration {
namespace {

using Words = std::vector<std::string>;

/// A table whose column `picture` is text and all others numbers.
class PictureTable {
 public:
  PictureTable(const std::string& file, const Words& columns)
      : file_(file), columns_(columns), in_(read_file(file)) {
    if (!read_text_row(in_, row_))
      throw InputError({file, 0, 0}, "is empty; its first line names the columns " + joined());
    Words header;
    for (const TextRow::Cell& cell : row_.cells) header.push_back(cell.text);
    check_header_words(header, columns, place());
    for (const std::string& column : columns) {
      const auto at = std::find(header.begin(), header.end(), column);
      if (at == header.end())
        throw InputError(place(), "column " + column + " is missing; known: " + joined());
      at_[column] = static_cast<std::size_t>(at - header.begin());
    }
  }

  bool next() {
    if (!read_text_row(in_, row_)) return false;
    join_quoted();
    if (row_.cells.size() != at_.size())
      throw InputError(place(), fmt::format("has {} cells, the header {}", row_.cells.size(), at_.size()));
    return true;
  }
  double number(const std::string& column) const {
    return table_number(row_.cells[at_.at(column)], column, place());
  }
  int whole(const std::string& column, int low, int high) const {
    const double value = number(column);
    if (value != std::floor(value) || value < low || value > high)
      throw InputError(place(),
                       fmt::format("{} is {:g}, must be a whole number in {}..{}", column, value, low, high));
    return static_cast<int>(value);
  }
  Place place() const { return {file_, row_.line, 0}; }

 private:
  /// A file's name in quotes may have commas (RFC 4180).
  void join_quoted() {
    for (std::size_t i = 0; i < row_.cells.size(); ++i) {
      std::string& text = row_.cells[i].text;
      while (text.starts_with('"') && (text.size() == 1 || !text.ends_with('"')) &&
             i + 1 < row_.cells.size()) {
        text += ',' + row_.cells[i + 1].text;
        row_.cells.erase(row_.cells.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      }
    }
  }
  std::string joined() const { return fmt::format("{}", fmt::join(columns_, " ")); }

  std::string file_;
  Words columns_;
  std::istringstream in_;
  TextRow row_;
  std::map<std::string, std::size_t> at_;
};

}  // namespace

std::vector<vision::SeenBoard> read_corners(const std::string& file, const vision::CalibrationRig& rig) {
  PictureTable table(file, {"picture", "camera", "layer", "column", "row", "u_px", "v_px", "sigma_px"});
  std::map<std::pair<int, int>, vision::SeenBoard> boards;
  std::map<std::pair<int, int>, std::set<int>> seen;
  while (table.next()) {
    const int camera = table.whole("camera", 0, 1), layer = table.whole("layer", 0, rig.layers - 1);
    const int corner = table.whole("row", 0, rig.board.rows - 1) * rig.board.columns +
                       table.whole("column", 0, rig.board.columns - 1);
    const std::pair key(camera, layer);
    vision::SeenBoard& board = boards[key];
    board.camera = camera, board.layer = layer;
    board.corners_px.resize(static_cast<std::size_t>(rig.board.corners()));
    if (!seen[key].insert(corner).second)
      throw InputError(table.place(),
                       fmt::format("camera {}, layer {}: a corner is given twice", camera, layer));
    board.corners_px[static_cast<std::size_t>(corner)] = {table.number("u_px"), table.number("v_px")};
  }
  std::vector<vision::SeenBoard> all;
  for (auto& [key, board] : boards) {
    if (const auto count = static_cast<int>(seen[key].size()); count != rig.board.corners())
      throw InputError({file, 0, 0}, fmt::format("camera {}, layer {}: {} corners of {}", key.first,
                                                 key.second, count, rig.board.corners()));
    all.push_back(std::move(board));
  }
  return all;
}

std::vector<PoseTargets> read_targets(const std::string& file) {
  constexpr int kMostPoses = 1'000'000;
  PictureTable table(file, {"picture", "pose", "camera", "target", "u_px", "v_px", "c11_px2", "c12_px2",
                            "c22_px2", "radius_px"});
  std::map<int, PoseTargets> poses;
  std::set<std::array<int, 3>> seen;
  while (table.next()) {
    const int pose = table.whole("pose", 1, kMostPoses), camera = table.whole("camera", 0, 1),
              target = table.whole("target", 0, 2);
    if (!seen.insert({pose, camera, target}).second)
      throw InputError(table.place(),
                       fmt::format("pose {}, camera {}: target {} is given twice", pose, camera, target));
    PoseTargets& own = poses[pose];
    if (own.line == 0) own.line = table.place().line;
    own.pose = pose;
    ++own.found;
    vision::PixelPoint& point =
        own.targets[static_cast<std::size_t>(camera)][static_cast<std::size_t>(target)];
    point.pixel = {table.number("u_px"), table.number("v_px")};
    // Read before they are put in: a matrix that is filled in part ends a program with assertions.
    const double c11 = table.number("c11_px2"), c12 = table.number("c12_px2"), c22 = table.number("c22_px2");
    point.covariance << c11, c12, c12, c22;
    if (!(point.covariance(0, 0) > 0) || !(point.covariance.determinant() > 0))
      throw InputError(table.place(), "the covariance c11_px2, c12_px2, c22_px2 is not positive definite");
  }
  std::vector<PoseTargets> all;
  all.reserve(poses.size());
  for (auto& [number, pose] : poses) all.push_back(pose);
  return all;
}

}  // namespace understudy::calibration
