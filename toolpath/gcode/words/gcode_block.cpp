#include "toolpath/gcode/words/gcode_block.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "core/error.h"

namespace understudy::toolpath {
namespace {

constexpr const char* kParameters = "XYZBCEFWIJKLPQRST";

}  // namespace

std::optional<Command> Letters::switching(const std::string& command) const {
  if (std::ranges::count(tip_commands, command) > 0) return Command::tip_coordinates;
  if (std::ranges::count(machine_commands, command) > 0) return Command::machine_coordinates;
  return std::nullopt;
}

std::optional<Command> Letters::switching(char letter, double number) const {
  return switching(fmt::format("{}{:g}", letter, number));
}

Block::Block(std::vector<Word> words, const std::string& file, int line, const Letters& letters)
    : file_(file), line_(line), letters_(letters) {
  words_.reserve(words.size());
  without_effect_ = read_without_effect(words);
  if (without_effect_) return;
  for (const Word& word : words) add(word, &word == words.data());
  drop_homing_options();
  check_numbers();
  check_groups();
}

Block::Block(Command command, const Word& word, const std::string& file, int line, const Letters& letters)
    : words_{{word, true, command, false}}, file_(file), line_(line), letters_(letters) {}

bool Block::read_without_effect(const std::vector<Word>& words) {
  const std::size_t first = !words.empty() && words.front().letter == 'N' ? 1 : 0;
  if (first >= words.size() || words[first].bare || words[first].quoted) return false;
  const WithoutEffect* command =
      understudy::toolpath::without_effect(words[first].letter, words[first].value);
  if (command == nullptr) return false;
  const auto is_code = [](const Word& word) {
    return (word.letter == 'G' || word.letter == 'M') && !word.bare && !word.quoted;
  };
  const auto next = words.begin() + static_cast<std::ptrdiff_t>(first) + 1;
  if (command->combines() && std::any_of(next, words.end(), is_code)) return false;
  const bool of_firmware = words[first].letter == 'M';            // takes whatever it likes
  const bool with_text = of_firmware && words[first].value <= 1;  // M0 Insert the nut
  for (std::size_t i = first; i < words.size(); ++i) {
    const Word& word = words[i];
    if (with_text && word.bare) break;
    const bool known = i == first || (of_firmware ? !is_code(word)
                                                  : std::strchr(command->parameters, word.letter) != nullptr);
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
    const bool kept = find(Command::flow) != nullptr && std::strchr("SR", word.letter) != nullptr;  // Bambu's
    if (word.quoted || (word.bare && !axis_to_home && !kept))
      fail(word, fmt::format("'{}': {} needs a finite decimal number", word.text, word.letter));
  }
}

/// How a firmware homes: W without levelling, R lifts, S P T speeds and precision of some.
void Block::drop_homing_options() {
  if (find(Command::home) == nullptr) return;
  if (asks_absent_ && find_any("XYZBC") == nullptr) {  // G28 U: without any other axis it is no G28
    words_.clear();
    without_effect_ = true;
  }
  std::erase_if(words_, [](const Entry& entry) {
    const Word& word = entry.word;
    return !entry.is_command && !word.quoted &&
           (std::strchr("RSPT", word.letter) != nullptr || (word.letter == 'W' && word.bare));
  });
}

void Block::add(const Word& word, bool first) {
  if (word.letter == 'N' && first && !word.bare) return;  // a line number says nothing
  if ((word.letter == 'G' || word.letter == 'M') && !word.bare && !word.quoted) {
    const Meaning* meaning = meaning_of(word.letter, word.value);
    if (meaning == nullptr || meaning->group == Group::coordinates) {
      if (const auto command = letters_.switching(word.letter, word.value)) {
        words_.push_back({word, true, *command, false});
        return;
      }
      meaning = nullptr;
    }
    const WithoutEffect* nothing =
        meaning == nullptr ? understudy::toolpath::without_effect(word.letter, word.value) : nullptr;
    if (nothing != nullptr && nothing->combines()) return;  // G90 G40 G80
    if (meaning == nullptr) throw UnknownWord({file_, line_, word.column}, std::string(word.text));
    words_.push_back({word, true, meaning->command, false});
    return;
  }
  if (asks_absent_axis(word)) {
    asks_absent_ = true;
    return;
  }
  check_letter(word);
  Word parameter = word;
  if (word.letter == letters_.extruder)
    parameter.letter = 'E';
  else if (const auto turn = letters_.rotary.find(word.letter); turn != std::string::npos)
    parameter.letter = "BC"[turn];
  if (std::strchr(kParameters, parameter.letter) == nullptr && !word.bare)
    throw UnknownWord({file_, line_, word.column}, std::string(word.text));
  if (find(parameter.letter) != nullptr)
    fail(word, fmt::format("'{}': the line has a second {}", word.text, word.letter));
  words_.push_back({parameter, false, {}, false});
}

/// Zero of a turning axis that the machine does not have, or the home of a second carriage.
bool Block::asks_absent_axis(const Word& word) const {
  if (word.letter == letters_.extruder || word.quoted || std::strchr("ABCDUV", word.letter) == nullptr ||
      letters_.rotary.find(word.letter) != std::string::npos)
    return false;
  const bool second = std::strchr("DUV", word.letter) != nullptr && find(Command::home) != nullptr;
  return second || (!word.bare && word.value == 0);
}

void Block::check_letter(const Word& word) const {
  if (word.letter == letters_.extruder) return;
  if (word.letter == 'E')
    fail(word, fmt::format("'{}': this program's extruder is on {}", word.text, letters_.extruder));
  if (std::strchr("ABC", word.letter) == nullptr || letters_.rotary.find(word.letter) != std::string::npos)
    return;
  if (letters_.rotary.empty())
    fail(word,
         fmt::format("'{}': this machine has no rotary axes; orientation is W I J K (quaternion) or I J K "
                     "(tool axis)",
                     word.text));
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

std::ptrdiff_t Block::commands() const { return std::ranges::count(words_, true, &Entry::is_command); }

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

std::optional<Word> Block::extract(char letter) {
  const auto entry = std::find_if(words_.begin(), words_.end(),
                                  [&](const Entry& e) { return !e.is_command && e.word.letter == letter; });
  if (entry == words_.end()) return std::nullopt;
  const Word word = entry->word;
  words_.erase(entry);
  return word;
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
