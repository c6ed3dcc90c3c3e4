#include "rehearsal/inspection/inspect.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "machine/description.h"
#include "rehearsal/rotary_words.h"

namespace understudy::rehearsal {
namespace {

constexpr double kMostOffTable = 0.2e-3;  // [m], by which the first layer may lie under the table
constexpr double kDefaultLayer = 0.2e-3;  // [m], where a program does not tell
constexpr double kWarmest = 450;          // [C]

/// The number that a comment begins with; a slicer of several extruders lists one for each.
std::optional<double> number_of(const std::map<std::string, std::string>& facts, const std::string& key) {
  const auto found = facts.find(key);
  if (found == facts.end()) return std::nullopt;
  double value = 0;
  const std::string& text = found->second;
  return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc() &&
                 std::isfinite(value)
             ? std::optional(value)
             : std::nullopt;
}

/// Whether a line has a word of one of these letters with a number, outside of comments.
bool has_word(std::string_view text, const std::string& letters) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line = line.substr(0, line.find_first_of(";("));
    if (!line.starts_with('G') && !line.starts_with('g') && !line.starts_with('N')) continue;
    for (std::size_t i = 0; i + 1 < line.size(); ++i)
      if (letters.find(line[i]) != std::string::npos &&
          std::string_view("0123456789.-+").find(line[i + 1]) != std::string_view::npos)
        return true;
  }
  return false;
}

/// G and M words, and a firmware's commands in words; a parameter cannot be passed over.
bool is_command(const std::string& word) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  return word.size() > 1 && (word[0] == 'G' || word[0] == 'M' || is_letter(word[1]));
}

class Inspector {
 public:
  Inspector(const std::string& program, const std::string& machine)
      : file_(program), text_(read_file(program)), machine_(machine::load_machine(machine)) {
    result_.request.program = program;
    result_.request.machine = machine;
    result_.lines = static_cast<int>(std::count(text_.begin(), text_.end(), '\n'));
    result_.machine_nozzle = machine_.tool.nozzle_diameter;
    options_.X_WT_home = machine_.X_WB * machine_.X_BT_home;
    options_.rotary = rotary_words(machine_);
    options_.unknown = &result_.unknown;
  }

  Inspection run() {
    result_.slicer_facts = toolpath::slicer_facts(text_);
    if (const auto nozzle = number_of(result_.slicer_facts, "nozzle_diameter"))
      result_.nozzle = from_mm(*nozzle);
    if (options_.rotary && has_word(text_, options_.rotary->letters))
      rank_readings();
    else
      summarise_as(options_);
    request_words();
    request_place();
    return std::move(result_);
  }

 private:
  toolpath::GcodeOptions as(const RotaryReading& reading) const {
    toolpath::GcodeOptions options = options_;
    using Coordinates = toolpath::RotaryWords::Coordinates;
    options.rotary->coordinates = reading.coordinates == "machine"    ? Coordinates::machine
                                  : reading.coordinates == "crossing" ? Coordinates::crossing
                                                                      : Coordinates::tip;
    options.b_sign = reading.b_sign;
    options.c_sign = reading.c_sign;
    return options;
  }

  Vec3 start_W() const { return options_.X_WT_home.translation(); }

  void rank_readings() {
    std::string refusal;
    for (const char* coordinates : {"tip", "machine", "crossing"})
      for (const int b : {1, -1})
        for (const int c : {1, -1}) {
          RotaryReading reading{coordinates, b, c, {}};
          try {
            reading.quality =
                toolpath::reading_quality(toolpath::parse_gcode(text_, file_, as(reading)), start_W());
            result_.readings.push_back(reading);
          } catch (const InputError& error) {
            refusal = error.what();  // a program with G43.4 cannot be read as crossing
          }
        }
    if (result_.readings.empty()) throw InputError(refusal);
    sort_by_rank();
    const RotaryReading& best = result_.readings.front();
    result_.request.dialect.coordinates = best.coordinates;
    result_.request.dialect.b_sign = best.b_sign;
    result_.request.dialect.c_sign = best.c_sign;
    summarise_as(as(best));
  }

