#include "sim/deposition/deposition.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "geometry/printed_clearance.h"
#include "sim/deposition/bead_builder.h"
#include "sim/deposition/bead_section.h"
#include "sim/deposition/extruder.h"
#include "sim/deposition/gap_sums.h"
#include "sim/deposition/lone_strand.h"
#include "sim/deposition/unsupported_stretch_recorder.h"

namespace understudy::sim {
namespace {

constexpr double kGapJump = 0.5e-3;  // [m], between two snapshots: the axis went over an edge
constexpr double kRounding = 1e-9;   // [m], of a gap: coordinates of 0.1 m through files and rotations
constexpr double kThinnest = 1e-6;   // [m]: what is thinner has a volume but is in nobody's way
constexpr double kFills = 0.99;      // of the gap
constexpr double kSide = 0.35;       // of the width, where an overhang is felt for
constexpr double kPlunge = 0.7;      // cosine to the tool axis, of a tip that goes ahead into what it feeds
constexpr double kLongestHang = 10;  // bores, of path: slicers come down by 0.2 to 2 mm
constexpr double kInfinity = std::numeric_limits<double>::infinity();

PathPoint between(const PathPoint& a, const PathPoint& b, double f, double gap) {
  return {a.time + f * (b.time - a.time), a.tip_W + f * (b.tip_W - a.tip_W),
          ((1 - f) * a.axis_W + f * b.axis_W).normalized(), gap};
}

// What lies below the tip at a snapshot.
struct Ground {
  double gap = kInfinity;
  bool printed = false;                      // it is a bead
  double interface_temperature = kInfinity;  // [K]
  double carrier = kInfinity;                // [m], see lone_strand.h
  std::size_t bead = BeadIndex::kAll;        // its number
};

Bead shape_of(const Element& element) {
  const LaidBead& laid = element.bead;
  // What fills the space from the surface to the nozzle is as high as the tip everywhere; a thinner strand
  // lies on the surface, unless it hangs. Nothing lies higher than the orifice that it came out of, whose
  // flat presses it down: not where that is buried, nor where the gap is less at one end than elsewhere.
  const bool lies = laid.adhesion != Adhesion::unsupported && laid.adhesion != Adhesion::fused &&
                    laid.adhesion != Adhesion::buried && laid.height < kFills * laid.gap;
  const double half = laid.height / 2;
  const auto middle = [&](const Vec3& tip, const Vec3& foot) -> Vec3 {
    const double gap = (tip - foot).dot(laid.normal_W);
    if (lies && gap > laid.height) return foot + half * laid.normal_W;
    return tip - half * laid.normal_W;
  };
  const Vec3 from = middle(element.tip_from_W, laid.from_W), to = middle(element.tip_to_W, laid.to_W);
  const auto floats = [](const Vec3& v) {
    return std::array{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
  };
  Bead bead;
  bead.from_W = floats(from);
  bead.to_W = floats(to);
  bead.up_W = floats(laid.normal_W);
  bead.height = static_cast<float>(laid.height);
  // What hangs is round, whatever its distance to what is below.
  const bool hangs = laid.adhesion == Adhesion::unsupported;
  bead.width = hangs ? bead.height : std::max(bead.height, static_cast<float>(laid.width));
  bead.laid_at = static_cast<float>(laid.time);
  bead.line = laid.line;
  return bead;
}

/// What comes out at rest, or nearly, with nothing below: it falls, and is in nobody's way.
bool is_drop(const LaidBead& bead) {
  return bead.adhesion == Adhesion::unsupported && !bead.follows && bead.length < bead.width;
}

}  // namespace

struct DepositionObserver::State {
  State(const machine::MachineDescription& machine, std::shared_ptr<Workpiece> stands_below,
        DepositionOptions with)
      : workpiece(std::move(stands_below)),
        options(std::move(with)),
        filament_area(std::numbers::pi / 4 * machine.tool.filament_diameter * machine.tool.filament_diameter),
        nozzle_flat(machine.tool.flat_diameter),
        longest_hang(kLongestHang * machine.tool.nozzle_diameter),
        stated(gap_band(machine.gap)),
        band(stated),
        extruder(machine.process.extruder_lag),
        builder(kWidestLine * machine.tool.nozzle_diameter,
                [this](const Element& element) { keep(element); }),
        unsupported(*workpiece, machine.gap.accepted_max, machine.tool.nozzle_diameter,
                    options.on_unsupported),
        usual_height(machine.gap.aim) {}

