#include "drivers/gcode/gcode_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::drivers {
namespace {

constexpr std::array<std::pair<GcodeFamily, const char*>, 4> kFamilies{
    {{GcodeFamily::grblhal, "grblhal"},
     {GcodeFamily::marlin, "marlin"},
     {GcodeFamily::reprapfirmware, "reprapfirmware"},
     {GcodeFamily::linuxcnc, "linuxcnc"}}};
constexpr double kLengthGrid = 1e-7;           // [m], four decimals of a millimetre
constexpr double kAngleGrid = kDegree * 1e-5;  // [rad], five of a degree
constexpr double kFilamentGrid = 1e-8;         // [m], five of a millimetre

/// Letters that a family gives to slides and to turns, in order, as far as they are not taken.
struct Alphabet {
  std::string_view slides, turns, extruders;
};

Alphabet alphabet(GcodeFamily family) {
  // grblHAL's first six axes are X Y Z A B C whatever they do.
  if (family == GcodeFamily::grblhal) return {"XYZABCUV", "ABCXYZUV", "UVWABC"};
  return {"XYZUVW", "ABCUVW", "E"};
}

char first_free(std::string_view from, const std::string& taken) {
  const auto free = std::ranges::find_if(from, [&](char c) { return taken.find(c) == std::string::npos; });
  return free == from.end() ? '\0' : *free;
}

std::string default_letters(GcodeFamily family, const std::vector<bool>& turns) {
  const Alphabet all = alphabet(family);
  std::string letters;
  for (const bool turn : turns) {
    const char letter = first_free(turn ? all.turns : all.slides, letters);
    if (letter == '\0')
      throw InputError(
          fmt::format("{} has not so many letters for axes: name them by axes=", to_string(family)));
    letters += letter;
  }
  return letters;
}

/// `value` with so many decimals, without zeros at the end.
std::string number(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string upper(std::string word) {
  std::ranges::transform(word, word.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return word;
}

/// Words of a pose, whatever the machine's axes.
GcodeAxes pose_axes(const PortUri& options) {
  for (const char* key : {"axes", "extruder"})
    if (!options.option(key).empty())
      throw InputError(fmt::format("{}: {}: LinuxCNC is sent poses, X Y Z A B C, and has no such letters",
                                   options.text, key));
  GcodeAxes axes;
  axes.letters = "XYZABC";
  axes.extruder = '\0';
  axes.turns = {false, false, false, true, true, true};
  for (std::size_t i = 0; i < axes.turns.size(); ++i)
    axes.grid.axes[i] = axes.turns[i] ? kAngleGrid : kLengthGrid;
  axes.grid.filament = kFilamentGrid;
  return axes;
}

}  // namespace

const char* to_string(GcodeFamily family) {
  return std::ranges::find(kFamilies, family, &std::pair<GcodeFamily, const char*>::first)->second;
}

GcodeFamily gcode_family(const std::string& word) {
  std::vector<std::string> known;
  for (const auto& [family, name] : kFamilies) {
    if (word == name) return family;
    known.emplace_back(name);
  }
  const std::string nearest = nearest_word(word, known);
  throw InputError(fmt::format("family '{}': one of {}{}", word, fmt::join(known, ", "),
                               nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

double GcodeAxes::unit(int axis) const { return turns[static_cast<std::size_t>(axis)] ? kDegree : 1e-3; }

GcodeAxes gcode_axes(GcodeFamily family, const machine::MachineDescription& machine, const PortUri& options) {
  if (family == GcodeFamily::linuxcnc) return pose_axes(options);
  const auto mechanism = machine.make_mechanism();
  GcodeAxes axes;
  for (int i = 0; i < mechanism->axis_count(); ++i) {
    axes.turns.push_back(mechanism->axis_is_angle(i));
    axes.grid.axes[static_cast<std::size_t>(i)] = axes.turns.back() ? kAngleGrid : kLengthGrid;
  }
  axes.grid.filament = kFilamentGrid;
  const std::string given = upper(options.option("axes"));
  axes.letters = given.empty() ? default_letters(family, axes.turns) : given;
  if (axes.letters.size() != axes.turns.size())
    throw InputError(fmt::format("{}: axes={} names {} axes, and {} has {}", options.text, given,
                                 axes.letters.size(), machine.name, axes.turns.size()));
  const std::string extruder = upper(options.option("extruder"));
  axes.extruder = extruder.empty()     ? first_free(alphabet(family).extruders, axes.letters)
                  : extruder == "NONE" ? '\0'
                                       : extruder[0];
  if (!machine.tool.prints()) axes.extruder = '\0';
  if (machine.tool.prints() && axes.extruder == '\0' && extruder != "NONE")
    throw InputError(fmt::format(
        "{}: no letter is left for the filament: name it by extruder=, or say extruder=none", options.text));
  std::string all = axes.letters;
  if (axes.extruder != '\0') all += axes.extruder;
  for (const char c : all)
    if (std::string_view("XYZABCUVWE").find(c) == std::string_view::npos || std::ranges::count(all, c) > 1 ||
        (extruder.size() > 1 && extruder != "NONE"))
      throw InputError(
          fmt::format("{}: letters '{}' of axes and extruder: each one of X Y Z A B C U V W E, and once",
                      options.text, all));
  return axes;
}

GcodeWriter::GcodeWriter(GcodeFamily family, GcodeAxes axes) : family_(family), axes_(std::move(axes)) {}

std::vector<std::string> GcodeWriter::preamble() const {
  std::vector<std::string> lines{"G21", "G90"};
  if (family_ != GcodeFamily::grblhal) lines.emplace_back("M82");
  if (family_ != GcodeFamily::marlin) lines.emplace_back("G93");
  if (axes_.extruder != '\0') lines.push_back(fmt::format("G92 {}0", axes_.extruder));
  return lines;
}

void GcodeWriter::begin(const PathSample& at) {
  last_ = {};
  last_.filament = at.filament;
  for (int i = 0; i < axes_.count(); ++i) {
    const auto axis = static_cast<std::size_t>(i);
    last_.position[axis] = std::round(at.position[axis] / axes_.grid.axes[axis]) * axes_.grid.axes[axis];
  }
}

/// The length that a feed in mm/min counts on: of X Y Z, else of U V W, else of A B C, else of the filament
/// (NIST RS274/NGC 2.1.2.5, as Marlin has it). [mm or deg]
double GcodeWriter::feed_length(const Block& block) const {
  for (const std::string_view group : {"XYZ", "UVW", "ABC"}) {
    double square = 0;
    for (int i = 0; i < axes_.count(); ++i) {
      const auto axis = static_cast<std::size_t>(i);
      if (group.find(axes_.letters[axis]) == std::string_view::npos) continue;
      const double step = (block.position[axis] - last_.position[axis]) / axes_.unit(i);
      square += step * step;
    }
    if (square > 0) return std::sqrt(square);
  }
  return std::abs(to_mm(block.filament - last_.filament));
}

std::string GcodeWriter::block(const Block& block) {
  if (block.rests) {
    if (family_ == GcodeFamily::grblhal) return "G4 P" + number(block.duration, 3);
    return "G4 P" + number(std::round(block.duration * 1e3), 0);
  }
  std::string text = "G1";
  for (int i = 0; i < axes_.count(); ++i) {
    const auto axis = static_cast<std::size_t>(i);
    if (block.position[axis] == last_.position[axis]) continue;
    text += fmt::format(" {}{}", axes_.letters[axis],
                        number(block.position[axis] / axes_.unit(i), axes_.turns[axis] ? 5 : 4));
  }
  if (axes_.extruder != '\0' && block.filament != last_.filament)
    text += fmt::format(" {}{}", axes_.extruder, number(to_mm(block.filament), 5));
  const double feed =
      family_ == GcodeFamily::marlin ? 60 * feed_length(block) / block.duration : 60 / block.duration;
  text += fmt::format(" F{:.7g}", feed);
  last_ = block;
  return text;
}

std::vector<std::string> GcodeWriter::outputs(const machine::Outputs& before,
                                              const machine::Outputs& after) const {
  std::vector<std::string> lines;
  if (after.nozzle_temperature != before.nozzle_temperature) {
    const bool off = after.nozzle_temperature <= 0;
    const double celsius = off ? 0 : after.nozzle_temperature - kCelsiusZero;
    const bool waits = !off && after.nozzle_temperature > before.nozzle_temperature;
    lines.push_back((waits ? "M109 S" : "M104 S") + number(celsius, 1));
  }
  if (after.fan != before.fan)
    lines.push_back(after.fan > 0 ? "M106 S" + number(std::round(255 * after.fan), 0) : "M107");
  return lines;
}

}  // namespace understudy::drivers
