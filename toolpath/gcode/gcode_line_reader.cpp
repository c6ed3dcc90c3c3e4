#include "toolpath/gcode/gcode_line_reader.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text/trimmed.h"
#include "core/units.h"
#include "toolpath/gcode/gcode_command.h"
#include "toolpath/gcode/gcode_passed_over.h"
#include "toolpath/gcode/gcode_saved_state.h"
#include "toolpath/gcode/gcode_unknown_words.h"
#include "toolpath/gcode/words/gcode_block.h"
#include "toolpath/gcode/words/gcode_lexer.h"

namespace understudy::toolpath {
namespace {

constexpr std::size_t kDeepestCall = 20;
constexpr std::size_t kMostSaved = 20;        // names of SAVE_GCODE_STATE
constexpr double kCold = 100 + kCelsiusZero;  // [K], of a nozzle that does not print

bool is_passed_over(std::string_view line, const GcodeOptions& options) {
  if (is_line_without_effect(line)) return true;
  return !options.ignored.empty() && std::ranges::count(options.ignored, first_command(line)) > 0;
}

/// The line of a firmware's command in words: it switches coordinates, or is not known.
Block block_of(const std::string& command, std::string_view text, const Place& place, const std::string& file,
               const Letters& letters) {
  const auto switching = letters.switching(command);
  if (!switching) throw UnknownWord(place, command);
  return {*switching, Word{command[0], 0, text, place.column}, file, place.line, letters};
}

/// Whether the line moves the tool to a place that its own words say.
bool says_place(const Block& block) {
  const bool other = block.without_effect() || block.find(Command::home) != nullptr ||
                     block.find(Command::set_position) != nullptr || block.find(Command::dwell) != nullptr ||
                     block.find(Command::retract) != nullptr || block.find(Command::flow) != nullptr;
  return !other && block.find_any("XYZWIJKBC") != nullptr;
}

}  // namespace

class GcodeLineReader::Lines {
 public:
  Lines(const std::string& file, const GcodeOptions& options, std::vector<Step>& steps)
      : file_(file), options_(options), letters_(letters_of(options)), state_(options), steps_(steps) {
    if (options.passed_over != nullptr) over_.emplace(file_, letters_);
  }

  void read(std::string_view words, int line) {
    said_place_ = false;
    take_comment(trimmed(words));
    if (over_) over_->before(state_, steps_.size());
    try {
      run(words, line);
      if (over_) over_->after(line, state_, steps_);
    } catch (const InputError& error) {
      if (over_ && calls_.empty() && over_->pass_over(words, line, error, state_, steps_)) return;
      if (over_ && !at_once_) return refuse(words, error);
      if (!options_.unknown) unknown_.fail_if_any();  // this may come of a line that was not read
      throw;
    }
  }

  void read_or_undo(std::string_view words, int line) {
    undo_.emplace(state_, steps_.size());
    try {
      at_once_ = true;
      read(words, line);
    } catch (const InputError&) {
      undo();
      throw;
    }
  }

  void undo() {
    if (!undo_) return;
    state_ = undo_->first;
    steps_.resize(std::min(undo_->second, steps_.size()));
    calls_.clear();
    undo_.reset();
  }

  const GcodeState& state() const { return state_; }
  bool said_place() const { return said_place_; }
  const Letters& letters() const { return letters_; }

  void finish() {
    if (options_.extrusion != nullptr) *options_.extrusion = state_.extruder().tally();
    if (options_.refused != nullptr)
      *options_.refused = refused_;
    else
      fail_if_refused();
    if (options_.unknown)
      *options_.unknown = unknown_.counts();
    else
      unknown_.fail_if_any();
    if (!over_) return;
    over_->finish(state_);
    *options_.passed_over = over_->found();
  }

 private:
  /// KISSlicer's words for a firmware whose E counts on: its programs have no M83.
  void take_comment(std::string_view words) {
    if (words.starts_with("; KISSlicer")) of_kisslicer_ = true;
    if (of_kisslicer_ && words == "; firmware_type = 1") state_.extrude_relative();
  }

  /// Goes on as if the line were not there, to tell what else is wrong.
  void refuse(std::string_view words, const InputError& error) {
    over_->undo(state_, steps_);
    calls_.clear();
    refused_.add(error, first_command(words));
    const auto all = static_cast<int>(over_->found().size()) + refused_.lines;
    if (options_.refused == nullptr && all > kMostPassedOver) fail_if_refused();
  }

  /// With the lines that are passed over, of which this may come, and with unknown words.
  void fail_if_refused() const {
    if (refused_.lines == 0) return;
    std::vector<PassedOver> lines = over_->found();
    std::string ignorable;
    for (const RefusedLine& line : refused_.told) {
      lines.push_back({line.line, line.column, 0, line.why, {}, 0, true});
      if (can_be_ignored(line.command) && ignorable.find(line.command) == std::string::npos)
        ignorable += (ignorable.empty() ? "" : ",") + line.command;
    }
    std::ranges::stable_sort(lines, {}, &PassedOver::line);
    if (!ignorable.empty())
      lines.back().why += fmt::format("; `--ignore {}` passes over such lines", ignorable);
    try {
      if (!options_.unknown) unknown_.fail_if_any();
    } catch (const InputError& error) {
      const std::string unknown = without_place(error);
      lines.insert(lines.begin(), {error.place().line, error.place().column, 0, unknown, {}, 0, true});
    }
    refuse_passed_over(file_, lines);
  }