  std::shared_ptr<Workpiece> workpiece;
  DepositionOptions options;
  double filament_area;  // [m^2]
  double nozzle_flat;    // [m]
  double longest_hang;   // [m]
  GapBand stated, band;  // of the machine, and of the line that is printed
  Extruder extruder;
  BeadBuilder builder;
  UnsupportedStretchRecorder unsupported;
  GapSums sums;
  DepositionSummary totals;

  std::optional<Snapshot> last;
  Ground ground;                                 // at `last`
  double most_filament = 0, first_filament = 0;  // [m]
  UnsupportedStretchRecorder::Conditions conditions;
  double usual_height;      // [m], of the last element that sticks: what a fused one gets
  double hanging = 0;       // [m^3], fed while the tip came down through the air: a drop at the nozzle
  double hanging_path = 0;  // [m], of that way, from where it began to feed
  bool flows = false;
  bool fell = false;  // the last element
  bool started = false;
  bool emptied = false;  // the nozzle, after the end

  std::vector<bool> in_air;    // by bead: a strand, or carried by one alone
  double path = 0;             // [m], of the tip
  std::deque<double> fresh;    // path at the end of each bead that may be under the nozzle
  std::size_t fresh_from = 0;  // number of the first of them

  // [m^3]; what was drawn back is no melt that waits.
  double column() const { return emptied ? 0 : std::max(0.0, extruder.column()) * filament_area; }

  double take_column() {
    const double volume = column();
    emptied = true;
    return volume;
  }

  void keep(const Element& element) {
    const LaidBead& bead = element.bead;
    totals.laid_volume += bead.volume;
    const bool drops = is_drop(bead);
    if (drops)
      unsupported.drop(element);
    else
      unsupported.add(element, conditions);
    const bool falls = drops || goes_down(bead);
    fell = falls;
    if (bead.length == 0 || falls) totals.standstill_volume += bead.volume;
    if (falls && workpiece->beads().size() == 0) started = false;  // the print has not begun
    if (bead.adhesion == Adhesion::sticks || bead.adhesion == Adhesion::fused)
      totals.deposited_volume += bead.volume;
    if (bead.adhesion == Adhesion::sticks && !std::isfinite(element.carrier)) usual_height = bead.height;
    ++totals.beads;
    conditions.interface_temperature = kInfinity;
    if (bead.height > kThinnest && !falls) {
      workpiece->add(shape_of(element));
      in_air.push_back(bead.adhesion == Adhesion::unsupported || std::isfinite(element.carrier));
      fresh.push_back(path);
    }
    if (options.laid) options.laid(bead);
  }

  /// Drawn high in the air out of a drop that falls, and held by nothing else: it goes down with it.
  bool goes_down(const LaidBead& bead) const {
    return fell && bead.follows && bead.adhesion == Adhesion::unsupported && bead.gap > longest_hang &&
           !unsupported.stretches().back().held_at_start;
  }

  void move_on(double step) {
    path += step;
    const double window = geometry::fresh_path(nozzle_flat, builder.last_width());
    while (!fresh.empty() && fresh.front() < path - window) {
      fresh.pop_front();
      ++fresh_from;
    }
  }

  Ground look(const Pose& X_WT, double time, double fan, double temperature, double reach = kGapReach) const {
    Ground seen;
    const auto hit = workpiece->below(X_WT, fresh_from, ground.bead, reach);
    if (!hit) return seen;
    seen.gap = hit->distance;
    seen.printed = hit->body == Workpiece::Body::bead;
    if (seen.printed) seen.bead = hit->bead;
    // Also a little above the band: the interval that leads there is cut at its upper end.
    if (seen.printed && hit->bead < in_air.size() && in_air[hit->bead] && seen.gap <= band.high + kGapJump)
      seen.carrier = carrier_width(*workpiece, X_WT, *hit, fresh_from);
    if (seen.printed && options.glass_transition > 0) {
      const double age = time - static_cast<double>(workpiece->beads().bead(hit->bead).laid_at);
      const double substrate = options.substrate_temperature ? options.substrate_temperature(age, fan) : 0.0;
      seen.interface_temperature = 0.5 * (temperature + substrate);
    }
    return seen;
  }

