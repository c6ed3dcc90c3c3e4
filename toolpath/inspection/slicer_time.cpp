#include "toolpath/inspection/slicer_time.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/text/trimmed.h"

namespace understudy::toolpath {
namespace {

/// [s]; 0: no unit of time.
double unit_of(std::string_view word) {
  if (word == "d" || word.starts_with("day")) return 86400;
  if (word == "h" || word.starts_with("hour")) return 3600;
  if (word == "m" || word.starts_with("min")) return 60;
  if (word.empty() || word == "s" || word.starts_with("sec")) return 1;
  return 0;
}

}  // namespace

std::optional<double> written_time(std::string_view text) {
  text = trimmed(text);
  if (text.empty()) return std::nullopt;
  double seconds = 0;
  while (!text.empty()) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || !(number >= 0) || !std::isfinite(number)) return std::nullopt;
    text = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
    const std::size_t letters = std::min(text.find_first_not_of("abcdefghijklmnopqrstuvwxyz"), text.size());
    const double unit = unit_of(text.substr(0, letters));
    if (unit == 0) return std::nullopt;
    seconds += number * unit;
    text = trimmed(text.substr(letters));
  }
  return seconds;
}

}  // namespace understudy::toolpath
