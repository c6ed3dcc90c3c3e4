#include "sim/deposition/unsupported_stretch_recorder.h"

#include <algorithm>

namespace understudy::sim {
namespace {

constexpr double kRowOverOwn = 2;  // a line pressed to a gap of 0.1 mm over the strand that it is in the air

bool holds(Adhesion adhesion) { return adhesion == Adhesion::sticks || adhesion == Adhesion::fused; }

/// A strand that goes on after a corner in the air is held there by itself only.
Vec3 middle_of_strand(const Vec3& tip_W, const LaidBead& bead) {
  return tip_W - 0.5 * bead.height * bead.normal_W;
}

}  // namespace

bool UnsupportedStretchRecorder::touches_something(const Vec3& p_W, double diameter,
                                                   std::size_t before) const {
  return workpiece_.nearest(p_W, diameter / 2 + reach_, before).has_value();
}

BarePath UnsupportedStretchRecorder::bare_path(const Element& element) const {
  return element.bead.follows ? fallen_ : element.bare_before;
}

void UnsupportedStretchRecorder::drop(const Element& element) {
  BarePath path = bare_path(element);
  if (path.length == 0) path = {0, element.tip_from_W, element.bead.start_line};
  path.length += element.bead.path;
  fallen_ = path;
}

void UnsupportedStretchRecorder::begin(const Element& element, const Conditions& conditions) {
  const LaidBead& bead = element.bead;
  UnsupportedStretch stretch;
  stretch.adhesion = bead.adhesion;
  stretch.line = bead.start_line;
  stretch.time = bead.start_time;
  stretch.place_W = bead.from_W;
  stretch.worst_gap = element.worst_gap;
  stretch.highest_gap = conditions.highest_gap;
  stretch.interface_temperature = conditions.interface_temperature;
  stretch.nozzle_temperature = conditions.nozzle_temperature;
  stretch.fan = conditions.fan;
  stretch.bare_before = bare_path(element);
  stretch.width = row_width_ = std::max(least_width_, last_held_width_);
  covered_ = 0;
  stretch.on_printed = bead.follows && last_on_printed_;
  first_bead_ = workpiece_.beads().size();
  if (bead.adhesion == Adhesion::unsupported) {
    const Vec3 start = middle_of_strand(element.tip_from_W, bead);
    stretch.held_at_start =
        (bead.follows && last_held_) || touches_something(start, bead.height, first_bead_);
    stretch.path_W.push_back(start);
    stretch.laid_at.push_back(bead.start_time);
    stretch.lines.push_back(bead.start_line);
  }
  stretches_.push_back(std::move(stretch));
  open_ = true;
}

void UnsupportedStretchRecorder::extend(const Element& element, const Conditions& conditions) {
  const LaidBead& bead = element.bead;
  UnsupportedStretch& stretch = stretches_.back();
  stretch.length += bead.length;
  stretch.volume += bead.volume;
  // Not the widest of it, nor what stuck before at any width: a drop is no beam.
  covered_ += bead.length * bead.width;
  if (stretch.length > 0) {
    const double own = covered_ / stretch.length;
    stretch.width = std::max({least_width_, own, std::min(row_width_, kRowOverOwn * own)});
  }
  stretch.worst_gap = bead.adhesion == Adhesion::buried ? std::min(stretch.worst_gap, element.worst_gap)
                                                        : std::max(stretch.worst_gap, element.worst_gap);
  stretch.interface_temperature = std::min(stretch.interface_temperature, conditions.interface_temperature);
  diameter_ = bead.height;
  if (bead.adhesion != Adhesion::unsupported) return;
  stretch.path_W.push_back(middle_of_strand(element.tip_to_W, bead));
  stretch.laid_at.push_back(bead.time);
  stretch.lines.push_back(bead.line);
}

void UnsupportedStretchRecorder::end(bool held) {
  if (!open_) return;
  UnsupportedStretch& stretch = stretches_.back();
  if (stretch.adhesion == Adhesion::unsupported)
    stretch.held_at_end = held || touches_something(stretch.path_W.back(), diameter_, first_bead_);
  open_ = false;
  if (done_) done_(stretch);
}

void UnsupportedStretchRecorder::add(const Element& element, const Conditions& conditions) {
  const LaidBead& bead = element.bead;
  const bool same = open_ && bead.follows && stretches_.back().adhesion == bead.adhesion;
  if (!same) end(bead.follows && holds(bead.adhesion));
  if (!holds(bead.adhesion)) {
    if (!same) begin(element, conditions);
    extend(element, conditions);
  }
  fallen_ = {};
  last_held_ = holds(bead.adhesion);
  if (last_held_) last_held_width_ = bead.width;
  last_on_printed_ = last_held_ && conditions.on_printed;
}

void UnsupportedStretchRecorder::finish() { end(false); }

}  // namespace understudy::sim
