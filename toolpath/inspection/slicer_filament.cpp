#include "toolpath/inspection/slicer_filament.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "core/text/lower_case.h"
#include "core/text/trimmed.h"
#include "core/units.h"
#include "toolpath/inspection/comments.h"

namespace understudy::toolpath {
namespace {

constexpr std::string_view kWhole[] = {"filament used [mm]", "total filament length [mm]", "filament length",
                                       "filament used"};
constexpr std::string_view kOfOneExtruder[] = {"material#", "ext #"};

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
  std::optional<double> of_all, of_each;
  for_each_comment(text, [&](int, std::string_view comment) {
    if (of_all) return;
    comment.remove_prefix(std::min(comment.find_first_not_of(";- \t"), comment.size()));
    const std::string words = lower_case(comment);
    for (const std::string_view key : kWhole)
      if (!of_all) of_all = value_after(words, key);
    if (const auto one = of_one_extruder(words)) of_each = of_each.value_or(0) + *one;
  });
  const std::optional<double> told = of_all ? of_all : of_each;
  return told && *told > 0 ? told : std::nullopt;  // CuraEngine by itself writes 0m before it has sliced
}

}  // namespace understudy::toolpath