  // Nothing in reach below the middle, but perhaps below half of the width.
  Ground look_beside(const Snapshot& s, const Vec3& heading) const {
    const Vec3 axis = tool_axis(s.X_WT), across = axis.cross(heading);
    const double deepest = band.high + 10 * kRounding;  // with what ties
    Ground best;
    if (across.norm() < 1e-6 * heading.norm() || heading.norm() == 0) return best;
    const double reach = kSide * std::max(builder.last_width(), nozzle_flat / 2);
    for (const double side : {reach, -reach}) {
      Pose X_WT = s.X_WT;
      X_WT.translation() += side * across.normalized();
      const Ground seen = look(X_WT, s.time, s.fan, s.nozzle_temperature, deepest);
      if (seen.printed && seen.gap <= band.high + kRounding && seen.gap > -band.soft_depth &&
          seen.gap < best.gap)
        best = seen;
    }
    return best;
  }

  Ground ground_at(const Snapshot& s, const Vec3& heading) const {
    const Ground seen = look(s.X_WT, s.time, s.fan, s.nozzle_temperature);
    if (seen.gap <= band.high + kRounding || workpiece->beads().size() == 0) return seen;
    const Ground at_side = look_beside(s, heading);
    return std::isfinite(at_side.gap) ? at_side : seen;
  }

  Adhesion adhesion_of(double gap, const Ground& below) const {
    if (gap > band.high + kRounding) return Adhesion::unsupported;
    if (below.printed && gap > -band.soft_depth && gap < band.low - kRounding) return Adhesion::fused;
    if (gap <= kRounding) return Adhesion::buried;
    if (below.interface_temperature < options.glass_transition) return Adhesion::cold;
    return Adhesion::sticks;
  }

  // From a to b nothing changes but linearly.
  void extrude(const PathPoint& a, const PathPoint& b, const Ground& below, double volume, int line) {
    const Adhesion adhesion = adhesion_of(0.5 * (a.gap + b.gap), below);
    builder.extrude(a, b, adhesion, volume, line, {usual_height, below.carrier});
    const double length = (b.foot_W() - a.foot_W()).norm();
    if (adhesion == Adhesion::fused) {
      totals.fused_length += length;
    } else {
      sums.add(a.gap, b.gap, band, length, b.time, line);
    }
    conditions.interface_temperature =
        std::min(conditions.interface_temperature, below.interface_temperature);
    conditions.on_printed = below.printed;
    conditions.highest_gap = band.high;
  }

  // The interval from `from` (a share of it) to its end, cut where the gap passes a level.
  void extrude_interval(const PathPoint& a, const PathPoint& b, const Ground& before, double from,
                        double volume, int line) {
    // On to a bead or off it is an edge as well.
    const bool jump = !(std::abs(b.gap - a.gap) <= kGapJump) || before.printed != ground.printed;
    std::array<double, 5> cuts{from, 1, 1, 1, 1};
    std::size_t count = 1;
    if (jump && a.gap != b.gap) {
      if (0.5 > from) cuts[count++] = 0.5;  // nobody saw the edge: half-way
    } else if (a.gap != b.gap) {
      std::array<double, 3> levels{band.high, ground.printed ? band.low : 0.0, -band.soft_depth};
      if (b.gap > a.gap) std::reverse(levels.begin(), levels.end());
      for (const double level : levels) {
        const double f = (level - a.gap) / (b.gap - a.gap);
        if (f > from && f < 1 && (ground.printed || level >= 0)) cuts[count++] = f;
      }
    }
    cuts[count] = 1;
    for (std::size_t i = 0; i < count; ++i) {
      const double f0 = cuts[i], f1 = cuts[i + 1], middle = 0.5 * (f0 + f1);
      const auto gap_at = [&](double f) {
        if (a.gap == b.gap) return a.gap;
        if (jump) return middle < 0.5 ? a.gap : b.gap;
        return a.gap + f * (b.gap - a.gap);
      };
      const PathPoint p = between(a, b, f0, gap_at(f0)), q = between(a, b, f1, gap_at(f1));
      if (!started) totals.start_gap = p.gap;
      started = true;
      extrude(p, q, jump && middle < 0.5 ? before : ground, volume * (f1 - f0) / (1 - from), line);
    }
  }

