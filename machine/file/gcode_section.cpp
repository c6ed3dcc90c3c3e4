#include "machine/file/gcode_section.h"

#include <cctype>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "kinematics/chain/chain_turns.h"

namespace understudy::machine {
namespace {

using kinematics::AxisWord;
using kinematics::Chain;

constexpr std::string_view kSlides = "XYZ", kTurns = "ABCDUVW";
constexpr std::size_t kMostTurns = 2;
constexpr Bounds kPlace{-5000, 5000};

[[noreturn]] void refuse(const YamlMap& map, const std::string& key, const std::string& value,
                         const std::string& why) {
  throw InputError(map.place(key), fmt::format("{} is '{}', {}", map.path(key), value, why));
}

double unit_named(const std::string& word) {
  if (word == "revolutions") return 2 * std::numbers::pi;
  return word == "radians" ? 1 : kDegree;
}

/// The words so far, for those that come twice.
struct Words {
  std::vector<AxisWord> slides, turns;
  std::vector<double> units;
  const AxisWord* find(char letter, std::size_t axis) const {
    for (const auto* words : {&slides, &turns})
      for (const AxisWord& word : *words)
        if (word.letter == letter || word.axis == axis) return &word;
    return nullptr;
  }
};

char read_letter(YamlMap& map) {
  const std::string letter =
      map.text("letter", "X Y Z for slides, one of A B C D U V W for an axis that turns");
  if (!map.complete()) return 0;
  if (letter.size() == 1 &&
      (kSlides.find(letter[0]) != std::string_view::npos || kTurns.find(letter[0]) != std::string_view::npos))
    return letter[0];
  const bool taken = letter.size() == 1 && std::isupper(static_cast<unsigned char>(letter[0])) != 0;
  refuse(map, "letter", letter,
         taken ? "which means something else in programs: one of X Y Z, or A B C D U V W"
               : "not one of X Y Z A B C D U V W");
}

std::size_t read_axis_name(YamlMap& map, const Chain& chain) {
  const std::string name = map.text("axis", "name of the axis that the letter drives");
  if (!map.complete()) return 0;
  std::string known;
  for (std::size_t i = 0; i < chain.axes.size(); ++i) {
    if (chain.axes[i].name == name) return i;
    known += (i > 0 ? ", " : "") + chain.axes[i].name;
  }
  refuse(map, "axis", name, "not one of " + known);
}

void read_word(YamlMap& map, const kinematics::ChainDescription& chain, Words& words) {
  AxisWord word;
  word.letter = read_letter(map);
  word.axis = read_axis_name(map, chain.chain);
  if (map.has("sign"))
    word.sign = map.integer("sign", -1, 1, "1 or -1: the word counts with or against the axis");
  const bool turns = map.either("the letter is that of an axis that turns",
                                kTurns.find(word.letter) != std::string_view::npos);
  const std::string zero = turns ? "zero_deg" : "zero_mm";
  if (map.has(zero))
    word.zero = map.quantity(zero, turns ? Bounds{-3600, 3600} : kPlace, "the axis where the word is 0");
  std::string unit = "degrees";
  if (turns && map.has("unit"))
    unit = map.word("unit", {"degrees", "revolutions", "radians"}, "of the word in programs");
  if (!map.complete()) return;
  const std::string letter(1, word.letter);
  const auto& axis = chain.chain.axes[word.axis];
  if (word.sign == 0) refuse(map, "sign", "0", "not 1 or -1");
  if (const AxisWord* other = words.find(word.letter, word.axis)) {
    if (other->letter == word.letter) refuse(map, "letter", letter, "as another word is");
    refuse(map, "axis", axis.name, fmt::format("which {} drives", other->letter));
  }
  if (axis.angle != turns)
    refuse(map, "axis", axis.name,
           fmt::format("which {}: {} {}", axis.angle ? "turns" : "slides", letter,
                       turns ? "states turns" : "states a slide"));
  if (turns && words.turns.size() == kMostTurns)
    refuse(map, "letter", letter, fmt::format("the {}rd that turns an axis: at most 2 may", kMostTurns + 1));
  word.home = word.sign * (chain.home[word.axis] - word.zero);
  (turns ? words.turns : words.slides).push_back(word);
  if (turns) words.units.push_back(unit_named(unit));
}

std::vector<std::string> read_commands(YamlMap& map, const std::string& key, const char* about) {
  const std::string text = map.text(key, about);
  std::vector<std::string> commands;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    for (char& c : word) {
      c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '_')
        refuse(map, key, text, "where commands such as G43.4 or M428 are given, with blanks between them");
    }
    if (word.size() < 2 || std::isalpha(static_cast<unsigned char>(word[0])) == 0)
      refuse(map, key, text, fmt::format("where '{}' is no command", word));
    commands.push_back(word);
  }
  return commands;
}

