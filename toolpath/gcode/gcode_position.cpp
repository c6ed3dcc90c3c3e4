#include "toolpath/gcode/gcode_position.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::toolpath {
namespace {

// No machine is larger; keeps sums finite.
constexpr double kLargestLength = 1e6;  // [m]
// A hundred thousand turns, of which doubles keep 1e-10 rad.
constexpr double kWholeTurn = 360 * kDegree, kMostTurns = 1000;  // of one move (docs/limits.md)
constexpr double kLargestTurn = 3.6e7 * kDegree;                 // [rad]
// What is left of a tip that does not move when slides and table move around it: rounding, not a path.
constexpr double kNoPath = 1e-12;  // [m]

constexpr const char* kOrientationWords = "WIJK";
constexpr const char* kRotaryWords = "BC";
constexpr const char* kNoSlides = "the machine's file does not say, under gcode.words, which axes X Y Z are";

}  // namespace

double length_of(const Block& block, const Word& word, double unit) {
  const double value = word.value * unit;
  if (std::abs(value) > kLargestLength)
    block.fail(word, fmt::format("'{}' is {:.6g} mm, beyond {:.6g} mm", word.text, to_mm(value),
                                 to_mm(kLargestLength)));
  return value;
}

GcodePosition::GcodePosition(const GcodeOptions& options)
    : options_(std::make_shared<const GcodeOptions>(options)),
      coordinates_(options.rotary ? options.rotary->coordinates : Coordinates::tip) {
  if (options.extruder_letter != 'E' &&
      std::string_view(kRotaryLetters).find(options.extruder_letter) == std::string_view::npos)
    throw InputError(fmt::format("extruder on '{}': one of E, {}", options.extruder_letter,
                                 fmt::join(std::string_view(kRotaryLetters), ", ")));
  if (options.rotary && options.rotary->letters.find(options.extruder_letter) != std::string::npos)
    throw InputError(
        fmt::format("extruder on '{}': that turns an axis of this machine", options.extruder_letter));
  for (const int sign : {options.b_sign, options.c_sign})
    if (std::abs(sign) != 1)
      throw InputError(fmt::format("the sign of a rotary axis is {}: one of -1, 1", sign));
  if (coordinates_ == Coordinates::machine && options.rotary && !options.rotary->slides)
    throw InputError(fmt::format("coordinates 'machine': {}", kNoSlides));
  if (!(options.offset_W.cwiseAbs().maxCoeff() <= kLargestCoordinate))
    throw InputError(fmt::format("the program's offset is beyond {:g} mm", to_mm(kLargestCoordinate)));
  go_home();
}

std::string GcodePosition::rotary_letters() const {
  return options_->rotary ? fmt::format("{} ", fmt::join(options_->rotary->letters, " ")) : "";
}

void GcodePosition::set_coordinates(const Block& block) {
  const Word* tip = block.find(Command::tip_coordinates);
  const Word* machine = block.find(Command::machine_coordinates);
  const Word* word = tip != nullptr ? tip : machine;
  if (word == nullptr) return;
  if (!options_->rotary) block.fail(*word, fmt::format("'{}': this machine has no rotary axes", word->text));
  if (coordinates_ == Coordinates::crossing)
    block.fail(*word, fmt::format("'{}' in a program that is read as slides of axes that cross at its origin",
                                  word->text));
  const Coordinates next = tip != nullptr ? Coordinates::tip : Coordinates::machine;
  if (next == coordinates_) return;
  // A shift of the slides is none of the tip, once the table has turned.
  if (origin_ != shift())
    block.fail(*word, fmt::format("'{}' while X Y Z are shifted by G92 or a work offset: G28 ends the shift "
                                  "of G92, G10 L2 P0 X0 Y0 Z0 that of the work offset",
                                  word->text));
  if (next == Coordinates::machine) {
    require_turns(*word, block, false);
    if (!options_->rotary->slides) block.fail(*word, fmt::format("'{}': {}", word->text, kNoSlides));
  }
  coordinates_ = next;
  programmed_ = programmed_at(X_WT_);
}

Vec3 GcodePosition::shift() const {
  return coordinates_ == Coordinates::crossing ? Vec3::Zero() : options_->offset_W;
}

Vec3 GcodePosition::origin() const { return shift() + work_.active(); }

Vec3 GcodePosition::programmed_at(const Pose& X_WT) const {
  const Vec3 p_WT = X_WT.translation();
  if (coordinates_ == Coordinates::machine) return options_->rotary->slides(p_WT, turns_->b, turns_->c);
  if (coordinates_ == Coordinates::tip) return p_WT;
  return crossing().inverse() * Vec3(p_WT - options_->offset_W);
}

/// From X Y Z of slides whose turning axes cross at the program's origin, to the tip seen from there.
Pose GcodePosition::crossing() const {
  const auto& [b, c] = *turns_;
  if (options_->rotary->crossing) return options_->rotary->crossing(b, c);
  return make_pose(Mat3(options_->rotary->tip_pose(Vec3::Zero(), b, c).linear()), Vec3::Zero());
}

