#include "toolpath/planners/waypoints.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::size_t kColumns = 6;
constexpr double kFarthestWaypoint = 100;  // [m], what a program can say (docs/limits.md)

double number(std::string_view word, const Place& place) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
    throw InputError(place, fmt::format("'{}' is not a finite number", word));
  return value;
}

Waypoint waypoint(std::string_view row, Place place) {
  std::vector<double> values;
  std::size_t at = row.find_first_not_of(kBlanks);
  while (at != std::string_view::npos) {
    const std::size_t end = std::min(row.find_first_of(kBlanks, at), row.size());
    place.column = static_cast<int>(at) + 1;
    values.push_back(number(row.substr(at, end - at), place));
    if (values.size() <= 3 && std::abs(values.back()) > to_mm(kFarthestWaypoint))
      throw InputError(place, fmt::format("{} mm is beyond {:.6g} mm", row.substr(at, end - at),
                                          to_mm(kFarthestWaypoint)));
    at = row.find_first_not_of(kBlanks, end);
  }
  place.column = 0;
  if (values.size() != kColumns)
    throw InputError(place, fmt::format("{} numbers in the row, a waypoint has {}: x y z nx ny nz",
                                        values.size(), kColumns));
  const Vec3 normal(values[3], values[4], values[5]);
  if (std::abs(normal.norm() - 1) > kNormalTolerance)
    throw InputError(place, fmt::format("the normal's length is {:.6f}, more than {:g} from 1", normal.norm(),
                                        kNormalTolerance));
  return {kMillimetre * Vec3(values[0], values[1], values[2]), normal.normalized()};
}

}  // namespace

WaypointLayer parse_waypoints(const std::string& text, const std::string& file) {
  WaypointLayer layer;
  Place place{file};
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view row = std::string_view(text).substr(at, end - at);
    const std::size_t first = row.find_first_not_of(kBlanks);
    ++place.line;
    if (first != std::string_view::npos && row[first] != '#') layer.push_back(waypoint(row, place));
    at = end + 1;
  }
  if (layer.size() < 2)
    throw InputError(Place{file}, fmt::format("{} waypoints, a layer needs 2", layer.size()));
  return layer;
}

WaypointLayer read_waypoints(const std::filesystem::path& path) {
  return parse_waypoints(read_file(path), path.string());
}

void turn(std::vector<WaypointLayer>& layers, const WaypointFrame& frame) {
  const Mat3 R_WF = shortest_arc_from_z(frame.up).toRotationMatrix().transpose();
  for (WaypointLayer& layer : layers)
    for (Waypoint& w : layer) {
      w.position = R_WF * w.position;
      w.normal = (frame.flip_normals ? -1.0 : 1.0) * (R_WF * w.normal);
    }
}

void place_on(std::vector<WaypointLayer>& layers, const Vec3& place) {
  Eigen::AlignedBox3d box;
  for (const WaypointLayer& layer : layers)
    for (const Waypoint& w : layer) box.extend(w.position);
  if (box.isEmpty()) return;
  const Vec3 bottom(box.center().x(), box.center().y(), box.min().z());
  for (WaypointLayer& layer : layers)
    for (Waypoint& w : layer) w.position += place - bottom;
}

}  // namespace understudy::toolpath
