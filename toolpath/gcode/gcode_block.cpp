#include "toolpath/gcode/gcode_block.h"

#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::toolpath {
namespace {

// Commands of one group exclude each other on a line (the modal groups of RS-274, and the S word's users).
enum class Group { motion, units, coordinates, distance, feed_mode, extrusion, process, end };

struct Meaning {
  char letter;
  double number;
  Command command;
  Group group;
};

constexpr Meaning kMeanings[] = {
    {'G', 0, Command::rapid, Group::motion},
    {'G', 1, Command::linear, Group::motion},
    {'G', 4, Command::dwell, Group::motion},
    {'G', 20, Command::inches, Group::units},
    {'G', 21, Command::millimetres, Group::units},
    {'G', 28, Command::home, Group::motion},
    {'G', 43.4, Command::tip_coordinates, Group::coordinates},
    {'G', 49, Command::machine_coordinates, Group::coordinates},
    {'G', 90, Command::absolute, Group::distance},
    {'G', 91, Command::relative, Group::distance},
    {'G', 92, Command::set_position, Group::motion},
    {'G', 93, Command::inverse_time, Group::feed_mode},
    {'G', 94, Command::per_minute, Group::feed_mode},
    {'M', 82, Command::absolute_extrusion, Group::extrusion},
    {'M', 83, Command::relative_extrusion, Group::extrusion},
    {'M', 104, Command::heat, Group::process},
    {'M', 109, Command::heat_and_wait, Group::process},
    {'M', 106, Command::fan_on, Group::process},
    {'M', 107, Command::fan_off, Group::process},
    {'M', 221, Command::flow, Group::process},
    {'M', 30, Command::end, Group::end},
};
constexpr const char* kParameters = "XYZBCEFWIJKPST";

/// What slicers write for a firmware and the twin has no use for: limits are the machine description's, there
/// is no heated bed, no display, and motors stay on.
struct WithoutEffect {
  double number;  // of M
  const char* parameters;
};
constexpr WithoutEffect kWithoutEffect[] = {
    {17, "XYZE"},       // motors on
    {18, "XYZES"},      // motors off
    {84, "XYZES"},      // motors off
    {73, "PRQSCD"},     // progress shown
    {105, "T"},         // temperature asked for
    {140, "ST"},        // bed temperature
    {190, "SRT"},       // and wait
    {201, "XYZETF"},    // largest accelerations
    {203, "XYZET"},     // largest feeds
    {204, "SPRT"},      // accelerations
    {205, "XYZEBSTJ"},  // jerk, junction deviation, least feeds
    {862.1, "PQT"},     // checks of nozzle, model, firmware
    {862.2, "PQ"},     {862.3, "PQ"}, {862.4, "PQ"},
    {862.5, "PQ"},     {862.6, "PQ"}, {900, "KLT"},  // pressure advance
};

const WithoutEffect* idle_command(const Word& word) {
  for (const WithoutEffect& w : kWithoutEffect)
    if (word.letter == 'M' && !word.bare && w.number == word.value) return &w;
  return nullptr;
}

const Meaning* meaning_of(const Word& word) {
  for (const Meaning& m : kMeanings)
    if (m.letter == word.letter && m.number == word.value) return &m;
  return nullptr;
}

Group group_of(Command command) {
  for (const Meaning& m : kMeanings)
    if (m.command == command) return m.group;
  return Group::end;
}

}  // namespace

Block::Block(std::vector<Word> words, const std::string& file, int line, Letters letters)
    : file_(file), line_(line), letters_(letters) {
  words_.reserve(words.size());
  without_effect_ = read_without_effect(words);
  if (without_effect_) return;
  for (const Word& word : words) add(word, &word == words.data());
  check_numbers();
  check_groups();
}

bool Block::read_without_effect(const std::vector<Word>& words) {
  const std::size_t first = !words.empty() && words.front().letter == 'N' ? 1 : 0;
  const WithoutEffect* command = first < words.size() ? idle_command(words[first]) : nullptr;
  if (command == nullptr) return false;
  for (std::size_t i = first; i < words.size(); ++i) {
    const Word& word = words[i];
    const bool known = i == first || std::strchr(command->parameters, word.letter) != nullptr;
    if (!known) fail(word, fmt::format("'{}' is no parameter of '{}'", word.text, words[first].text));
    words_.push_back({word, i == first, {}, true});
  }
  return true;
}

