#include "toolpath/lattice/lattice_planner.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/bead.h"
#include "toolpath/lattice/segment_sequence.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

constexpr double kSameAxis = 1e-9;  // [rad], axes come from one list

void check(const LatticePlan& plan) {
  check_positive("feed", plan.feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach feed", plan.approach_feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach", to_mm(plan.approach), "mm");
  check_within("dwell", plan.dwell, 0, 3600, "s");
  check_positive("filament diameter", to_mm(plan.filament_diameter), "mm");
  check_nozzle(plan.temperature, plan.fan);
}

class LatticePrint {
 public:
  LatticePrint(const Lattice& lattice, const LatticePlan& plan)
      : lattice_(lattice), plan_(plan), builder_(plan.filament_diameter), there_(lattice.nodes.size()) {}

  void add(const StrutPrint& print) {
    const bool goes_on = last_ && last_->to == print.from && (last_->axis - print.axis).norm() < kSameAxis &&
                         (last_->tip_to - print.tip_from).norm() < kMicrometre;
    if (!goes_on) {
      come_to(print);
      builder_.travel(tool_at(print.tip_from, print.axis, std::min(plan_.approach, print.out_from)));
      builder_.move(tool_at(print.tip_from, print.axis, gap_at(print.from)), plan_.approach_feed);
    }
    const double length = lattice_.length(static_cast<std::size_t>(print.strut));
    const Pose end = tool_at(print.tip_to, print.axis, gap_at(print.to));
    // Drawn as thick as it is to be all along the tip's way, which gaps make shorter than the strut.
    const double drawn = (end.translation() - builder_.tool().translation()).norm();
    builder_.print(end, plan_.feed, strand_area(plan_.limits.strut_diameter) * drawn);
    builder_.dwell(plan_.dwell);
    printed_ += length;
    there_[static_cast<std::size_t>(print.from)] = there_[static_cast<std::size_t>(print.to)] = true;
    last_ = &print;
  }

  Program finish() {
    travel_along(last_->departure);
    return builder_.take();
  }
  double printed() const { return printed_; }

 private:
  // [m], along the axis beyond the planned tip. To what stands at a joint the nozzle comes as near as to the
  // table, so that a machine's errors do not press it in.
  double gap_at(int node) const {
    const auto n = static_cast<std::size_t>(node);
    return there_[n] && !lattice_.nodes[n].grounded ? plan_.limits.ground_gap : 0;
  }

  // From above what is built to above what is built, the tool upright; or straight over, where it stays so.
  void come_to(const StrutPrint& print) {
    if (!last_) {
      builder_.begin(print.arrival.front(), plan_.temperature, plan_.fan);
    } else if (print.arrival.empty() || (upright(*last_) && upright(print))) {
      travel_along(level_travel(*last_, print));  // what is built lies below that level
      return;
    } else {
      travel_along(last_->departure);
    }
    travel_along(print.arrival);
  }

  static bool upright(const StrutPrint& print) { return print.axis.z() > 1 - kSameAxis; }

  void travel_along(const std::vector<Pose>& way) {
    for (const Pose& X_WT : way) travel(X_WT);
  }

  void travel(const Pose& X_WT) {
    const bool there = !builder_.empty() && builder_.tool().isApprox(X_WT, 1e-12);
    if (!there) builder_.travel(X_WT);
  }

  const Lattice& lattice_;
  const LatticePlan& plan_;
  ProgramBuilder builder_;
  const StrutPrint* last_ = nullptr;
  double printed_ = 0;
  std::vector<bool> there_;  // nodes that something was printed to
};

LatticeProgram print_all(const Lattice& lattice, const LatticePlan& plan, StrutSequence sequence) {
  LatticeProgram result;
  result.sequence = std::move(sequence);
  LatticePrint print(lattice, plan);
  for (const StrutPrint& strut : result.sequence.prints) print.add(strut);
  result.program = print.finish();
  result.printed = print.printed();
  return result;
}

const char* segment_of(int strut, const SegmentLattice& segments) {
  for (const SegmentOrder& segment : segments.segments)
    if (std::any_of(segment.struts.begin(), segment.struts.end(),
                    [&](const Removal& r) { return r.strut == strut; }))
      return name_of(segment.direction);
  return "";
}

// Asks for ever shorter programs until it is known which strut the machine does not get to.
void require_reached(const LatticeProgram& planned, const SegmentLattice& segments, const WayCheck& way) {
  std::vector<Pose> poses;
  std::vector<std::size_t> struts;  // printed by then
  std::size_t printed = 0;
  for (const Step& step : planned.program.steps) {
    if (!moves(step)) continue;
    poses.push_back(step.X_WT);
    struts.push_back(printed);
    if (step.kind == StepKind::print) ++printed;
  }
  std::string why = way(poses, true);
  if (why.empty()) return;
  std::size_t good = 1, bad = poses.size();
  while (bad - good > 1) {
    const std::size_t half = (good + bad) / 2;
    std::string said = way({poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(half)}, true);
    if (said.empty()) {
      good = half;
    } else {
      bad = half;
      why = std::move(said);
    }
  }
  const auto& prints = planned.sequence.prints;
  const StrutPrint& strut = prints[std::min(struts[bad - 1], prints.size() - 1)];
  const auto place = [&](int node) {
    return in_mm(segments.lattice.nodes[static_cast<std::size_t>(node)].position);
  };
  throw InputError(fmt::format("segment {}, strut from {} to {}: {}; --turn and --place may help",
                               segment_of(strut.strut, segments), place(strut.from), place(strut.to), why));
}

}  // namespace

LatticeProgram plan_segments(const SegmentLattice& segments, const LatticePlan& plan) {
  check(plan);
  check_sequence(segments.lattice, plan.limits);
  LatticeProgram result = print_all(segments.lattice, plan, sequence_segments(segments, plan.limits));
  if (plan.limits.way) require_reached(result, segments, plan.limits.way);
  return result;
}

LatticeProgram plan_lattice(const Lattice& lattice, const LatticePlan& plan) {
  check(plan);
  return print_all(lattice, plan, sequence_struts(lattice, plan.limits));
}

}  // namespace understudy::toolpath