Pose GcodePosition::pose_at_programmed() const {
  const auto& [b, c] = *turns_;
  if (coordinates_ == Coordinates::machine) return options_->rotary->slides_pose(programmed_, b, c);
  Pose X_WT = options_->rotary->tip_pose(programmed_, b, c);
  if (coordinates_ == Coordinates::crossing)
    X_WT.translation() = options_->offset_W + crossing() * programmed_;
  return X_WT;
}

void GcodePosition::go_home() {
  X_WT_ = options_->X_WT_home;
  if (options_->rotary) turns_ = {options_->rotary->b_home, options_->rotary->c_home};
  programmed_ = programmed_at(X_WT_);
  origin_ = origin();
  turns_origin_ = {};
}

bool GcodePosition::go_home(Block& block) {
  spline_end_.reset();
  const std::string_view axes =
      std::string_view("XYZBC").substr(0, 3 + (options_->rotary ? options_->rotary->letters.size() : 0));
  const auto named = [&](char letter) { return block.take(letter) != nullptr; };
  const auto count = std::count_if(axes.begin(), axes.end(), named);
  const bool whole = count == 0 || count == std::ssize(axes);
  whole ? go_home() : home_some(block);
  return whole;
}

/// Slides where the machine's words are theirs, else the tip's coordinates.
void GcodePosition::home_some(const Block& block) {
  const bool rotary = options_->rotary.has_value(), slides = rotary && options_->rotary->slides;
  const Vec3 p_home = options_->X_WT_home.translation();
  Vec3 p = X_WT_.translation(), home = p_home;
  if (rotary) require_turns(*block.find_any("XYZBC"), block, false);
  if (slides) {
    p = options_->rotary->slides(p, turns_->b, turns_->c);
    home = options_->rotary->slides(p_home, options_->rotary->b_home, options_->rotary->c_home);
  }
  for (int i = 0; i < 3; ++i) {
    if (block.find("XYZ"[i]) == nullptr) continue;
    p[i] = home[i];
    origin_[i] = origin()[i];
  }
  if (block.find('B') != nullptr) turns_->b = options_->rotary->b_home, turns_origin_.b = 0;
  if (block.find('C') != nullptr) turns_->c = options_->rotary->c_home, turns_origin_.c = 0;
  X_WT_ = slides   ? options_->rotary->slides_pose(p, turns_->b, turns_->c)
          : rotary ? options_->rotary->tip_pose(p, turns_->b, turns_->c)
                   : make_pose(Mat3(X_WT_.linear()), p);
  programmed_ = programmed_at(X_WT_);
}

/// [rad] of 1 in the first or the second rotary word.
double GcodePosition::turn_unit(int word) const {
  if (!options_->rotary) return 0;
  return word == 0 ? options_->b_sign * options_->rotary->b_unit
                   : options_->c_sign * options_->rotary->c_unit;
}

void GcodePosition::rename(Block& block, double unit) {
  for (int i = 0; i < 3; ++i)
    if (const Word* word = block.take("XYZ"[i])) origin_[i] = programmed_[i] - length_of(block, *word, unit);
  const auto rename_turn = [&](char letter, double RotaryTurns::*axis, double unit_of_turn) {
    const Word* word = block.take(letter);
    if (word == nullptr) return;
    require_turns(*word, block, false);
    turns_origin_.*axis = (*turns_).*axis - unit_of_turn * word->value;
  };
  rename_turn('B', &RotaryTurns::b, turn_unit(0));
  rename_turn('C', &RotaryTurns::c, turn_unit(1));
}

void GcodePosition::select_work_offset(const Block& block) {
  const Vec3 before = work_.active();
  work_.select(block);
  origin_ += work_.active() - before;
}

void GcodePosition::take_shifts(const GcodePosition& saved) {
  origin_ = work_.active() + (saved.origin_ - saved.work_.active());
  turns_origin_ = saved.turns_origin_;
}

bool GcodePosition::go_back_to(const GcodePosition& saved) {
  if (options_->rotary) return false;
  spline_end_.reset();
  programmed_ = saved.programmed_;
  X_WT_ = make_pose(Mat3(X_WT_.linear()), programmed_);
  return true;
}

void GcodePosition::set_work_offset(Block& block, double unit, bool relative) {
  const Vec3 before = work_.active();
  // What the axes would read if no work offset counted: a shift by G92 goes on.
  work_.set(block, unit, relative, programmed_ - origin_ + before);
  origin_ += work_.active() - before;
}

