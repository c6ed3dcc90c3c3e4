#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "toolpath/gcode/gcode.h"
#include "toolpath/gcode/gcode_block.h"
#include "toolpath/gcode/gcode_lexer.h"
#include "toolpath/gcode/gcode_state.h"

namespace understudy::toolpath {
namespace {

constexpr std::size_t kLineMax = 65'536;  // [bytes]; docs/limits.md
constexpr std::size_t kDeepestCall = 20;
constexpr int kMostMacroLines = 100'000;  // docs/limits.md

/// Up to a line feed, a carriage return, or both; a comment ends there, too.
std::string_view take_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find_first_of("\r\n"), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end);
  if (rest.starts_with("\r\n"))
    rest.remove_prefix(2);
  else if (!rest.empty())
    rest.remove_prefix(1);
  return line;
}

int column_of(std::string_view line) { return static_cast<int>(line.find_first_not_of(" \t")) + 1; }

/// The command that a line begins with: "G1", "START_PRINT".
std::string first_command(std::string_view line) {
  if (const std::string word = command_in_words(line); !word.empty()) return word;
  const std::size_t start = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t end = std::min(line.find_first_not_of("0123456789.", start + 1), line.size());
  std::string word(line.substr(start, end - start));
  if (!word.empty()) word[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(word[0])));
  return word;
}

bool is_passed_over(std::string_view line, const GcodeOptions& options) {
  if (is_line_without_effect(line)) return true;
  return !options.ignored.empty() && std::ranges::count(options.ignored, first_command(line)) > 0;
}

/// Told together, so that a user need not mend a program word by word.
class UnknownWords {
 public:
  void add(const UnknownWord& error) {
    if (!first_) first_.emplace(error);
    const auto known = std::ranges::find(counts_, error.word(), &UnknownWordCount::word);
    if (known != counts_.end())
      ++known->lines;
    else
      counts_.push_back({error.word(), 1, error.place().line});
  }
  void fail_if_any() const {
    if (!first_) return;
    if (counts_.size() == 1 && counts_[0].lines == 1) throw UnknownWord(*first_);
    std::string all;
    for (std::size_t i = 0; i < counts_.size() && i < kShown; ++i)
      all += fmt::format("{}'{}' ({} line{} from line {})", i ? ", " : "", counts_[i].word, counts_[i].lines,
                         counts_[i].lines == 1 ? "" : "s", counts_[i].first_line);
    if (counts_.size() > kShown) all += fmt::format(" and {} more", counts_.size() - kShown);
    throw InputError(first_->place(),
                     fmt::format("unknown words {}: mend these lines, or pass over them by --ignore", all));
  }
  const std::vector<UnknownWordCount>& counts() const { return counts_; }

 private:
  static constexpr std::size_t kShown = 20;
  std::optional<UnknownWord> first_;
  std::vector<UnknownWordCount> counts_;
};

/// Throws InputError for a switching command that means something else.
Letters letters_of(const GcodeOptions& options) {
  Letters letters;
  letters.extruder = options.extruder_letter;
  if (!options.rotary) return letters;
  letters.rotary = options.rotary->letters;
  letters.tip_commands = options.rotary->tip_commands;
  letters.machine_commands = options.rotary->machine_commands;
  for (const auto* commands : {&letters.tip_commands, &letters.machine_commands})
    for (const std::string& command : *commands) {
      double number = 0;
      const char* end = command.data() + command.size();
      const bool coded = (command[0] == 'G' || command[0] == 'M') &&
                         std::from_chars(command.data() + 1, end, number).ptr == end;
      const Meaning* meaning = coded ? meaning_of(command[0], number) : nullptr;
      if ((meaning != nullptr && meaning->group != Group::coordinates) ||
          (coded && without_effect(command[0], number) != nullptr) || is_line_without_effect(command))
        throw InputError(
            fmt::format("'{}' cannot switch tool-centre-point control: it has another meaning", command));
    }
  return letters;
}

/// The line of a firmware's command in words: it switches coordinates, or is not known.
Block block_of(const std::string& command, std::string_view text, const Place& place, const std::string& file,
               const Letters& letters) {
  const auto switching = letters.switching(command);
  if (!switching) throw UnknownWord(place, command);
  return {*switching, Word{command[0], 0, text, place.column}, file, place.line, letters};
}

/// A command of this reader's keeps its meaning, whatever a macro makes of it.
bool has_meaning(const std::string& command) {
  if (command.size() < 2 || std::isdigit(static_cast<unsigned char>(command[1])) == 0) return false;
  const double number = std::strtod(command.c_str() + 1, nullptr);
  return meaning_of(command[0], number) != nullptr || without_effect(command[0], number) != nullptr;
}