  void run(std::string_view words, int line) {
    if (words.size() > kGcodeLineMax)
      throw InputError(Place{file_, line},
                       fmt::format("the line has {} bytes, more than {}", words.size(), kGcodeLineMax));
    if (is_passed_over(words, options_)) return heat_in_place_of(words, line);
    try {
      if (keeps_state(words, line)) return;
      if (options_.macros != nullptr && call_macro(words, line)) return;
      const std::string word = command_in_words(words);
      Block block = word.empty() ? Block(words_of(words, line), file_, line, letters_)
                                 : block_of(word, words, {file_, line, column_of(words)}, file_, letters_);
      if (over_) over_->check(block);
      said_place_ = calls_.empty() && says_place(block);  // before its words are used up
      state_.run(block, steps_);
      if (over_) over_->note(block, state_);
    } catch (const UnknownWord& error) {
      if (at_once_) throw;
      unknown_.add(error);
    }
  }

  /// Of an ignored macro that starts the print: a nozzle that is cold still is heated.
  void heat_in_place_of(std::string_view words, int line) {
    if (!options_.ignored_heat || bead_begun_ || is_line_without_effect(words) ||
        command_in_words(words).empty())
      return;
    look_at_steps();
    if (bead_begun_ || nozzle_ > kCold) return;
    Step heat;
    heat.kind = StepKind::temperature;
    heat.X_WT = state_.X_WT();
    heat.temperature = *options_.ignored_heat;
    heat.wait = true;
    heat.line = line;
    steps_.push_back(heat);
  }

  /// At those that came since it was called last.
  void look_at_steps() {
    if (looked_at_ > steps_.size()) looked_at_ = 0;  // some were taken back
    for (; looked_at_ < steps_.size(); ++looked_at_) {
      const Step& step = steps_[looked_at_];
      bead_begun_ = bead_begun_ || step.kind == StepKind::print;
      if (step.kind == StepKind::temperature) nozzle_ = step.temperature;
    }
  }

  /// What an unknown command makes of the rest of its line is not known either; what follows an M without
  /// effect may be a text, as of M115 U3.11.0.
  std::vector<Word> words_of(std::string_view words, int line) const {
    try {
      return lex_line(words, file_, line);
    } catch (const InputError&) {
      const std::string command = first_command(words);
      const bool coded = command.size() > 1 && (command[0] == 'G' || command[0] == 'M') &&
                         std::isdigit(static_cast<unsigned char>(command[1])) != 0;
      if (coded && command[0] == 'M' && without_effect('M', std::strtod(command.c_str() + 1, nullptr)))
        return lex_line(words.substr(0, words.find_first_of("Mm") + command.size()), file_, line);
      if (!coded || has_meaning(command) || letters_.switching(command)) throw;
      throw UnknownWord({file_, line, column_of(words)}, command);
    }
  }

  bool keeps_state(std::string_view words, int line) {
    const Place place{file_, line};
    const auto call = saved_state_call(words, place);
    if (!call) return false;
    if (over_) over_->require_place(place);
    if (!call->save) {
      state_.restore(call->name, call->back, call->speed, place, steps_);
      return true;
    }
    if (saved_names_.insert(call->name).second && saved_names_.size() > kMostSaved)
      throw InputError(place, fmt::format("more than {} names of SAVE_GCODE_STATE", kMostSaved));
    state_.save(call->name);
    return true;
  }

  /// Runs the lines of the macro that this line calls, as if they stood here. False: it calls none.
  bool call_macro(std::string_view words, int line) {
    const std::string command = first_command(words);
    if (!options_.macros->has(command) || has_meaning(command) || letters_.switching(command)) return false;
    if (std::ranges::count(calls_, command) > 0)
      throw InputError(Place{file_, line},
                       fmt::format("macro {} calls itself ({})", command, options_.macros->file()));
    if (calls_.size() == kDeepestCall)
      throw InputError(Place{file_, line}, fmt::format("macros are called {} deep", kDeepestCall + 1));
    calls_.push_back(command);
    std::string where = options_.macros->file();
    try {
      for (const MacroLine& macro_line : options_.macros->expand(command, words, macros_left_)) {
        where = to_string(Place{options_.macros->files()[macro_line.file], macro_line.number});
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
  std::optional<LinesPassedOver> over_;  // nothing: such lines are errors
  std::set<std::string> saved_names_;
  std::vector<std::string> calls_;  // of macros, the outermost first
  MacroBudget macros_left_;
  bool said_place_ = false;
  bool of_kisslicer_ = false;
  std::size_t looked_at_ = 0;  // steps
  bool bead_begun_ = false;
  double nozzle_ = 0;  // [K], of the last of them that says it
  RefusedLines refused_;
  std::optional<std::pair<GcodeState, std::size_t>> undo_;  // before the last line; number of steps
  bool at_once_ = false;  // unknown words are told by the line that has them
};

GcodeLineReader::GcodeLineReader(const std::string& file, const GcodeOptions& options,
                                 std::vector<Step>& steps)
    : lines_(std::make_unique<Lines>(file, options, steps)) {}
GcodeLineReader::~GcodeLineReader() = default;

void GcodeLineReader::read(std::string_view line, int number) { lines_->read(line, number); }
void GcodeLineReader::read_or_undo(std::string_view line, int number) { lines_->read_or_undo(line, number); }
void GcodeLineReader::undo() { lines_->undo(); }
void GcodeLineReader::finish() { lines_->finish(); }
const GcodeState& GcodeLineReader::state() const { return lines_->state(); }
const Letters& GcodeLineReader::letters() const { return lines_->letters(); }
bool GcodeLineReader::said_place() const { return lines_->said_place(); }

}  // namespace understudy::toolpath