/// Letters without a number: G28 X Y.
void Block::check_numbers() const {
  for (const Entry& entry : words_) {
    const Word& word = entry.word;
    const bool axis_to_home = find(Command::home) != nullptr && std::strchr("XYZBC", word.letter) != nullptr;
    if (word.quoted || (word.bare && !axis_to_home))
      fail(word, fmt::format("'{}': {} needs a finite decimal number", word.text, word.letter));
  }
}

void Block::add(const Word& word, bool first) {
  if (word.letter == 'N' && first && !word.bare) return;  // a line number says nothing
  if ((word.letter == 'G' || word.letter == 'M') && !word.bare && !word.quoted) {
    const Meaning* meaning = meaning_of(word);
    if (meaning == nullptr) fail(word, fmt::format("unknown word '{}'", word.text));
    words_.push_back({word, true, meaning->command, false});
    return;
  }
  check_letter(word);
  Word parameter = word;
  if (word.letter == letters_.extruder)
    parameter.letter = 'E';
  else if (const auto turn = letters_.rotary.find(word.letter); turn != std::string::npos)
    parameter.letter = "BC"[turn];
  if (std::strchr(kParameters, parameter.letter) == nullptr && !word.bare)
    fail(word, fmt::format("unknown word '{}'", word.text));
  if (find(parameter.letter) != nullptr)
    fail(word, fmt::format("'{}': the line has a second {}", word.text, word.letter));
  words_.push_back({parameter, false, {}, false});
}

void Block::check_letter(const Word& word) const {
  if (word.letter == letters_.extruder) return;
  if (word.letter == 'E')
    fail(word, fmt::format("'{}': this program's extruder is on {}", word.text, letters_.extruder));
  if (std::strchr("ABC", word.letter) == nullptr) return;
  if (letters_.rotary.empty())
    fail(word,
         fmt::format("'{}': this machine has no rotary axes; orientation is W I J K (quaternion) or I J K "
                     "(tool axis)",
                     word.text));
  if (letters_.rotary.find(word.letter) == std::string::npos)
    fail(word, fmt::format("'{}': the rotary axes of this machine are {}", word.text,
                           fmt::join(letters_.rotary, " and ")));
}

void Block::check_groups() const {
  for (std::size_t i = 0; i < words_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (words_[i].is_command && words_[j].is_command &&
          group_of(words_[i].command) == group_of(words_[j].command))
        fail(words_[i].word,
             fmt::format("'{}' cannot share a line with '{}'", words_[i].word.text, words_[j].word.text));
}

const Word* Block::find(Command command) const {
  for (const Entry& entry : words_)
    if (entry.is_command && entry.command == command) return &entry.word;
  return nullptr;
}

const Word* Block::find(char letter) const {
  for (const Entry& entry : words_)
    if (!entry.is_command && entry.word.letter == letter) return &entry.word;
  return nullptr;
}

const Word* Block::take(char letter) {
  for (Entry& entry : words_) {
    if (entry.is_command || entry.word.letter != letter) continue;
    entry.taken = true;
    return &entry.word;
  }
  return nullptr;
}

const Word* Block::find_any(const char* letters) const {
  for (const Entry& entry : words_)
    if (!entry.is_command && std::strchr(letters, entry.word.letter) != nullptr) return &entry.word;
  return nullptr;
}

void Block::check_all_taken() const {
  for (const Entry& entry : words_)
    if (!entry.is_command && !entry.taken)
      fail(entry.word, fmt::format("'{}' belongs to no command on this line", entry.word.text));
}

void Block::fail(const Word& word, const std::string& message) const {
  throw InputError({file_, line_, word.column}, message);
}

void Block::fail(const std::string& message) const {
  const int column = words_.empty() ? 1 : words_.front().word.column;
  throw InputError({file_, line_, column}, message);
}

}  // namespace understudy::toolpath