class Reader {
 public:
  Reader(const std::string& file, const GcodeOptions& options, std::vector<Step>& steps)
      : file_(file), options_(options), letters_(letters_of(options)), state_(options), steps_(steps) {}

  void read(std::string_view words, int line) {
    try {
      run(words, line);
    } catch (const InputError&) {
      if (!options_.unknown) unknown_.fail_if_any();  // this may come of a line that was not read
      throw;
    }
  }

  void finish() {
    if (options_.unknown)
      *options_.unknown = unknown_.counts();
    else
      unknown_.fail_if_any();
  }

 private:
  void run(std::string_view words, int line) {
    if (words.size() > kLineMax)
      throw InputError(Place{file_, line},
                       fmt::format("the line has {} bytes, more than {}", words.size(), kLineMax));
    if (is_passed_over(words, options_)) return;
    try {
      if (options_.macros != nullptr && call_macro(words, line)) return;
      const std::string word = command_in_words(words);
      Block block = word.empty() ? Block(words_of(words, line), file_, line, letters_)
                                 : block_of(word, words, {file_, line, column_of(words)}, file_, letters_);
      state_.run(block, steps_);
    } catch (const UnknownWord& error) {
      unknown_.add(error);
    }
  }

  /// What an unknown command makes of the rest of its line is not known either.
  std::vector<Word> words_of(std::string_view words, int line) const {
    try {
      return lex_line(words, file_, line);
    } catch (const InputError&) {
      const std::string command = first_command(words);
      const bool coded = command.size() > 1 && (command[0] == 'G' || command[0] == 'M') &&
                         std::isdigit(static_cast<unsigned char>(command[1])) != 0;
      if (!coded || has_meaning(command) || letters_.switching(command)) throw;
      throw UnknownWord({file_, line, column_of(words)}, command);
    }
  }

  /// Runs the lines of the macro that this line calls, as if they stood here. False: it calls none.
  bool call_macro(std::string_view words, int line) {
    const std::string command = first_command(words);
    if (!options_.macros->has(command) || has_meaning(command) || letters_.switching(command)) return false;
    const std::string& macros_file = options_.macros->file();
    if (std::ranges::count(calls_, command) > 0)
      throw InputError(Place{file_, line}, fmt::format("macro {} calls itself ({})", command, macros_file));
    if (calls_.size() == kDeepestCall)
      throw InputError(Place{file_, line}, fmt::format("macros are called {} deep", kDeepestCall + 1));
    calls_.push_back(command);
    std::string where = macros_file;
    try {
      for (const MacroLine& macro_line : options_.macros->expand(command, words)) {
        where = to_string(Place{macros_file, macro_line.number});
        if (++macro_lines_ > kMostMacroLines)
          throw InputError(Place{file_, line},
                           fmt::format("macros make more than {} lines", kMostMacroLines));
        run(macro_line.text, line);
      }
    } catch (const InputError& error) {
      const bool here = error.place().file == file_;
      const std::string message = here ? std::string(error.what()).substr(to_string(error.place()).size() + 2)
                                       : std::string(error.what());
      throw InputError(Place{file_, line},
                       here ? fmt::format("in {} ({}): {}", command, where, message) : message);
    }
    calls_.pop_back();
    return true;
  }

  const std::string& file_;
  const GcodeOptions& options_;
  const Letters letters_;
  GcodeState state_;
  std::vector<Step>& steps_;
  UnknownWords unknown_;
  std::vector<std::string> calls_;  // of macros, the outermost first
  int macro_lines_ = 0;
};

}  // namespace

Program parse_gcode(const std::string& text, const std::string& file, const GcodeOptions& options) {
  Program program;
  program.file = file;
  program.sha256 = sha256_hex(text);
  program.steps.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')));
  Reader reader(file, options, program.steps);
  std::string_view rest = text;
  if (rest.starts_with("\xef\xbb\xbf")) rest.remove_prefix(3);  // byte order mark of some editors
  for (int line = 1; !rest.empty(); ++line) reader.read(take_line(rest), line);
  reader.finish();
  for (const Step& step : program.steps)
    if (moves(step)) return program;
  throw InputError(Place{file},
                   text.empty() ? "empty file, at least 1 move is needed" : "0 moves, at least 1 is needed");
}

Program read_gcode(const std::filesystem::path& path, const GcodeOptions& options) {
  return parse_gcode(read_file(path), path.string(), options);
}

}  // namespace understudy::toolpath
