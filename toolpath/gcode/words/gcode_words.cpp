#include "toolpath/gcode/words/gcode_words.h"

#include <algorithm>
#include <cctype>
#include <iterator>

#include "core/text/trimmed.h"

namespace understudy::toolpath {
namespace {

constexpr Meaning kMeanings[] = {
    {'G', 0, Command::rapid, Group::motion},
    {'G', 1, Command::linear, Group::motion},
    {'G', 2, Command::clockwise_arc, Group::motion},
    {'G', 3, Command::counterclockwise_arc, Group::motion},
    {'G', 4, Command::dwell, Group::motion},
    {'G', 5, Command::spline, Group::motion},
    {'G', 10, Command::retract, Group::motion},
    {'G', 11, Command::unretract, Group::motion},
    {'G', 17, Command::plane_xy, Group::plane},
    {'G', 18, Command::plane_zx, Group::plane},
    {'G', 19, Command::plane_yz, Group::plane},
    {'G', 20, Command::inches, Group::units},
    {'G', 21, Command::millimetres, Group::units},
    {'G', 28, Command::home, Group::motion},
    {'G', 43.4, Command::tip_coordinates, Group::coordinates},
    {'G', 49, Command::machine_coordinates, Group::coordinates},
    {'G', 53, Command::machine_position, Group::machine_position},
    {'G', 54, Command::work_offset, Group::work_offset},
    {'G', 55, Command::work_offset, Group::work_offset},
    {'G', 56, Command::work_offset, Group::work_offset},
    {'G', 57, Command::work_offset, Group::work_offset},
    {'G', 58, Command::work_offset, Group::work_offset},
    {'G', 59, Command::work_offset, Group::work_offset},
    {'G', 59.1, Command::work_offset, Group::work_offset},
    {'G', 59.2, Command::work_offset, Group::work_offset},
    {'G', 59.3, Command::work_offset, Group::work_offset},
    {'G', 90, Command::absolute, Group::distance},
    {'G', 91, Command::relative, Group::distance},
    {'G', 92, Command::set_position, Group::motion},
    {'G', 93, Command::inverse_time, Group::feed_mode},
    {'G', 94, Command::per_minute, Group::feed_mode},
    {'M', 2, Command::end, Group::end},
    {'M', 6, Command::tool_change, Group::process},
    {'M', 30, Command::end, Group::end},
    {'M', 82, Command::absolute_extrusion, Group::extrusion},
    {'M', 83, Command::relative_extrusion, Group::extrusion},
    {'M', 104, Command::heat, Group::process},
    {'M', 109, Command::heat_and_wait, Group::process},
    {'M', 106, Command::fan_on, Group::process},
    {'M', 107, Command::fan_off, Group::process},
    {'M', 204, Command::acceleration, Group::process},
    {'M', 207, Command::retraction, Group::process},
    {'M', 220, Command::speed, Group::process},
    {'M', 221, Command::flow, Group::process},
};

constexpr const char* kAny = "*";  // parameters, texts too

constexpr WithoutEffect kWithoutEffect[] = {
    {'G', 29, "ABCEFHIJKLNOPQRSTUVWXYZ"},  // levelling of the bed
    {'G', 40, ""},                         // cutter compensation off
    {'G', 61, ""},                         // exact path
    {'G', 64, "PQ"},                       // blended path
    {'G', 80, "ABCEFHIJKLNOPQRSTUVWXYZ"},  // canned cycles off; Prusa's levelling
    {'M', 0, kAny},                        // a stop for the operator
    {'M', 1, kAny},
    {'M', 5, ""},        // spindle off
    {'M', 9, ""},        // coolant off
    {'M', 17, kAny},     // motors on
    {'M', 18, kAny},     // motors off
    {'M', 73, kAny},     // progress shown
    {'M', 75, ""},       // print timer
    {'M', 76, ""},       //
    {'M', 77, ""},       //
    {'M', 84, kAny},     // motors off
    {'M', 105, kAny},    // temperature asked for
    {'M', 110, kAny},    // line number
    {'M', 114, kAny},    // position asked for
    {'M', 115, kAny},    // firmware asked for
    {'M', 116, kAny},    // wait for temperatures
    {'M', 119, ""},      // end switches asked for
    {'M', 140, kAny},    // bed temperature
    {'M', 141, kAny},    // chamber temperature
    {'M', 142, kAny},    // chamber cooling
    {'M', 150, kAny},    // lights
    {'M', 155, kAny},    // reports of temperature
    {'M', 190, kAny},    // bed temperature, and wait
    {'M', 191, kAny},    // chamber temperature, and wait
    {'M', 201, kAny},    // largest accelerations
    {'M', 203, kAny},    // largest feeds
    {'M', 205, kAny},    // jerk, junction deviation, least feeds
    {'M', 300, kAny},    // a beep
    {'M', 302, kAny},    // cold extrusion
    {'M', 330, kAny},    // records of Prusa's firmware
    {'M', 331, kAny},    //
    {'M', 332, kAny},    //
    {'M', 334, kAny},    //
    {'M', 400, kAny},    // wait for the moves before
    {'M', 412, kAny},    // filament sensor
    {'M', 413, kAny},    // power-loss recovery
    {'M', 420, kAny},    // levelling on or off
    {'M', 501, ""},      // stored settings
    {'M', 555, kAny},    // where Prusa's firmware will print
    {'M', 566, kAny},    // jerk, of RepRapFirmware
    {'M', 572, kAny},    // pressure advance, of RepRapFirmware
    {'M', 593, kAny},    // input shaping
    {'M', 862.1, kAny},  // checks of nozzle, model, firmware
    {'M', 862.2, kAny},  //
    {'M', 862.3, kAny},  //
    {'M', 862.4, kAny},  //
    {'M', 862.5, kAny},  //
    {'M', 862.6, kAny},  //
    {'M', 900, kAny},    // pressure advance
};

/// Of Klipper and its macros, for all that begin so.
constexpr std::string_view kWordsWithoutEffect[] = {"EXCLUDE_OBJECT",       "SET_PRESSURE_ADVANCE",
                                                    "SET_VELOCITY_LIMIT",   "SET_PRINT_STATS_INFO",
                                                    "TIMELAPSE_TAKE_FRAME", "BED_MESH_",
                                                    "SET_INPUT_SHAPER",     "RESPOND"};

char upper(char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }
bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// A line number says nothing.
std::string_view without_number(std::string_view line) {
  line = trimmed(line);
  if (line.size() < 2 || upper(line[0]) != 'N' || !is_digit(line[1])) return line;
  const auto end = std::find_if_not(line.begin() + 1, line.end(), is_digit);
  return trimmed(line.substr(static_cast<std::size_t>(end - line.begin())));
}

/// O1000, alone: the name of a program on some controllers.
bool is_program_number(std::string_view line) {
  if (line.size() < 2 || upper(line[0]) != 'O' || !is_digit(line[1])) return false;
  const auto end = std::find_if_not(line.begin() + 1, line.end(), is_digit);
  line = trimmed(line.substr(static_cast<std::size_t>(end - line.begin())));
  return line.empty() || line[0] == ';' || (line[0] == '(' && line.find(')') == line.size() - 1);
}

/// Z=0.0 MOVE=0: nothing but zeros.
bool sets_no_offset(std::string_view parameters) {
  const auto zero_or_name = [](char c) {
    return is_letter(c) || std::string_view("_= \t.0").find(c) != std::string_view::npos;
  };
  parameters = parameters.substr(0, parameters.find_first_of(";#"));
  return parameters.find('0') != std::string_view::npos &&
         std::all_of(parameters.begin(), parameters.end(), zero_or_name);
}

bool begins_with_command(std::string_view line, std::string_view number) {
  return line.size() > number.size() && upper(line[0]) == 'M' && line.substr(1).starts_with(number) &&
         (line.size() == number.size() + 1 ||
          !(is_digit(line[number.size() + 1]) || line[number.size() + 1] == '.'));
}

}  // namespace

const Meaning* meaning_of(char letter, double number) {
  const auto found = std::find_if(std::begin(kMeanings), std::end(kMeanings),
                                  [&](const Meaning& m) { return m.letter == letter && m.number == number; });
  return found == std::end(kMeanings) ? nullptr : &*found;
}

Group group_of(Command command) {
  return std::find_if(std::begin(kMeanings), std::end(kMeanings),
                      [&](const Meaning& m) { return m.command == command; })
      ->group;
}

const WithoutEffect* without_effect(char letter, double number) {
  const auto found =
      std::find_if(std::begin(kWithoutEffect), std::end(kWithoutEffect),
                   [&](const WithoutEffect& w) { return w.letter == letter && w.number == number; });
  return found == std::end(kWithoutEffect) ? nullptr : &*found;
}

bool is_line_without_effect(std::string_view line) {
  line = without_number(line);
  if (line == "%" || is_program_number(line)) return true;
  for (const std::string_view text : {"117", "118", "486", "1002"})
    if (begins_with_command(line, text)) return true;
  const std::string word = command_in_words(line);
  if (word == "SET_GCODE_OFFSET") return sets_no_offset(line.substr(word.size()));
  return !word.empty() && std::any_of(std::begin(kWordsWithoutEffect), std::end(kWordsWithoutEffect),
                                      [&](std::string_view known) { return word.starts_with(known); });
}

std::string command_in_words(std::string_view line) {
  line = without_number(line);
  std::string word;
  if (line.size() > 2 && line[0] == '#' && is_letter(line[1])) {  // #TRAFO: of controllers by ISG
    word = "#";
    line.remove_prefix(1);
  }
  if (line.size() < 2 || !is_letter(line[0]) || !(is_letter(line[1]) || line[1] == '_')) return "";
  for (const char c : line) {
    if (!is_letter(c) && !is_digit(c) && c != '_') break;
    word += upper(c);
  }
  return word;
}

}  // namespace understudy::toolpath