  /// The tip comes down along the tool, from where nothing was in reach.
  bool comes_down(const Snapshot& now, const Vec3& heading, const Ground& before) const {
    return (hanging > 0 || before.gap > band.high + kRounding) &&
           heading.dot(tool_axis(now.X_WT)) < -kPlunge * heading.norm();
  }

  /// The drop comes to lie where the tip came down to, at `last`.
  void lay_hanging(const Ground& below) {
    const PathPoint at{last->time, last->X_WT.translation(), tool_axis(last->X_WT), below.gap};
    if (!started) totals.start_gap = at.gap;
    started = true;
    extrude(at, at, below, std::exchange(hanging, 0.0), last->line);
  }

  /// In the first `share` of the interval nothing comes out.
  void lay_nothing(const Snapshot& now, double share, const Ground& before) {
    const Vec3 from = last->X_WT.translation();
    const double way = share * (now.X_WT.translation() - from).norm();
    if (now.filament > last->filament && 0.5 * (before.gap + ground.gap) > band.high + kRounding)
      builder.prime({way, from, now.line});
    else
      builder.pause(way);
  }

  void observe(const Snapshot& now) {
    const Vec3 heading = now.X_WT.translation() - last->X_WT.translation();
    const double step = heading.norm(), fed = now.filament - last->filament;
    const Extruder::Flow flow = extruder.advance(now.filament - first_filament, now.time - last->time);
    most_filament = std::max(most_filament, now.filament);
    move_on(step);
    if (options.band) band = options.band(now.line);
    const Ground before = ground;
    ground = ground_at(now, heading);
    conditions.nozzle_temperature = now.nozzle_temperature;
    conditions.fan = now.fan;
    const double volume = flow.filament * filament_area;
    flows = volume > 0 && fed > 0;
    const bool down = comes_down(now, heading, before);
    const bool feeding = flows || hanging_path > 0;
    hanging_path = down && feeding ? hanging_path + step : 0;
    const bool may_hang = down && hanging_path <= longest_hang;
    if (hanging > 0 && !may_hang) lay_hanging(before);
    if (flows && may_hang) {
      flows = false;
      hanging += volume;
      builder.pause(step);
      return;
    }
    if (!flows) {
      if (volume > 0) builder.ooze(volume);
      lay_nothing(now, 1, before);
      return;
    }
    if (flow.from > 0) lay_nothing(now, flow.from, before);
    const PathPoint a{last->time, last->X_WT.translation(), tool_axis(last->X_WT), before.gap};
    const PathPoint b{now.time, now.X_WT.translation(), tool_axis(now.X_WT), ground.gap};
    extrude_interval(a, b, before, flow.from, volume, now.line);
  }
};

DepositionObserver::DepositionObserver(const machine::MachineDescription& machine,
                                       std::shared_ptr<Workpiece> workpiece, DepositionOptions options)
    : state_(std::make_unique<State>(machine, std::move(workpiece), std::move(options))) {}

DepositionObserver::~DepositionObserver() = default;

void DepositionObserver::observe(const Snapshot& snapshot) {
  State& s = *state_;
  if (s.last) {
    s.observe(snapshot);
  } else {
    s.first_filament = s.most_filament = snapshot.filament;
    s.ground = s.look(snapshot.X_WT, snapshot.time, snapshot.fan, snapshot.nozzle_temperature);
  }
  s.last = snapshot;
}

void DepositionObserver::finish() {
  State& s = *state_;
  if (s.hanging > 0) s.lay_hanging(s.ground);
  if (s.started) s.builder.ooze(s.take_column());
  s.builder.close();
  s.unsupported.finish();
}

double DepositionObserver::gap() const { return state_->ground.gap; }
double DepositionObserver::interface_temperature() const { return state_->ground.interface_temperature; }
std::size_t DepositionObserver::fresh_from() const { return state_->fresh_from; }
bool DepositionObserver::flowing() const { return state_->flows; }

DepositionSummary DepositionObserver::summary() const {
  const State& s = *state_;
  DepositionSummary summary = s.totals;
  s.sums.fill(summary);
  summary.extruded_volume = (s.most_filament - s.first_filament) * s.filament_area;
  summary.column_volume = s.column() + s.builder.carried_volume() + s.hanging;
  return summary;
}

const std::vector<UnsupportedStretch>& DepositionObserver::unsupported_stretches() const {
  return state_->unsupported.stretches();
}

}  // namespace understudy::sim
