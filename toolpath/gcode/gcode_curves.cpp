// Arcs and splines: their words, and the chords that they are read as.
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "toolpath/gcode/curves/gcode_spline.h"
#include "toolpath/gcode/gcode_position.h"
#include "toolpath/gcode/gcode_state.h"

namespace understudy::toolpath {
namespace {

constexpr double kArcTolerance = 2e-6;    // [m], a fiftieth of what a printer places
constexpr double kShortestChord = 50e-6;  // [m]; an eighth of a bead's width
constexpr int kMostArcTurns = 100;

}  // namespace

std::vector<Vec3> GcodePosition::move_along_arc(Block& block, double unit, bool relative, int normal,
                                                bool clockwise, double turn_max) {
  refuse_turns_on_curve(block);
  spline_end_.reset();
  Arc arc;
  arc.from = programmed_;
  arc.normal = normal;
  arc.clockwise = clockwise;
  read_lengths(block, unit, relative);
  arc.to = programmed_;
  if (const auto turns = block.extract('P')) {
    if (!(turns->value >= 1 && turns->value <= kMostArcTurns && turns->value == std::floor(turns->value)))
      block.fail(*turns,
                 fmt::format("'{}': a whole number of turns from 1 to {}", turns->text, kMostArcTurns));
    arc.turns = turns->value;
  }
  read_centre(block, unit, arc);
  X_WT_ = make_pose(Mat3(X_WT_.linear()), programmed_);
  Chords chords = arc_chords(arc, {kArcTolerance, turn_max, kShortestChord});
  if (chords.too_many())
    block.fail(fmt::format("an arc of {:.6g} chords, at most {}", chords.count, kMostArcChords));
  return std::move(chords.ends);
}

void GcodePosition::refuse_turns_on_curve(const Block& block) const {
  const Word* other = block.find_any("WBC");
  if (other != nullptr)
    block.fail(*other, fmt::format("'{}': an arc or spline keeps the tool's orientation", other->text));
  if (const Word* absolute = block.find(Command::machine_position))
    block.fail(*absolute, fmt::format("'{}' goes with G0 and G1 alone", absolute->text));
  if (coordinates_ != Coordinates::tip)
    block.fail("an arc or spline needs X Y Z of the tip (G43.4): here they are slides");
}

/// I J count from the start, P Q from the end, all in the plane XY. Without I J it goes on smoothly from the
/// G5 before it (Marlin, G5; LinuxCNC, G5).
std::vector<Vec3> GcodePosition::move_along_spline(Block& block, double unit, bool relative) {
  refuse_turns_on_curve(block);
  if (const Word* z = block.find('Z'))
    block.fail(*z, fmt::format("'{}': a spline (G5) lies in the plane XY", z->text));
  const auto read = [&](char letter) -> std::optional<double> {
    const auto word = block.extract(letter);
    if (!word) return std::nullopt;
    const double value = length_of(block, *word, unit);
    if (std::abs(value) > kLargestCoordinate)
      block.fail(*word, fmt::format("'{}' is beyond {:.6g} mm", word->text, to_mm(kLargestCoordinate)));
    return value;
  };
  const auto i = read('I'), j = read('J'), p = read('P'), q = read('Q');
  if (!p || !q || i.has_value() != j.has_value() || (!i && !spline_end_))
    block.fail("a spline (G5) needs P Q, from its end, and I J, from its start, unless it follows another");
  const Vec2 first = i ? Vec2(*i, *j) : *spline_end_, last(*p, *q);
  const Vec3 from = programmed_;
  read_lengths(block, unit, relative);
  spline_end_ = -last;
  X_WT_ = make_pose(Mat3(X_WT_.linear()), programmed_);
  return spline_points(
      {from, from + Vec3(first.x(), first.y(), 0), programmed_ + Vec3(last.x(), last.y(), 0), programmed_},
      kArcTolerance);
}

/// I J K count from the start; those across the plane's normal only.
void GcodePosition::read_centre(Block& block, double unit, Arc& arc) const {
  const auto radius = block.extract('R');
  bool offsets = false;
  arc.centre = arc.from;
  for (int i = 0; i < 3; ++i) {
    const auto word = block.extract("IJK"[i]);
    if (!word) continue;
    if (i == arc.normal || radius)
      block.fail(*word,
                 fmt::format("'{}': an arc has R or the centre's two offsets in its plane", word->text));
    arc.centre[i] += length_of(block, *word, unit);
    offsets = true;
  }
  if (radius) {
    const auto centre = arc_centre(arc, length_of(block, *radius, unit));
    if (!centre)
      block.fail(*radius, fmt::format("'{}': no arc of this radius joins points {:.6g} mm apart",
                                      radius->text, to_mm((arc.to - arc.from).norm())));
    arc.centre = *centre;
  } else if (!offsets) {
    block.fail("an arc without a centre: give its offsets I J K from the start, or R");
  } else if (const auto mismatch = arc_mismatch(arc)) {
    block.fail(fmt::format("no arc: its ends differ by {:.6g} mm in their distance from the centre",
                           to_mm(*mismatch)));
  }
}

void GcodeState::count_chords(const Block& block, std::size_t more) {
  chords_ += more;
  if (chords_ > chords_max_)
    block.fail(
        fmt::format("the program's arcs and splines have more than {} chords up to here", chords_max_));
}

/// Of an arc or spline, with the filament and time of the whole.
Step GcodeState::chord(Block& block) {
  Step chord = step(StepKind::move, block.line());
  chord.filament = fed_filament(block);
  if (chord.filament > 0) chord.kind = StepKind::print;
  chord.acceleration = acceleration_of(chord);
  set_pace(block, chord);
  return chord;
}

/// Of filament and time each takes its share of the length.
void GcodeState::move_along_spline(Block& block, std::vector<Step>& steps) {
  Vec3 at_W = position_.X_WT().translation();
  const std::vector<Vec3> ends = position_.move_along_spline(block, unit_, relative_);
  count_chords(block, ends.size());
  const Step whole = chord(block);
  double length = 0;
  for (Vec3 from_W = at_W; const Vec3& end_W : ends) {
    length += (end_W - from_W).norm();
    from_W = end_W;
  }
  for (const Vec3& end_W : ends) {
    const double share = length > 0 ? (end_W - at_W).norm() / length : 1 / static_cast<double>(ends.size());
    Step chord = whole;
    chord.X_WT.translation() = at_W = end_W;
    chord.filament *= share;
    chord.duration *= share;
    steps.push_back(chord);
  }
}

/// Equal chords: of filament and time each takes its share.
void GcodeState::move_along_arc(Block& block, std::vector<Step>& steps) {
  const double turn_max =
      feed_ && !inverse_time_ ? corner_velocity_change_ / (speed_ * *feed_) : corner_velocity_change_;
  const std::vector<Vec3> ends = position_.move_along_arc(block, unit_, relative_, plane_normal_,
                                                          motion_ == Motion::clockwise_arc, turn_max);
  count_chords(block, ends.size());
  Step chord = this->chord(block);
  const auto count = static_cast<double>(ends.size());
  chord.filament /= count;
  chord.duration /= count;
  for (const Vec3& end_W : ends) {
    chord.X_WT.translation() = end_W;
    steps.push_back(chord);
  }
}

}  // namespace understudy::toolpath
