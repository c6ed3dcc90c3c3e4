#include "toolpath/inspection/slicer_filament.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>

#include "core/text/trimmed.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr std::string_view kWhole[] = {"filament used [mm]", "total filament length [mm]", "filament length",
                                       "filament used"};
constexpr std::string_view kOfOneExtruder[] = {"material#", "ext #"};

std::string small(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// [m], of "264.59, 0.00" mm, "1.67714m" or "332.4mm (2.3cm3)"; nothing for what begins with no number.
std::optional<double> written_lengths(std::string_view text) {
  std::optional<double> sum;
  while (true) {
    text = trimmed(text);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || !std::isfinite(number) || number < 0) return sum;
    text = trimmed(text.substr(static_cast<std::size_t>(end - text.data())));
    const bool metres = text.starts_with('m') && !text.starts_with("mm");
    sum = sum.value_or(0) + (metres ? number : from_mm(number));
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos || text.find('(') < comma) return sum;
    text.remove_prefix(comma + 1);
  }
}

/// What follows `key` and a colon or an equals sign.
std::optional<double> value_after(std::string_view line, std::string_view key) {
  if (!line.starts_with(key)) return std::nullopt;
  line = trimmed(line.substr(key.size()));
  if (line.empty() || (line[0] != ':' && line[0] != '=')) return std::nullopt;
  return written_lengths(line.substr(1));
}

/// "material#1 used: 422.7", "ext #1 = 306.1 mm (0.7 cm^3)".
std::optional<double> of_one_extruder(std::string_view line) {
  for (const std::string_view key : kOfOneExtruder) {
    if (!line.starts_with(key)) continue;
    const std::size_t end = line.find_first_of(":=");
    const std::string_view name = line.substr(0, end);
    const bool of_length = key[0] == 'e' || trimmed(name).ends_with("used");
    if (end != std::string_view::npos && of_length) return written_lengths(line.substr(end + 1));
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> told_filament(std::string_view text) {
  std::optional<double> of_each;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view comment = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (!comment.starts_with(';')) continue;
    comment.remove_prefix(std::min(comment.find_first_not_of(";- \t"), comment.size()));
    const std::string line = small(comment);
    for (const std::string_view key : kWhole)
      if (const auto whole = value_after(line, key)) return whole;
    if (const auto one = of_one_extruder(line)) of_each = of_each.value_or(0) + *one;
  }
  return of_each;
}

}  // namespace understudy::toolpath
