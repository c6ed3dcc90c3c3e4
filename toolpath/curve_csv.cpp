#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/output_file.h"
#include "core/units.h"
#include "toolpath/surface_planner.h"

namespace understudy::toolpath {
namespace {

constexpr std::string_view kHeader = "x_mm,y_mm,z_mm";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

double coordinate(std::string_view field, const Place& place, const char* name) {
  const std::string_view text = trimmed(field);
  const std::size_t sign = text.starts_with('+');
  double value = 0;
  const auto [end, error] = std::from_chars(text.data() + sign, text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw InputError(place, fmt::format("{} is '{}', not a finite number", name, text.substr(0, 40)));
  return from_mm(value);
}

Vec3 row(std::string_view line, const std::string& file, int line_number) {
  constexpr const char* kNames[] = {"x_mm", "y_mm", "z_mm"};
  Vec3 point;
  std::size_t start = 0;
  for (int i = 0; i < 3; ++i) {
    const Place place{file, line_number, static_cast<int>(start) + 1};
    const std::size_t comma = line.find(',', start);
    if ((comma == std::string_view::npos) != (i == 2))
      throw InputError(place, fmt::format("'{}' needs 3 numbers: {}", line.substr(0, 60), kHeader));
    point[i] = coordinate(line.substr(start, comma - start), place, kNames[i]);
    start = comma + 1;
  }
  return point;
}

}  // namespace

std::vector<Vec3> read_curve_csv(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  const std::string file = path.string();
  std::vector<Vec3> curve;
  bool header_seen = false;
  std::string_view rest = text;
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = trimmed(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line.empty()) continue;
    if (header_seen) {
      curve.push_back(row(line, file, line_number));
    } else if (line != kHeader) {
      throw InputError({file, line_number, 1},
                       fmt::format("the header is '{}', it must be '{}'", line.substr(0, 60), kHeader));
    }
    header_seen = true;
  }
  if (curve.size() < 2)
    throw InputError(Place{file}, fmt::format("{} points, a curve needs 2", curve.size()));
  return curve;
}

}  // namespace understudy::toolpath
