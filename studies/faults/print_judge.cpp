#include "studies/faults/print_judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/units.h"
#include "geometry/table_surface.h"
#include "machine/accepted_errors.h"

namespace understudy::studies {
namespace {

using rehearsal::Record;
using rehearsal::TracePoint;

constexpr double kPlacesPerBore = 4;
constexpr double kOwnBead = 2;        // bores of path: what was laid since is the bead that is being laid
constexpr int kNextLines = 3;         // a setpoint carries the line of its step, a corner those of both
constexpr double kRounding = 0.2e-6;  // [m], of a gap: printed surfaces are known to single precision
constexpr double kReach = 5e-3;       // [m], beyond it nothing lies below a nozzle

/// What the programmed tip has below it before anything is printed.
double ground_gap(const Pose& X_WT, const geometry::Mesh* part) {
  const Vec3 tip = X_WT.translation(), down = -tool_axis(X_WT);
  double gap = std::numeric_limits<double>::infinity();
  if (const auto table = geometry::TableSurface{}.ray_hit(tip, down)) gap = *table;
  if (part)
    if (const auto hit = part->ray_hit(tip, down, kReach)) gap = std::min(gap, hit->distance);
  return gap;
}

double loose_filament(const Record& record) {
  if (!record.print) return 0;
  const rehearsal::PrintFigures& print = *record.print;
  return from_mm(print.printed_mm + print.purged_mm - print.deposited_mm - print.spanning_mm);
}

/// The longest stretch of path over which something holds.
class Stretch {
 public:
  void add(bool holds, double way) {
    now_ = holds ? now_ + way : 0;
    longest_ = std::max(longest_, now_);
  }
  double longest() const { return longest_; }

 private:
  double now_ = 0, longest_ = 0;
};

unsigned bit(Flaw flaw, bool is) { return is ? 1U << static_cast<unsigned>(flaw) : 0U; }

}  // namespace

PrintTolerances tolerances_of(const std::string& machine_word) {
  const machine::MachineDescription machine = machine::load_machine(machine_word);
  const machine::AcceptedErrors accepted = machine::load_accepted_errors(machine_word);
  return {accepted.tip,
          accepted.orientation,
          machine.gap.accepted_min,
          machine.gap.accepted_max,
          machine.gap.accepted_max - machine.gap.aim,
          machine.tool.nozzle_diameter};
}

IntendedPrint::IntendedPrint(const toolpath::Program& program, const geometry::Mesh* part,
                             const PrintTolerances& tolerances)
    : tolerances_(tolerances) {
  Pose X_WT = Pose::Identity();
  double fed = 0;
  for (const toolpath::Step& step : program.steps) {
    fed += step.filament;
    filament_ = std::max(filament_, fed);
    if (!toolpath::moves(step)) continue;
    if (step.kind == toolpath::StepKind::print) add_segment(step, X_WT, part);
    X_WT = step.X_WT;
  }
}

void IntendedPrint::add_segment(const toolpath::Step& step, const Pose& X_WT_before,
                                const geometry::Mesh* part) {
  const double length = (step.X_WT.translation() - X_WT_before.translation()).norm();
  if (!(length > 0)) return;
  const auto count =
      static_cast<std::size_t>(std::max(1.0, std::ceil(kPlacesPerBore * length / tolerances_.bore)));
  segments_.push_back({X_WT_before.translation(), step.X_WT.translation(), tool_axis(X_WT_before),
                       tool_axis(step.X_WT), step.line, places_.size(), count});
  for (std::size_t i = 0; i < count; ++i) {
    const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    add_place(interpolate(X_WT_before, step.X_WT, t), length / static_cast<double>(count), part);
    path_ += length / static_cast<double>(count);
  }
}

void IntendedPrint::add_place(const Pose& X_WT, double length, const geometry::Mesh* part) {
  const Vec3 tip = X_WT.translation(), axis = tool_axis(X_WT);
  const double gap = ground_gap(X_WT, part), half_a_bore = tolerances_.bore / 2;
  const bool on_ground = gap >= tolerances_.gap_min - kRounding && gap <= tolerances_.gap_max + kRounding;
  // A bead fills the way from its nozzle down to what lies below: the one before it ends at its nozzle.
  double layer = gap;
  if (!on_ground) {
    layer = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < tips_W_.size() && path_ - ways_[i] > kOwnBead * tolerances_.bore; ++i) {
      const double height = (tip - tips_W_[i]).dot(axis);
      if (height >= tolerances_.gap_min / 2 && height <= tolerances_.gap_max + kRounding &&
          (tip - tips_W_[i] - height * axis).norm() <= half_a_bore)
        layer = std::min(layer, height);
    }
  }
  const bool lies = std::isfinite(layer);
  const Place place{length, on_ground, lies,
                    lies ? std::max(tolerances_.gap_max, layer + tolerances_.gap_above) : 0};
  places_.push_back(place);
  tips_W_.push_back(tip);
  ways_.push_back(path_);
}

