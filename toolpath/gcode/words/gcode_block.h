// The words of one line, each of which somebody must use: nothing is skipped in silence.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "toolpath/gcode/words/gcode_lexer.h"
#include "toolpath/gcode/words/gcode_words.h"

namespace understudy::toolpath {

/// How a dialect uses letters.
struct Letters {
  std::string rotary;   ///< one or two letters, read as B and C; empty: no such axes
  char extruder = 'E';  ///< is read as E
  /// The commands that switch tool-centre-point coordinates on and off.
  std::vector<std::string> tip_commands{"G43.4"}, machine_commands{"G49"};

  /// The command that switches so; nothing for any other. Whether a word of that number is one.
  std::optional<Command> switching(const std::string& command) const;
  std::optional<Command> switching(char letter, double number) const;
};

/// A word that the dialect does not know.
class UnknownWord : public InputError {
 public:
  UnknownWord(const Place& place, const std::string& word)
      : InputError(place, "unknown word '" + word + "'"), word_(word) {}
  const std::string& word() const { return word_; }

 private:
  std::string word_;
};

class Block {
 public:
  /// Throws UnknownWord, and InputError for a letter given twice, or two commands that exclude each other.
  /// `letters` and `file` must outlive the block.
  Block(std::vector<Word> words, const std::string& file, int line, const Letters& letters);
  /// A line of this command alone, told in words such as TRAORI.
  Block(Command command, const Word& word, const std::string& file, int line, const Letters& letters);

  bool empty() const { return words_.empty(); }
  /// A command that the twin has no use for, alone on its line, with parameters that it may have.
  bool without_effect() const { return without_effect_; }
  /// The only word of its line.
  bool alone(const Word& word) const { return words_.size() == 1 && &words_.front().word == &word; }
  /// G and M words on the line.
  std::ptrdiff_t commands() const;
  int line() const { return line_; }
  /// The word of the command, or null; commands need not be taken.
  const Word* find(Command command) const;
  /// The parameter with that letter, or null.
  const Word* find(char letter) const;
  /// The same, now marked as used.
  const Word* take(char letter);
  /// The same, no longer among the words; nothing where there is none.
  std::optional<Word> extract(char letter);
  /// Any of the letters, not marked.
  const Word* find_any(const char* letters) const;
  /// Throws InputError for the first parameter that nobody took.
  void check_all_taken() const;
  [[noreturn]] void fail(const Word& word, const std::string& message) const;
  [[noreturn]] void fail(const std::string& message) const;

 private:
  struct Entry {
    Word word;
    bool is_command = false;
    Command command{};
    bool taken = false;
  };
  void add(const Word& word, bool first);
  void check_letter(const Word& word) const;
  void check_groups() const;
  void drop_homing_options();
  bool asks_absent_axis(const Word& word) const;
  void check_numbers() const;
  bool read_without_effect(const std::vector<Word>& words);

  std::vector<Entry> words_;
  const std::string& file_;  // of the parser, which outlives its lines
  int line_;
  const Letters& letters_;
  bool without_effect_ = false;
  bool asks_absent_ = false;  // only of axes that are not there
};

}  // namespace understudy::toolpath
