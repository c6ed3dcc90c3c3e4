#include "sim/process/deposition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace understudy::sim {
namespace {

constexpr double kElementLength = 0.1e-3;  // [m]
constexpr double kPause = 10e-6;           // [m], path without feed that ends a bead; less is jitter at rest
constexpr double kGapJump = 0.5e-3;        // [m], between two snapshots: the axis went over an edge
constexpr double kRounding = 1e-9;         // [m], of a gap: coordinates of 0.1 m through files and rotations

// A point of the tip's path and what is below it.
struct Point {
  double time = 0;
  Vec3 tip_W{0, 0, 0}, axis_W{0, 0, 1};
  double gap = 0;
  Vec3 foot_W() const { return std::isfinite(gap) ? Vec3(tip_W - gap * axis_W) : tip_W; }
};

Point between(const Point& a, const Point& b, double f, double gap) {
  return {a.time + f * (b.time - a.time), a.tip_W + f * (b.tip_W - a.tip_W),
          ((1 - f) * a.axis_W + f * b.axis_W).normalized(), gap};
}

enum class Hold { buried, sticks, loose };

// Share of a linear ramp of the gap that is at or below `level`.
double share_below(double from, double to, double level) {
  const double low = std::min(from, to), high = std::max(from, to);
  if (high <= level) return 1;
  if (low > level || std::isinf(high)) return low > level ? 0 : 0.5;
  return (level - low) / (high - low);
}

// What a bead keeps beside its public face.
struct Growth {
  double start_time = 0;
  int start_line = 0;
  double moment = 0;  // integral of the gap over the length
  double worst_gap = 0;
  Hold hold = Hold::sticks;
  bool follows = false;  // goes on where the bead before it ends
};

struct GapSums {
  double length = 0, below = 0, in_band = 0;
  double surface_length = 0, moment = 0;
  double min = std::numeric_limits<double>::infinity(), max = -min;
};

}  // namespace

struct DepositionObserver::State {
  std::shared_ptr<const geometry::Mesh> part;
  double filament_area = 0;                   // [m^2]
  double accepted_min = 0, accepted_max = 0;  // [m]

  std::optional<Snapshot> last;
  std::optional<double> last_gap;                // of `last`, when it was needed
  double first_filament = 0, most_filament = 0;  // [m]
  std::vector<Bead> beads;
  std::vector<Growth> growths;  // one a bead
  bool open = false;            // the last bead still grows
  bool continuous = false;      // nothing but extrusion since the last bead's end
  double idle_path = 0;         // [m] since then
  std::optional<double> start_gap;
  GapSums sums;

  Hold hold_of(double gap) const {
    if (gap > accepted_max + kRounding) return Hold::loose;
    return gap > kRounding ? Hold::sticks : Hold::buried;
  }

  void pause(double path) {
    idle_path += path;
    if (idle_path > kPause) open = continuous = false;
  }

  void begin_bead(const Point& at, Hold hold, int line) {
    Bead bead;
    bead.from_W = at.foot_W();
    beads.push_back(bead);
    growths.push_back({at.time, line, 0, at.gap, hold, continuous});
    open = true;
  }

  // From a to b nothing changes but linearly.
  void extrude(const Point& a, const Point& b, double volume, int line) {
    const double gap = 0.5 * (a.gap + b.gap);
    const Hold hold = hold_of(gap);
    if (open && growths.back().hold != hold) open = false;
    if (!open) begin_bead(a, hold, line);
    const double length = (b.foot_W() - a.foot_W()).norm();
    grow(beads.back(), growths.back(), a, b, length, volume, line);
    add_to_sums(a.gap, b.gap, length);
    continuous = true;
    idle_path = 0;
    if (beads.back().length >= kElementLength) open = false;
  }

  void grow(Bead& bead, Growth& growth, const Point& a, const Point& b, double length, double volume,
            int line) {
    bead.to_W = b.foot_W();
    bead.normal_W = b.axis_W;
    bead.time = b.time;
    bead.line = line;
    bead.length += length;
    bead.volume += volume;
    bead.sticks = growth.hold == Hold::sticks;
    if (length > 0) growth.moment += 0.5 * (a.gap + b.gap) * length;
    bead.gap = bead.length > 0 ? growth.moment / bead.length : b.gap;
    const auto [low, high] = std::minmax(a.gap, b.gap);
    growth.worst_gap =
        growth.hold == Hold::buried ? std::min(growth.worst_gap, low) : std::max(growth.worst_gap, high);
    if (bead.length > 0) {
      bead.width = bead_width(bead.volume / bead.length, bead.gap);
    } else {  // a blob: round, as high as the gap, or a drop where nothing is below
      const double v = bead.volume / std::numbers::pi;
      bead.width = bead.gap > 0 && std::isfinite(bead.gap) ? std::sqrt(4 * v / bead.gap) : std::cbrt(6 * v);
    }
  }

  void add_to_sums(double from, double to, double length) {
    if (length <= 0) return;
    sums.length += length;
    const double below = share_below(from, to, accepted_min - kRounding);
    sums.below += length * below;
    sums.in_band += length * (share_below(from, to, accepted_max + kRounding) - below);
    if (!std::isfinite(from) || !std::isfinite(to)) return;
    sums.surface_length += length;
    sums.moment += 0.5 * (from + to) * length;
    sums.min = std::min({sums.min, from, to});
    sums.max = std::max({sums.max, from, to});
  }