  /// The sum of both ranks; equal sums by the angle. Values that agree to a per mille share their rank, and
  /// the reading without options comes first among equals.
  void sort_by_rank() {
    auto& readings = result_.readings;
    const auto rank = [&](const RotaryReading& reading, auto value) {
      return std::count_if(readings.begin(), readings.end(),
                           [&](const RotaryReading& other) { return value(other) < 0.999 * value(reading); });
    };
    const auto angle = [](const RotaryReading& r) { return r.quality.out_of_layer; };
    const auto step = [](const RotaryReading& r) { return r.quality.longest_step; };
    std::vector<std::pair<std::pair<std::ptrdiff_t, double>, RotaryReading>> ranked;
    for (const RotaryReading& r : readings)
      ranked.push_back({{rank(r, angle) + rank(r, step), std::round(1e6 * angle(r))}, r});
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < ranked.size(); ++i) readings[i] = ranked[i].second;
  }

  void summarise_as(const toolpath::GcodeOptions& options) {
    result_.summary =
        toolpath::summarise(toolpath::parse_gcode(text_, file_, options), start_W(), filament_diameter());
  }

  double filament_diameter() const {
    const auto said = number_of(result_.slicer_facts, "filament_diameter");
    return said && *said > 0 ? from_mm(*said) : machine_.tool.filament_diameter;
  }

  void request_words() {
    for (const auto& word : result_.unknown)
      if (is_command(word.word)) result_.request.dialect.ignored.push_back(word.word);
    if (!result_.summary.temperatures.empty()) return;
    for (const char* key : {"first_layer_temperature", "temperature"})
      if (const auto said = number_of(result_.slicer_facts, key); said && *said > 0 && *said <= kWarmest) {
        result_.request.dialect.temperature_c = *said;
        return;
      }
  }

  /// Onto the table, and to its middle where it does not lie on it.
  void request_place() {
    const auto& printed = result_.summary.printed;
    if (!printed || result_.request.dialect.coordinates == "machine") return;
    auto& place = result_.request.dialect.place_mm;
    const double lowest = printed->lower.z();
    // High above the table it may print on a part; a program of rotary words counts from its table's pivots.
    if (lowest < -kMostOffTable || (lowest > kFarAbove && !result_.readings.empty())) {
      const auto& heights = result_.summary.layer_heights;
      place[2] = std::round(1e3 * to_mm((heights.empty() ? kDefaultLayer : heights.front()) - lowest)) / 1e3;
    }
    const Vec3 centre = (printed->lower + printed->upper) / 2;
    const auto* table = std::get_if<geometry::Box>(&machine_.table.form);
    const Vec3 half = table ? Vec3(table->size / 2) : Vec3::Constant(std::numeric_limits<double>::infinity());
    const Vec3 middle = machine_.table.X_FS.translation();
    for (int i = 0; i < 2; ++i)
      if (printed->lower[i] < middle[i] - half[i] || printed->upper[i] > middle[i] + half[i])
        place[static_cast<std::size_t>(i)] = std::round(1e3 * to_mm(middle[i] - centre[i])) / 1e3;
  }

  std::string file_, text_;
  machine::MachineDescription machine_;
  toolpath::GcodeOptions options_;
  Inspection result_;
};

}  // namespace

Inspection inspect(const std::string& program, const std::string& machine) {
  return Inspector(program, machine).run();
}

std::string rehearse_command(const RehearsalRequest& request, const std::string& folder) {
  const DialectRequest& dialect = request.dialect;
  std::string command = fmt::format("understudy rehearse {} --machine {}", request.program, request.machine);
  if (dialect.place_mm != std::array<double, 3>{0, 0, 0})
    command += fmt::format(" --place {}", fmt::join(dialect.place_mm, ","));
  if (!dialect.coordinates.empty() && dialect.coordinates != "tip")
    command += " --coordinates " + dialect.coordinates;
  if (dialect.b_sign < 0) command += " --b-sign -1";
  if (dialect.c_sign < 0) command += " --c-sign -1";
  if (!dialect.ignored.empty()) command += fmt::format(" --ignore {}", fmt::join(dialect.ignored, ","));
  if (dialect.temperature_c) command += fmt::format(" --temperature {}", *dialect.temperature_c);
  return command + " --out " + folder;
}

}  // namespace understudy::rehearsal
