#include "toolpath/gcode_block.h"

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
    {'M', 30, Command::end, Group::end},
};
constexpr const char* kParameters = "XYZBCEFWIJKPS";

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

Block::Block(std::vector<Word> words, std::string file, int line, bool with_rotary_words)
    : file_(std::move(file)), line_(line), with_rotary_words_(with_rotary_words) {
  words_.reserve(words.size());
  for (const Word& word : words) add(word, &word == words.data());
  check_groups();
}

void Block::add(const Word& word, bool first) {
  if (word.letter == 'N' && first) return;  // a line number says nothing
  if (word.letter == 'G' || word.letter == 'M') {
    const Meaning* meaning = meaning_of(word);
    if (meaning == nullptr) fail(word, fmt::format("unknown word '{}'", word.text));
    words_.push_back({word, true, meaning->command, false});
    return;
  }
  check_rotary(word);
  if (std::strchr(kParameters, word.letter) == nullptr)
    fail(word, fmt::format("unknown word '{}'", word.text));
  if (find(word.letter) != nullptr)
    fail(word, fmt::format("'{}': the line has a second {}", word.text, word.letter));
  words_.push_back({word, false, {}, false});
}

void Block::check_rotary(const Word& word) const {
  if (std::strchr("ABC", word.letter) == nullptr) return;
  if (!with_rotary_words_)
    fail(word,
         fmt::format("'{}': this machine has no rotary axes; orientation is W I J K (quaternion) or I J K "
                     "(tool axis)",
                     word.text));
  if (word.letter == 'A')
    fail(word, fmt::format("'{}': the rotary axes of this machine are B and C", word.text));
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