std::pair<IntendedPrint::Segments::const_iterator, IntendedPrint::Segments::const_iterator>
IntendedPrint::near(int line) const {
  const auto before = [](const Segment& s, int l) { return s.line < l; };
  const auto first = std::lower_bound(segments_.begin(), segments_.end(), line - kNextLines, before);
  const auto last = std::lower_bound(first, segments_.end(), line + kNextLines + 1, before);
  if (first == last) return {segments_.begin(), segments_.end()};
  return {first, last};
}

void IntendedPrint::cover(int line, const Vec3& tip_W, std::vector<bool>& covered) const {
  const auto [first, last] = near(line);
  if (first == last) return;
  const std::size_t end = std::prev(last)->first_place + std::prev(last)->places;
  for (std::size_t i = first->first_place; i < end; ++i)
    if ((tips_W_[i] - tip_W).norm() <= tolerances_.tip + places_[i].length / 2) covered[i] = true;
}

IntendedPrint::Nearest IntendedPrint::nearest(int line, const Pose& X_WT) const {
  const auto [first, last] = near(line);
  Nearest best{0, std::numeric_limits<double>::infinity(), 0};
  for (auto s = first; s != last; ++s) {
    const Vec3 way = s->to_W - s->from_W;
    const double t = std::clamp((X_WT.translation() - s->from_W).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const double distance = (X_WT.translation() - s->from_W - t * way).norm();
    if (!(distance < best.distance)) continue;
    const auto place = std::min(s->places - 1, static_cast<std::size_t>(t * static_cast<double>(s->places)));
    const Vec3 axis = ((1 - t) * s->axis_from_W + t * s->axis_to_W).normalized();
    best = {s->first_place + place, distance,
            std::atan2(axis.cross(tool_axis(X_WT)).norm(), axis.dot(tool_axis(X_WT)))};
  }
  return best;
}

const char* to_string(Flaw flaw) {
  switch (flaw) {
    case Flaw::incomplete:
      return "incomplete";
    case Flaw::tip:
      return "tip";
    case Flaw::orientation:
      return "orientation";
    case Flaw::too_low:
      return "too low";
    case Flaw::too_high:
      return "too high";
    case Flaw::loose:
      return "loose";
    case Flaw::touched:
      return "touched";
  }
  return "unknown";
}

std::string flaw_words(unsigned flaws) {
  std::vector<std::string> words;
  for (int i = 0; i < kFlaws; ++i)
    if ((flaws >> i & 1U) != 0) words.emplace_back(to_string(static_cast<Flaw>(i)));
  return fmt::format("{}", fmt::join(words, ", "));
}

namespace {

/// Walks along the truth of a print.
class Judge {
 public:
  Judge(const IntendedPrint& intended, const sim::Workpiece* printed)
      : intended_(intended),
        allowed_(intended.tolerances()),
        printed_(printed),
        covered_(intended.places().size()) {}

  void look(const TracePoint& point) {
    printing_ = printing_ || point.extruding;
    if (!printing_ && point.gap <= 0) touched_ = true;
    if (point.extruding && !covered_.empty())
      look_at_bead(point);
    else
      last_ = nullptr;
  }

  PrintTruth truth(const Record& run) {
    const auto deep = [](const std::optional<double>& mm) { return mm && *mm < 0; };
    if (run.collision)
      touched_ =
          touched_ || deep(run.collision->min_clearance_mm) || deep(run.collision->nozzle_clearance_mm);
    for (std::size_t i = 0; i < covered_.size(); ++i)
      if (!covered_[i]) truth_.missing += intended_.places()[i].length;
    truth_.too_low = low_.longest();
    truth_.too_high = high_.longest();
    const double bore = allowed_.bore;
    const double bore_of_filament = intended_.filament() * bore / std::max(intended_.path(), bore);
    const double unfed = intended_.filament() - (run.print ? from_mm(run.print->extruded_mm) : 0);
    const double loose = loose_filament(run);
    truth_.flaws = bit(Flaw::incomplete, truth_.missing > bore || unfed > bore_of_filament) |
                   bit(Flaw::tip, truth_.tip_max > allowed_.tip) |
                   bit(Flaw::orientation, truth_.orientation_max > allowed_.orientation) |
                   bit(Flaw::too_low, truth_.too_low > bore) |
                   bit(Flaw::too_high, truth_.too_high > 2 * bore) |
                   bit(Flaw::loose, loose > bore_of_filament) | bit(Flaw::touched, touched_);
    return truth_;
  }

 private:
  void look_at_bead(const TracePoint& point) {
    const auto at = intended_.nearest(point.line, point.X_WT);
    const IntendedPrint::Place& place = intended_.places()[at.place];
    truth_.tip_max = std::max(truth_.tip_max, at.distance);
    truth_.orientation_max = std::max(truth_.orientation_max, at.angle);
    cover(point);
    const double way = last_ ? (point.X_WT.translation() - last_->X_WT.translation()).norm() : 0;
    low_.add(place.on_ground && over_ground(point) < allowed_.gap_min - kRounding, way);
    high_.add(place.lies && !(point.gap <= place.highest + kRounding), way);
    // No deeper than that is a nozzle that crosses the bead that it has laid, which is as high as its tip.
    if (place.on_ground && point.gap < -allowed_.gap_min / 2) touched_ = true;
    if (place.lies) {
      truth_.gap_min = gaps_ ? std::min(truth_.gap_min, point.gap) : point.gap;
      truth_.gap_max = gaps_ ? std::max(truth_.gap_max, point.gap) : point.gap;
      gaps_ = true;
    }
    last_ = &point;
  }

  /// [m], to part or table as they truly are. The gap is less over a bead, as where an outline ends on its
  /// beginning or passes the corner of its neighbour.
  double over_ground(const TracePoint& point) const {
    if (!printed_ || point.gap >= allowed_.gap_min) return point.gap;
    const auto ground = printed_->below(point.X_WT, 0);
    return ground ? ground->distance : kReach;
  }

  /// Once in a part of a place's length is enough.
  void cover(const TracePoint& point) {
    const double step = allowed_.bore / (4 * kPlacesPerBore);
    const Vec3 tip = point.X_WT.translation();
    if (last_ && point.line == last_->line && (tip - covering_).norm() < step) return;
    intended_.cover(point.line, tip, covered_);
    covering_ = tip;
  }

  const IntendedPrint& intended_;
  const PrintTolerances& allowed_;
  PrintTruth truth_;
  const sim::Workpiece* printed_;  // null: what lies below is not known but by the gap
  std::vector<bool> covered_;
  Stretch low_, high_;
  bool touched_ = false, printing_ = false, gaps_ = false;
  const TracePoint* last_ = nullptr;  // while a bead is laid
  Vec3 covering_ = Vec3::Zero();      // the tip that has covered last
};

}  // namespace

PrintTruth judge_print(const IntendedPrint& intended, const Record& run) {
  Judge judge(intended, run.scene ? run.scene->printed.get() : nullptr);
  for (const TracePoint& point : run.trace) judge.look(point);
  return judge.truth(run);
}

}  // namespace understudy::studies