void GcodePosition::move(Block& block, double unit, bool relative) {
  spline_end_.reset();
  if (block.find_any("XYZWIJKBC") == nullptr) return;
  refuse_two_orientations(block);
  read_lengths(block, unit, relative);
  const bool turned = read_turns(block, relative);
  if (const std::optional<Quat> orientation = read_orientation(block)) {
    X_WT_ = make_pose(*orientation, programmed_);
    turns_.reset();
  } else if (coordinates_ != Coordinates::tip) {
    const Vec3 before = X_WT_.translation();
    X_WT_ = pose_at_programmed();
    if ((X_WT_.translation() - before).norm() <= kNoPath) X_WT_.translation() = before;
  } else if (turned) {
    X_WT_ = pose_at_programmed();
  } else {
    X_WT_ = make_pose(Mat3(X_WT_.linear()), programmed_);
  }
}

void GcodePosition::refuse_two_orientations(const Block& block) const {
  const Word* rotary = block.find_any(kRotaryWords);
  const Word* vector = block.find_any(kOrientationWords);
  if (vector != nullptr && coordinates_ != Coordinates::tip)
    block.fail(*vector,
               fmt::format("'{}': tool axis words need tool-centre-point coordinates (G43.4)", vector->text));
  if (rotary != nullptr && vector != nullptr)
    block.fail(*rotary, fmt::format("'{}' cannot share a line with '{}': orientation is either {}or W I J K",
                                    rotary->text, vector->text, rotary_letters()));
}

void GcodePosition::read_lengths(Block& block, double unit, bool relative) {
  const bool in_machine = block.find(Command::machine_position) != nullptr;
  for (int i = 0; i < 3; ++i) {
    const Word* word = block.take("XYZ"[i]);
    if (word == nullptr) continue;
    double& p = programmed_[i];
    p = (in_machine ? shift()[i] : relative ? p : origin_[i]) + length_of(block, *word, unit);
    if (std::abs(p) > kLargestCoordinate)
      block.fail(*word, fmt::format("'{}' leads to {:.6g} mm, beyond {:.6g} mm", word->text, to_mm(p),
                                    to_mm(kLargestCoordinate)));
  }
}

/// Whether the line has B or C.
bool GcodePosition::read_turns(Block& block, bool relative) {
  const Word* b = block.take('B');
  const Word* c = block.take('C');
  if (b == nullptr && c == nullptr) return false;
  const bool in_machine = block.find(Command::machine_position) != nullptr;
  relative = relative && !in_machine;
  require_turns(b != nullptr ? *b : *c, block,
                !relative && b != nullptr && (c != nullptr || options_->rotary->letters.size() == 1));
  RotaryTurns turns = turns_.value_or(RotaryTurns{});
  const auto read = [&](const Word* word, double RotaryTurns::*axis, double unit_of_turn) {
    if (word == nullptr) return;
    const double before = in_machine ? 0 : relative ? turns.*axis : turns_origin_.*axis;
    turns.*axis = before + unit_of_turn * word->value;
    if (!(std::abs(turns.*axis) <= kLargestTurn))
      block.fail(*word, fmt::format("'{}' leads to {:.10g} deg, beyond {:.10g} deg", word->text,
                                    to_deg(turns.*axis), to_deg(kLargestTurn)));
    const double by = std::abs(turns.*axis - (turns_ ? (*turns_).*axis : 0));
    if (by > kMostTurns * kWholeTurn)
      block.fail(*word, fmt::format("'{}' turns {:.0f} times, more than {:.0f} in one move", word->text,
                                    by / kWholeTurn, kMostTurns));
  };
  read(b, &RotaryTurns::b, turn_unit(0));
  read(c, &RotaryTurns::c, turn_unit(1));
  turns_ = turns;
  return true;
}

/// Throws where the program itself does not say how the axes stand: the tool's axis alone leaves that open.
void GcodePosition::require_turns(const Word& word, const Block& block, bool both_given) const {
  if (turns_ || both_given) return;
  block.fail(word,
             fmt::format("'{}' after an orientation by I J K: {} are not known before a line with both, "
                         "absolute (G90), or G28",
                         word.text, fmt::join(options_->rotary->letters, " and ")));
}

std::optional<Quat> GcodePosition::read_orientation(Block& block) const {
  const Word* first = block.find_any(kOrientationWords);
  if (first == nullptr) return std::nullopt;
  const Word* w = block.take('W');
  const Word* vector[3] = {block.take('I'), block.take('J'), block.take('K')};
  for (int i = 0; i < 3; ++i)
    if (vector[i] == nullptr)
      block.fail(*first, fmt::format("orientation without {}: give W I J K (quaternion) or I J K (tool axis)",
                                     "IJK"[i]));
  const Vec3 v(vector[0]->value, vector[1]->value, vector[2]->value);
  const double norm = w != nullptr ? std::hypot(w->value, v.stableNorm()) : v.stableNorm();
  if (!(std::abs(norm - 1) <= options_->unit_tolerance))
    block.fail(*first, fmt::format("the {} has length {:.6g}, farther than {:g} from 1",
                                   w != nullptr ? "quaternion W I J K" : "tool axis I J K", norm,
                                   options_->unit_tolerance));
  if (w != nullptr) return Quat(w->value, v.x(), v.y(), v.z()).normalized();
  return shortest_arc_from_z(v.normalized());
}

}  // namespace understudy::toolpath
