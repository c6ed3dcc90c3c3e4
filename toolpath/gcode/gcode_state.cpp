#include "toolpath/gcode/gcode_state.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <fmt/format.h>

namespace understudy::toolpath {
namespace {

constexpr const char* kMotionWords = "XYZBCEWIJKR";
constexpr double kLongestDwell = 86400;                   // [s]
constexpr int kLeastPercent = 1, kLargestPercent = 1000;  // of M220 and M221

/// Of F, in units of `unit` [m] a minute, or one over minutes: what takes for ever is none.
bool is_feed(double value, double unit) {
  constexpr double kLongest = 1e6;  // [m], of paths and of filament
  return value > 0 && std::isfinite(kLongest / (value * unit / 60)) && std::isfinite(60 / value);
}

bool tip_moves(const Pose& from, const Pose& to) { return from.translation() != to.translation(); }

}  // namespace

GcodeState::GcodeState(const GcodeOptions& options)
    : position_(options),
      extruder_(options.relative_extrusion),
      corner_velocity_change_(options.corner_velocity_change),
      chords_max_(options.chords_max) {}

void GcodeState::run(Block& block, std::vector<Step>& steps) {
  if (block.empty()) return;
  if (block.without_effect()) return;
  if (ended_) return check_nothing_moves(block);
  set_modes(block);
  set_feed(block);
  set_process(block, steps);
  run_motion(block, steps);
  block.check_all_taken();
  if (block.find(Command::end) != nullptr) {
    steps.push_back(step(StepKind::end, block.line()));
    ended_ = true;
  }
}

/// After M2 or M30 a controller reads nothing more; slicers put their footers there.
void GcodeState::check_nothing_moves(const Block& block) {
  const bool renames = block.find(Command::set_position) != nullptr;
  if (block.find(Command::home) != nullptr || (!renames && block.find_any(kMotionWords) != nullptr))
    block.fail("a move after the end of the program (M2, M30): the controller stops there");
}

void GcodeState::set_modes(const Block& block) {
  if (block.find(Command::inches) != nullptr) unit_ = kInch;
  if (block.find(Command::millimetres) != nullptr) unit_ = kMillimetre;
  if (block.find(Command::absolute) != nullptr) relative_ = false;
  if (block.find(Command::relative) != nullptr) relative_ = true;
  if (block.find(Command::absolute_extrusion) != nullptr) extruder_.set_relative(false);
  if (block.find(Command::relative_extrusion) != nullptr) extruder_.set_relative(true);
  if (block.find(Command::rapid) != nullptr) motion_ = Motion::rapid;
  if (block.find(Command::linear) != nullptr) motion_ = Motion::linear;
  if (block.find(Command::clockwise_arc) != nullptr) motion_ = Motion::clockwise_arc;
  if (block.find(Command::counterclockwise_arc) != nullptr) motion_ = Motion::counterclockwise_arc;
  if (block.find(Command::spline) != nullptr) motion_ = Motion::spline;
  if (block.find(Command::plane_xy) != nullptr) plane_normal_ = 2;
  if (block.find(Command::plane_zx) != nullptr) plane_normal_ = 1;
  if (block.find(Command::plane_yz) != nullptr) plane_normal_ = 0;
  if (block.find(Command::inverse_time) != nullptr) inverse_time_ = true;
  // A feed does not survive a change of what it means.
  if (block.find(Command::inverse_time) != nullptr) feed_.reset();
  if (block.find(Command::per_minute) != nullptr) inverse_time_ = false;
  position_.set_coordinates(block);
  position_.select_work_offset(block);
}

void GcodeState::take_modes(Block& block) {
  set_modes(block);
  const Word* word = block.take('F');
  if (word != nullptr && is_feed(word->value, unit_) && !inverse_time_) feed_ = word->value * unit_ / 60;
}

void GcodeState::take_end(Block& block) {
  position_.move(block, unit_, relative_);
  fed_filament(block);
}

void GcodeState::rejoin(const Pose& from, double filament, int line, std::vector<Step>& steps) const {
  constexpr double kUsualFeed = 0.03;   // [m/s], of filament at rest, where the program has said none yet
  constexpr double kNoFilament = 1e-9;  // [m]: rounding
  if (!from.isApprox(position_.X_WT(), 0)) steps.push_back(step(StepKind::travel, line));
  if (std::abs(filament) < kNoFilament) return;
  steps.push_back(step(filament > 0 ? StepKind::print : StepKind::move, line));
  steps.back().filament = filament;
  steps.back().duration = std::abs(filament) / feed_.value_or(kUsualFeed);
}

void GcodeState::set_feed(Block& block) {
  duration_.reset();
  if (block.find(Command::retraction) != nullptr) return;  // its F is that of G10
  const Word* word = block.take('F');
  if (word == nullptr) return;
  const bool homing = block.find(Command::home) != nullptr;
  const double feed = word->value * unit_ / 60;
  const double duration = 60 / word->value;
  if (!is_feed(word->value, unit_))
    block.fail(*word, fmt::format("'{}': the feed must be above 0", word->text));
  if (homing) return;  // of this line alone, and home is reached as fast as the machine may
  if (!inverse_time_) {
    feed_ = feed;
    return;
  }
  const bool moves = ((motion_ == Motion::linear || is_curve()) && block.find_any(kMotionWords) != nullptr) ||
                     (motion_ == Motion::rapid && block.find('E') != nullptr);
  if (!moves)
    block.fail(*word, fmt::format("'{}': under G93 an F belongs to the G1 move of its line", word->text));
  duration_ = duration;
}

void GcodeState::set_process(Block& block, std::vector<Step>& steps) {
  set_acceleration(block);  // its T is no tool, its R no arc's
  extruder_.select(block);
  set_nozzle(block, steps);
  set_fan(block, steps);
  extruder_.set_retraction(block, unit_);
  if (block.find(Command::flow) != nullptr)
    if (const auto flow = percent(block, "flow")) extruder_.set_flow(*flow / 100);
  if (block.find(Command::speed) != nullptr)
    if (const auto speed = percent(block, "speed")) speed_ = *speed / 100;
}

void GcodeState::set_nozzle(Block& block, std::vector<Step>& steps) {
  const Word* wait = block.find(Command::heat_and_wait);
  const Word* command = wait != nullptr ? wait : block.find(Command::heat);
  const bool tool = command == nullptr && sets_tool(block);
  if (tool) {
    command = block.find(Command::retract);
    block.take('P');
    if (block.take('R') != nullptr && block.find('S') == nullptr) return;  // of a tool that stands by
  }
  if (command == nullptr) return;
  const auto cooling = wait != nullptr ? block.extract('R') : std::nullopt;  // waits while it cools, too
  const Word* s = cooling ? &*cooling : block.take('S');
  const auto machinekit = s == nullptr && !tool ? block.extract('P') : std::nullopt;
  if (machinekit) s = &*machinekit;
  if (s == nullptr) block.fail(*command, fmt::format("'{}' needs S, the temperature in C", command->text));
  if (s->value < 0) block.fail(*s, fmt::format("'{}': the nozzle temperature is below 0 C", s->text));
  steps.push_back(step(StepKind::temperature, block.line()));
  steps.back().temperature = s->value + kCelsiusZero;
  steps.back().wait = wait != nullptr;
}

/// G10 P0 S200: RepRapFirmware's, of the tool P. Of the tool's place it does not speak.
bool GcodeState::sets_tool(const Block& block) const {
  return block.find(Command::retract) != nullptr && block.find('L') == nullptr &&
         block.find('P') != nullptr && (block.find('S') != nullptr || block.find('R') != nullptr);
}

/// P names a fan; all but the first cool something else. Without S the fan runs at full speed.
void GcodeState::set_fan(Block& block, std::vector<Step>& steps) {
  const Word* on = block.find(Command::fan_on);
  const Word* off = block.find(Command::fan_off);
  if (on == nullptr && off == nullptr) return;
  const Word* p = block.take('P');
  const bool other = p != nullptr && p->value != 0;
  if (on == nullptr) {
    if (!other) steps.push_back(step(StepKind::fan, block.line()));
    return;
  }
  const Word* s = block.take('S');
  if (s != nullptr && (s->value < 0 || s->value > 255))
    block.fail(*s, fmt::format("'{}': the fan's speed is outside 0 to 255", s->text));
  if (other) return;
  steps.push_back(step(StepKind::fan, block.line()));
  steps.back().fan = s == nullptr ? 1 : s->value / 255;
}

/// Without S the firmware tells the value, or (M221 X0 Y0 Z0) switches its soft limits.
std::optional<double> GcodeState::percent(Block& block, const char* what) const {
  const Word* s = block.take('S');
  if (s == nullptr || s->bare) {
    for (const char letter : {'X', 'Y', 'Z', 'R'}) block.extract(letter);
    return std::nullopt;
  }
  if (s->value < kLeastPercent || s->value > kLargestPercent)
    block.fail(
        *s, fmt::format("'{}': the {} is outside {} to {} %", s->text, what, kLeastPercent, kLargestPercent));
  return s->value;
}

/// M204: P of moves that feed filament, T of the others, S of both. R is of retractions, which no move is.
void GcodeState::set_acceleration(Block& block) {
  if (block.find(Command::acceleration) == nullptr) return;
  block.extract('R');
  const auto set = [&](char letter, std::initializer_list<double*> accelerations) {
    const auto word = block.extract(letter);
    if (!word) return;
    const double value = length_of(block, *word, unit_);
    if (!(value > 0))
      block.fail(*word, fmt::format("'{}': an acceleration is in mm/s^2, above 0", word->text));
    for (double* acceleration : accelerations) *acceleration = value;
  };
  set('S', {&acceleration_, &travel_acceleration_});
  set('P', {&acceleration_});
  set('T', {&travel_acceleration_});
}

void GcodeState::run_motion(Block& block, std::vector<Step>& steps) {
  if (block.find(Command::dwell) != nullptr) return dwell(block, steps);
  if (block.find(Command::home) != nullptr) return home(block, steps);
  if (block.find(Command::set_position) != nullptr) return set_position(block);
  if (block.find(Command::retract) != nullptr || block.find(Command::unretract) != nullptr)
    return sets_tool(block) ? void() : retract(block, steps);
  const Word* word = block.find_any(kMotionWords);
  const Word* in_machine = block.find(Command::machine_position);
  if (in_machine != nullptr && block.find_any("XYZBC") == nullptr)
    block.fail(*in_machine, fmt::format("'{}' needs X Y Z {}of a G0 or G1 on its line", in_machine->text,
                                        position_.rotary_letters()));
  if (word != nullptr && motion_ == Motion::none)
    block.fail(*word, fmt::format("'{}' before any G0 or G1", word->text));
  if (word != nullptr && motion_ == Motion::spline) return move_along_spline(block, steps);
  if (word != nullptr) return is_arc() ? move_along_arc(block, steps) : move(block, steps);
  const Word* code = block.find(motion_ == Motion::rapid ? Command::rapid : Command::linear);
  // A lone "G1 F1500" is how slicers set the feed, "G0 G17 G90" how others choose modes; a lone "G1" is a
  // line that lost its words.
  if (code != nullptr && block.find('F') == nullptr && block.commands() == 1)
    block.fail(*code, fmt::format("'{}' has neither motion nor extrusion nor feed", code->text));
}

void GcodeState::dwell(Block& block, std::vector<Step>& steps) {
  const Word& code = *block.find(Command::dwell);
  const Word* milliseconds = block.take('P');
  const Word* seconds = block.take('S');
  if (milliseconds != nullptr && seconds != nullptr)
    block.fail(code, "G4 needs either P (milliseconds) or S (seconds), not both");
  const Word& word = seconds != nullptr ? *seconds : milliseconds != nullptr ? *milliseconds : code;
  // Alone it waits until the moves before it have ended.
  const double duration = seconds != nullptr        ? seconds->value
                          : milliseconds != nullptr ? milliseconds->value * 1e-3
                                                    : 0;
  if (duration < 0 || duration > kLongestDwell)
    block.fail(word, fmt::format("'{}': the dwell is outside 0 to {} s", word.text, kLongestDwell));
  steps.push_back(step(StepKind::dwell, block.line()));
  steps.back().duration = duration;
}

/// G10 and G11 as firmwares have them; G10 L2 is of another kind.
void GcodeState::retract(Block& block, std::vector<Step>& steps) {
  const bool back = block.find(Command::unretract) != nullptr;
  if (!back && block.find('L') != nullptr) return position_.set_work_offset(block, unit_, relative_);
  const FedAtRest fed = extruder_.retract(block);
  if (fed.filament == 0) return;
  steps.push_back(step(back ? StepKind::print : StepKind::move, block.line()));
  steps.back().filament = fed.filament;
  steps.back().duration = fed.duration;
}

void GcodeState::home(Block& block, std::vector<Step>& steps) {
  const bool whole = position_.go_home(block);
  steps.push_back(step(whole ? StepKind::home : StepKind::travel, block.line()));
}

void GcodeState::set_position(Block& block) {
  const Word& code = *block.find(Command::set_position);
  if (block.find_any("XYZBCE") == nullptr)
    block.fail(code, fmt::format("G92 names none of X Y Z {}E", position_.rotary_letters()));
  position_.rename(block, unit_);
  extruder_.rename(block, unit_);
}

void GcodeState::move(Block& block, std::vector<Step>& steps) {
  // Filament is fed at a feed, whichever of the two words the line has.
  const bool paced = motion_ == Motion::linear || block.find('E') != nullptr;
  const Pose from = position_.X_WT();
  position_.move(block, unit_, relative_);
  Step next = step(paced ? StepKind::move : StepKind::travel, block.line());
  next.filament = fed_filament(block);
  if (next.filament > 0) next.kind = StepKind::print;
  next.acceleration = acceleration_of(next);
  if (paced) set_pace(block, next);
  if (next.filament != 0 && next.duration == 0 && !tip_moves(from, position_.X_WT())) {
    next.duration = std::abs(next.filament) / next.feed;
    next.feed = 0;
  }
  steps.push_back(next);
}

void GcodeState::set_pace(const Block& block, Step& step) const {
  if (inverse_time_ && !duration_) block.fail("G93 needs F, one over the move's minutes, on every G1 line");
  if (!inverse_time_ && !feed_)
    block.fail(fmt::format("{} without a feed: no F on this line or before it", motion_ == Motion::rapid
                                                                                    ? "G0 with E"
                                                                                : is_curve() ? "an arc"
                                                                                             : "G1"));
  step.duration = duration_.value_or(0) / speed_;
  step.feed = inverse_time_ ? 0 : speed_ * *feed_;
}

Step GcodeState::step(StepKind kind, int line) const {
  Step step;
  step.kind = kind;
  step.X_WT = position_.X_WT();
  if (moves(step)) step.rotary = position_.turns();
  step.line = line;
  return step;
}

}  // namespace understudy::toolpath