void read_extruder(YamlMap& map, ProgramDialect& dialect) {
  const std::string letter = map.text("extruder", "letter of the filament: E, or one of A B C D U V W");
  if (!map.complete()) return;
  if (letter != "E" && (letter.size() != 1 || kTurns.find(letter[0]) == std::string_view::npos))
    refuse(map, "extruder", letter, "not one of E A B C D U V W");
  dialect.extruder_letter = letter[0];
}

void read_dialect(YamlMap& map, const Words& words, ProgramDialect& dialect) {
  dialect.coordinates =
      map.word("coordinates", {"tip", "machine", "crossing"},
               "X Y Z: the tip on the work, the slides, or as if all turning axes met in the pivot");
  if (dialect.coordinates == "crossing" || map.recording()) {
    if (map.has("pivot_mm")) dialect.pivot_W = map.vector("pivot_mm", kPlace, "where they meet, in W");
    if (map.has("tip_from_pivot_mm"))
      dialect.tip_from_pivot_W =
          map.vector("tip_from_pivot_mm", kPlace, "the tip as the tool turns about the pivot, words at 0");
  }
  if (map.has("extruder")) read_extruder(map, dialect);
  if (map.has("tip_control_on"))
    dialect.tip_control_on = read_commands(map, "tip_control_on", "commands after which X Y Z are the tip");
  if (map.has("tip_control_off"))
    dialect.tip_control_off =
        read_commands(map, "tip_control_off", "commands after which X Y Z are the slides");
  if (!map.complete()) return;
  for (const AxisWord& word : words.turns)
    if (word.letter == dialect.extruder_letter)
      refuse(map, "extruder", std::string(1, word.letter), "which turns an axis");
  if (dialect.coordinates == "machine" && words.slides.empty())
    refuse(map, "coordinates", "machine", "but no words say which axes X Y Z are");
  for (const std::string& on : dialect.tip_control_on)
    for (const std::string& off : dialect.tip_control_off)
      if (on == off) refuse(map, "tip_control_off", off, "as tip_control_on is");
}

/// X, Y, Z in this order, all or none.
void settle_slides(const YamlMap& map, Words& words) {
  std::vector<AxisWord> sorted;
  for (const char letter : kSlides)
    for (const AxisWord& word : words.slides)
      if (word.letter == letter) sorted.push_back(word);
  words.slides = sorted;
  if (!sorted.empty() && sorted.size() < kSlides.size())
    throw InputError(map.place("words"), fmt::format("{} names {} of X Y Z: all or none of them",
                                                     map.path("words"), sorted.size()));
}

}  // namespace

void read_gcode_section(YamlMap& root, MachineDescription& machine) {
  if (!root.has("gcode")) return;
  root.section("gcode", "words of programs that drive the axes", [&](YamlMap& map) {
    kinematics::ChainDescription& chain = machine.chain().kinematics;
    Words words;
    map.list("words", 0, "one for each letter",
             [&](YamlMap& word, std::size_t) { read_word(word, chain, words); });
    read_dialect(map, words, machine.dialect);
    if (!map.complete()) return;
    settle_slides(map, words);
    chain.slide_words = words.slides;
    chain.turn_words = words.turns;
    machine.dialect.turn_units = words.units;
    if (words.turns.empty()) return;
    if (const std::string problem = kinematics::turns_problem(chain); !problem.empty())
      throw InputError(map.place("words"), fmt::format("{}: {}", map.path("words"), problem));
  });
}

}  // namespace understudy::machine
