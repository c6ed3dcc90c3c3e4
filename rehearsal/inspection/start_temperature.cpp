#include "rehearsal/inspection/start_temperature.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "core/text/take_line.h"
#include "rehearsal/program/told_process.h"
#include "toolpath/gcode/words/gcode_words.h"

namespace understudy::rehearsal {
namespace {

constexpr double kColdest = 100, kWarmest = 450;  // [C], of nozzles that print
constexpr std::string_view kOfNozzles[] = {"EXTRUDER", "HOTEND", "NOZZLE", "TOOL"};

bool of_nozzle(const std::string& key) {
  return key == "TEMP" || key == "TEMPERATURE" ||
         std::any_of(std::begin(kOfNozzles), std::end(kOfNozzles),
                     [&](std::string_view part) { return key.find(part) != std::string::npos; });
}

std::optional<double> nozzle_temperature(double value) {
  return value >= kColdest && value <= kWarmest ? std::optional(value) : std::nullopt;
}

/// The first of NAME=number that is a nozzle's.
std::optional<double> parameter_of(std::string_view line) {
  for (std::size_t at = line.find('='); at != std::string_view::npos; at = line.find('=', at + 1)) {
    std::string key;
    for (std::size_t i = at;
         i > 0 && (std::isalnum(static_cast<unsigned char>(line[i - 1])) || line[i - 1] == '_'); --i)
      key.insert(key.begin(), static_cast<char>(std::toupper(static_cast<unsigned char>(line[i - 1]))));
    double value = 0;
    const std::string_view number = line.substr(at + 1);
    if (std::from_chars(number.data(), number.data() + number.size(), value).ec != std::errc()) continue;
    if (of_nozzle(key))
      if (const auto temperature = nozzle_temperature(value)) return temperature;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> start_temperature(std::string_view text,
                                        const std::map<std::string, std::string>& facts) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (toolpath::command_in_words(line).empty()) continue;
    if (const auto temperature = parameter_of(line.substr(0, line.find(';')))) return temperature;
  }
  for (const char* key : {"first_layer_temperature", "temperature"})
    if (const auto said = fact_number(facts, key); said && nozzle_temperature(*said)) return said;
  return std::nullopt;
}

}  // namespace understudy::rehearsal
