#include "sim/deposition/bead_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sim/deposition/bead_section.h"

namespace understudy::sim {
namespace {

constexpr double kElementLength = 0.1e-3;  // [m], at least
constexpr double kLongest = 2e-3;          // [m]: sag, cooling and pictures see no coarser
constexpr double kShort = kElementLength / 2;
constexpr double kSwell = 1.2;         // of the area, from one short element to the next
constexpr double kPause = 10e-6;       // [m], path without feed that ends an element; less is jitter
constexpr double kSettled = 1e-3;      // [m], path without feed after which an element is done
constexpr double kStraight = 5e-6;     // [m], a path farther beside the element's line begins a new one
constexpr double kSteepest = 1.5;      // surface's path over the tip's
constexpr double kAlong = 0.5;         // likewise, at least, of a line
constexpr double kSameGap = 2e-6;      // [m]
constexpr double kSameSection = 0.03;  // of the area
constexpr double kSameAxis = 0.02;     // [rad]

double round_diameter(double area) { return std::sqrt(4 * area / std::numbers::pi); }

}  // namespace

// Under the surface it lies where it comes out: not on top of what the nozzle ploughs through.
Vec3 PathPoint::foot_W() const {
  return std::isfinite(gap) ? Vec3(tip_W - std::max(0.0, gap) * axis_W) : tip_W;
}

bool BeadBuilder::goes_on(const PathPoint& a, const PathPoint& b, Adhesion adhesion, double volume) const {
  const LaidBead& bead = element_->bead;
  if (!may_grow_ || bead.adhesion != adhesion) return false;
  if (bead.length > kLongest) return false;
  if (heading_.isZero()) return true;
  const Vec3 reach = b.laid_W(adhesion) - bead.from_W;
  if ((reach - reach.dot(heading_) * heading_).norm() > kStraight) return false;
  const double piece = (b.laid_W(adhesion) - a.laid_W(adhesion)).norm();
  if (piece == 0) return true;
  const double area = bead.volume / bead.length;
  if (std::abs(volume / piece - area) > kSameSection * area) return false;
  const bool lies = adhesion != Adhesion::fused && adhesion != Adhesion::unsupported;
  if (lies && std::abs(b.gap - bead.gap) > kSameGap) return false;
  return (b.axis_W - bead.normal_W).norm() < kSameAxis;
}

void BeadBuilder::begin(const PathPoint& at, Adhesion adhesion, int line) {
  close();
  Element e;
  e.bead.from_W = e.bead.to_W = at.laid_W(adhesion);
  e.tip_from_W = e.tip_to_W = at.tip_W;
  e.bead.normal_W = at.axis_W;
  e.bead.adhesion = adhesion;
  e.bead.start_time = e.bead.time = at.time;
  e.bead.start_line = e.bead.line = line;
  e.bead.follows = continuous_;
  e.bead.volume = std::exchange(carried_, 0.0);
  e.worst_gap = at.gap;
  e.bare_before = primed_;
  element_ = e;
  moment_ = 0;
  heading_.setZero();
  may_grow_ = true;
}

void BeadBuilder::extrude(const PathPoint& a, const PathPoint& b, Adhesion adhesion, double volume, int line,
                          const Below& below) {
  const bool same_ground = element_ && std::isfinite(element_->carrier) == std::isfinite(below.carrier);
  if (!same_ground || !goes_on(a, b, adhesion, volume)) begin(a, adhesion, line);
  fused_height_ = below.fused_height;
  element_->carrier = below.carrier;
  grow(a, b, volume, line);
  continuous_ = true;
  idle_path_ = 0;
  primed_ = {};
}

void BeadBuilder::grow(const PathPoint& a, const PathPoint& b, double volume, int line) {
  Element& e = *element_;
  LaidBead& bead = e.bead;
  const double length = (b.laid_W(bead.adhesion) - a.laid_W(bead.adhesion)).norm();
  bead.to_W = b.laid_W(bead.adhesion);
  e.tip_to_W = b.tip_W;
  bead.normal_W = b.axis_W;
  bead.time = b.time;
  bead.line = line;
  bead.length += length;
  bead.path += (b.tip_W - a.tip_W).norm();
  bead.volume += volume;
  if (length > 0) moment_ += 0.5 * (a.gap + b.gap) * length;
  bead.gap = bead.length > 0 ? moment_ / bead.length : b.gap;
  const auto [low, high] = std::minmax(a.gap, b.gap);
  e.worst_gap = bead.adhesion == Adhesion::buried ? std::min(e.worst_gap, low) : std::max(e.worst_gap, high);
  const Vec3 displacement = bead.to_W - bead.from_W;
  if (heading_.isZero() && displacement.norm() >= kElementLength) heading_ = displacement.normalized();
}

// Of the cross-section. Some micrometres at the end of a line, with the volume that the extruder's lag leaves
// there, are hardly thicker than the line, or than the drop that they would be.
double BeadBuilder::area_of(const LaidBead& bead) {
  // Where the ground falls away the surface's path is longer than the strand that was drawn out.
  const double drawn = std::min(bead.length, kSteepest * bead.path), area = bead.volume / drawn;
  if (drawn >= kShort || !bead.follows) return last_area_ = area;
  const double drop = std::cbrt(6 * bead.volume / std::numbers::pi);
  return last_area_ = std::min(area, std::max(kSwell * last_area_, std::numbers::pi / 4 * drop * drop));
}

// Width and height from the volume, once it is known.
void BeadBuilder::settle_section() {
  LaidBead& bead = element_->bead;
  const double gap = bead.adhesion == Adhesion::fused ? fused_height_ : bead.gap;
  const bool pressed = bead.adhesion != Adhesion::unsupported && bead.adhesion != Adhesion::buried &&
                       std::isfinite(gap) && gap > 0;
  // The net displacement: a tip that trembles to and fro draws nothing out.
  bead.length = (bead.to_W - bead.from_W).norm();
  bead.path = (element_->tip_to_W - element_->tip_from_W).norm();
  if (bead.length > 0) {
    const double area = area_of(bead);
    bead.width = bead_width(area, gap);
    bead.height = pressed ? std::min(gap, bead.width) : round_diameter(area);
    if (pressed && bead.width > element_->carrier) {
      bead.width = std::max(element_->carrier, round_diameter(area));
      bead.height = bead_height(area, bead.width);
    }
  }
  // Wider than long by itself, or wider than any line: a blob. A short piece of a line is as wide as the
  // line.
  const bool alone = !bead.follows && !continuous_;
  // A tip that rises draws no line on the ground; some micrometres tell nothing.
  const bool rises = pressed && bead.length < kAlong * bead.path && (!bead.follows || bead.path >= kShort);
  if (bead.length == 0 || rises || (bead.width > bead.length && (alone || bead.width > widest_line_)))
    settle_blob(pressed && !std::isfinite(element_->carrier) ? gap : 0);
  last_width_ = bead.width;
}

// What came out at one place: round, as high as the gap, or a drop where there is none; drawn out a little
// where the tip went on, footprint L w + pi w^2 / 4.
void BeadBuilder::settle_blob(double height) {
  LaidBead& bead = element_->bead;
  constexpr double kPi = std::numbers::pi;
  if (height > 0) {
    const double length = bead.length;
    const double drawn = 2 / kPi * (std::sqrt(length * length + kPi * bead.volume / height) - length);
    bead.width = bead.length > 0 ? std::min(bead.width, drawn) : drawn;
    bead.height = std::min(height, bead.width);
  } else {
    const double drop = std::cbrt(6 * bead.volume / kPi);
    bead.width = bead.length > 0 ? std::min(bead.width, drop) : drop;
    bead.height = bead.width;
  }
}

void BeadBuilder::pause(double path) {
  primed_ = {};
  idle_path_ += path;
  if (idle_path_ > kPause) may_grow_ = continuous_ = false;
  if (idle_path_ > kSettled) close();
}

void BeadBuilder::prime(const BarePath& path) {
  BarePath all = primed_.length > 0 ? primed_ : path;
  if (primed_.length > 0) all.length += path.length;
  pause(path.length);
  primed_ = all;
}

void BeadBuilder::ooze(double volume) { (element_ ? element_->bead.volume : carried_) += volume; }

void BeadBuilder::close() {
  if (!element_) return;
  settle_section();
  const Element done = *element_;
  element_.reset();
  done_(done);
}

}  // namespace understudy::sim