  // The interval from `fed_from` (a fraction of it) to its end, cut where the gap passes a level.
  void extrude_interval(const Point& a, const Point& b, double fed_from, double volume, int line) {
    const bool jump = !(std::abs(b.gap - a.gap) <= kGapJump);
    std::array<double, 4> cuts{fed_from, 1, 1, 1};
    std::size_t count = 1;
    if (jump && a.gap != b.gap) {
      if (0.5 > fed_from) cuts[count++] = 0.5;  // nobody saw the edge: half-way
    } else if (a.gap != b.gap) {
      const bool falls = b.gap < a.gap;
      for (const double level : {falls ? accepted_max : 0.0, falls ? 0.0 : accepted_max}) {
        const double f = (level - a.gap) / (b.gap - a.gap);
        if (f > fed_from && f < 1) cuts[count++] = f;
      }
    }
    cuts[count] = 1;
    for (std::size_t i = 0; i < count; ++i) {
      const double f0 = cuts[i], f1 = cuts[i + 1];
      const auto gap_at = [&](double f, double middle) {
        if (a.gap == b.gap) return a.gap;
        if (jump) return middle < 0.5 ? a.gap : b.gap;
        return a.gap + f * (b.gap - a.gap);
      };
      const double middle = 0.5 * (f0 + f1);
      const Point p = between(a, b, f0, gap_at(f0, middle)), q = between(a, b, f1, gap_at(f1, middle));
      if (!start_gap) start_gap = p.gap;
      extrude(p, q, volume * (f1 - f0) / (1 - fed_from), line);
    }
  }

  void observe(const Snapshot& now) {
    const double path = (now.X_WT.translation() - last->X_WT.translation()).norm();
    const double fed = now.filament - most_filament;
    if (fed <= 0) {
      pause(path);
      last_gap.reset();
      return;
    }
    const double before = last_gap ? *last_gap : true_gap(part.get(), last->X_WT);
    last_gap = true_gap(part.get(), now.X_WT);
    // After a retraction the nozzle is full again part of the way.
    const double fed_from = (most_filament - last->filament) / (now.filament - last->filament);
    if (fed_from > 0) pause(fed_from * path);
    const Point a{last->time, last->X_WT.translation(), tool_axis(last->X_WT), before};
    const Point b{now.time, now.X_WT.translation(), tool_axis(now.X_WT), *last_gap};
    extrude_interval(a, b, fed_from, fed * filament_area, now.line);
    most_filament = now.filament;
  }
};

DepositionObserver::DepositionObserver(const machine::MachineDescription& machine,
                                       std::shared_ptr<const geometry::Mesh> part)
    : state_(std::make_unique<State>()) {
  const double d = machine.tool.filament_diameter;
  state_->part = std::move(part);
  state_->filament_area = std::numbers::pi / 4 * d * d;
  state_->accepted_min = machine.gap.accepted_min;
  state_->accepted_max = machine.gap.accepted_max;
}

DepositionObserver::~DepositionObserver() = default;

void DepositionObserver::observe(const Snapshot& snapshot) {
  State& s = *state_;
  if (s.last) {
    s.observe(snapshot);
  } else {
    s.first_filament = s.most_filament = snapshot.filament;
  }
  s.last = snapshot;
}

const std::vector<Bead>& DepositionObserver::beads() const { return state_->beads; }

DepositionSummary DepositionObserver::summary() const {
  const State& s = *state_;
  DepositionSummary summary;
  summary.length = s.sums.length;
  if (s.sums.length > 0) {
    summary.in_band_fraction = s.sums.in_band / s.sums.length;
    summary.below_band_fraction = s.sums.below / s.sums.length;
    summary.above_band_fraction = std::max(0.0, 1 - summary.in_band_fraction - summary.below_band_fraction);
  }
  if (s.sums.surface_length > 0) {
    summary.gap_min = s.sums.min;
    summary.gap_mean = s.sums.moment / s.sums.surface_length;
    summary.gap_max = s.sums.max;
  }
  summary.start_gap = s.start_gap.value_or(0);
  summary.extruded_volume = (s.most_filament - s.first_filament) * s.filament_area;
  for (const Bead& bead : s.beads) {
    if (bead.sticks) summary.deposited_volume += bead.volume;
  }
  return summary;
}

std::vector<DepositionObserver::Loose> DepositionObserver::loose_stretches() const {
  std::vector<Loose> stretches;
  for (std::size_t i = 0; i < state_->beads.size(); ++i) {
    const Bead& bead = state_->beads[i];
    const Growth& growth = state_->growths[i];
    if (bead.sticks) continue;
    if (i > 0 && growth.follows && state_->growths[i - 1].hold == growth.hold) {
      Loose& stretch = stretches.back();
      stretch.length += bead.length;
      stretch.worst_gap = growth.hold == Hold::buried ? std::min(stretch.worst_gap, growth.worst_gap)
                                                      : std::max(stretch.worst_gap, growth.worst_gap);
      continue;
    }
    stretches.push_back({growth.start_line, growth.start_time, bead.length, growth.worst_gap, bead.from_W});
  }
  return stretches;
}

}  // namespace understudy::sim
