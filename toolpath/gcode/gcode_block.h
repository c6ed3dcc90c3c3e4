// The words of one line, each of which somebody must use: nothing is skipped in silence.
#pragma once

#include <string>
#include <vector>

#include "toolpath/gcode/gcode_lexer.h"

namespace understudy::toolpath {

/// What G and M words the dialect knows.
enum class Command {
  rapid,                // G0
  linear,               // G1
  dwell,                // G4
  inches,               // G20
  millimetres,          // G21
  home,                 // G28
  tip_coordinates,      // G43.4
  machine_coordinates,  // G49
  absolute,             // G90
  relative,             // G91
  set_position,         // G92
  inverse_time,         // G93
  per_minute,           // G94
  absolute_extrusion,   // M82
  relative_extrusion,   // M83
  heat,                 // M104
  heat_and_wait,        // M109
  fan_on,               // M106
  fan_off,              // M107
  flow,                 // M221
  end,                  // M30
};

/// How a dialect uses letters.
struct Letters {
  std::string rotary;   ///< two of A, B, C, read as B and C; empty: no such axes
  char extruder = 'E';  ///< is read as E
};

class Block {
 public:
  /// Throws InputError for a word that the dialect does not know, a letter given twice, or two commands that
  /// exclude each other.
  Block(std::vector<Word> words, const std::string& file, int line, Letters letters);

  bool empty() const { return words_.empty(); }
  /// A command that the twin has no use for, alone on its line, with parameters that it may have.
  bool without_effect() const { return without_effect_; }
  /// The only word of its line.
  bool alone(const Word& word) const { return words_.size() == 1 && &words_.front().word == &word; }
  int line() const { return line_; }
  /// The word of the command, or null; commands need not be taken.
  const Word* find(Command command) const;
  /// The parameter with that letter, or null.
  const Word* find(char letter) const;
  /// The same, now marked as used.
  const Word* take(char letter);
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
  void check_numbers() const;
  bool read_without_effect(const std::vector<Word>& words);

  std::vector<Entry> words_;
  const std::string& file_;  // of the parser, which outlives its lines
  int line_;
  Letters letters_;
  bool without_effect_ = false;
};

}  // namespace understudy::toolpath
