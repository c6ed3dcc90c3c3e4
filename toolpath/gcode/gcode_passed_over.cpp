#include "toolpath/gcode/gcode_passed_over.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace understudy::toolpath {
namespace {

bool has(std::string_view all, char c) { return all.find(c) != std::string_view::npos; }

/// G91, G92 of a place, G10 L, a change of coordinates: where the tool is not known, neither is what comes.
bool depends_on_place(const Block& block) {
  return block.find(Command::relative) != nullptr || block.find(Command::tip_coordinates) != nullptr ||
         block.find(Command::machine_coordinates) != nullptr ||
         (block.find(Command::set_position) != nullptr && block.find_any("XYZBC") != nullptr) ||
         (block.find(Command::retract) != nullptr && block.find('L') != nullptr);
}

}  // namespace

void refuse_passed_over(const std::string& file, const std::vector<PassedOver>& lines) {
  std::string text = lines.front().why;
  for (std::size_t i = 1; i < lines.size(); ++i)
    text += fmt::format("{} line {}: {}", i == 1 ? "; nor can be read" : ";", lines[i].line, lines[i].why);
  throw InputError(Place{file, lines.front().line, lines.front().column}, text);
}

void LinesPassedOver::before(const GcodeState& state, std::size_t steps) {
  before_ = state;
  steps_before_ = steps;
}

void LinesPassedOver::undo(GcodeState& state, std::vector<Step>& steps) const {
  state = *before_;
  steps.resize(steps_before_);
}

void LinesPassedOver::check(const Block& block) const {
  if (!block.without_effect() && depends_on_place(block)) require_place({file_, block.line(), 0});
}

void LinesPassedOver::require_place(const Place& place) const {
  if (!begin_ || unknown_ == "E") return;
  throw InputError(place, fmt::format("the place of the tool in {} is not known here: line {} cannot be read "
                                      "({})",
                                      fmt::join(unknown_, " "), found_[first_].line, found_[first_].why));
}

void LinesPassedOver::note(const Block& block, const GcodeState& state) {
  if (!begin_ || block.without_effect()) return;
  const bool home = block.find(Command::home) != nullptr;
  const bool whole = home && block.find_any("XYZBC") == nullptr;
  const auto said = [&](char c) {
    if (c == 'W') return whole || (!home && !state.on_arc() && block.find_any("WIJK") != nullptr);
    return block.find(c) != nullptr || (whole && c != 'E');
  };
  // The reading of E is given a new meaning: how much was fed before stays unknown.
  if (has(unknown_, 'E') && block.find(Command::set_position) != nullptr && said('E'))
    found_[first_].filament_known = false;
  std::erase_if(unknown_, said);
}

void LinesPassedOver::after(int line, const GcodeState& state, std::vector<Step>& steps) {
  if (!begin_) return;
  drop_moves(line, steps);
  if (unknown_.empty()) end(line, state, steps);
}

bool LinesPassedOver::pass_over(std::string_view text, int line, const InputError& error, GcodeState& state,
                                std::vector<Step>& steps) {
  undo(state, steps);
  auto words = salvage(text, letters_, state.on_arc());
  if (!words || state.ended()) return false;
  const auto is_place = [](char c) { return c != 'E'; };
  if (words->moves && state.relative() && std::ranges::any_of(words->named, is_place)) return false;
  if (found_.size() == static_cast<std::size_t>(kMostPassedOver)) return false;
  found_.push_back({line, error.place().column, line, without_place(error), {}, 0, true});
  if (!words->moves) return true;
  if (!begin_) {
    begin_ = state;
    first_ = found_.size() - 1;
  }
  take(*words, line, state);
  found_.back().unknown = words->lost;
  if (unknown_.empty()) end(line, state, steps);
  return true;
}

/// Where the tool goes is taken as a whole or, where it makes no pose, not at all.
void LinesPassedOver::take(SalvagedLine& words, int line, GcodeState& state) {
  try {
    Block block(words.words, file_, line, letters_);
    state.take_modes(block);
    const GcodeState with_modes = state;
    try {
      state.take_end(block);
      std::erase_if(unknown_, [&](char c) { return has(words.named, c) && !has(words.lost, c); });
    } catch (const InputError&) {
      state = with_modes;
      words.lost = words.named;
    }
  } catch (const InputError&) {
    words.lost = words.named;
  }
  const bool reads_e = !state.relative_extrusion();
  if (has(words.lost, 'E') && !reads_e) {
    found_.back().filament_known = false;
    std::erase(words.lost, 'E');
  }
  for (const char c : words.lost)
    if (!has(unknown_, c)) unknown_ += c;
}

void LinesPassedOver::drop_moves(int line, std::vector<Step>& steps) {
  const auto first = steps.begin() + static_cast<std::ptrdiff_t>(steps_before_);
  const auto kept =
      std::remove_if(first, steps.end(), [](const Step& step) { return moves(step) || step.filament != 0; });
  if (kept != steps.end()) found_[first_].last_line = line;
  steps.erase(kept, steps.end());
  for (std::size_t i = steps_before_; i < steps.size(); ++i) steps[i].X_WT = begin_->X_WT();
}

void LinesPassedOver::end(int line, const GcodeState& state, std::vector<Step>& steps) {
  finish(state);
  state.rejoin(begin_->X_WT(), begin_->extruder().drawn_back() - state.extruder().drawn_back(), line, steps);
  begin_.reset();
}

void LinesPassedOver::finish(const GcodeState& state) {
  if (!begin_) return;
  PassedOver& first = found_[first_];
  const auto laid = [](const GcodeState& s) { return s.extruder().most_fed(); };
  constexpr double kRounding = 1e-9;  // [m]
  const double filament = laid(state) - laid(*begin_);
  first.filament = filament > kRounding ? filament : 0;
  if (has(unknown_, 'E')) first.filament_known = false;
}

}  // namespace understudy::toolpath
