#include "toolpath/lattice/lattice_planner.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "toolpath/bead.h"
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
    builder_.print(tool_at(print.tip_to, print.axis, gap_at(print.to)), plan_.feed,
                   strand_area(plan_.limits.strut_diameter) * length);
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
    } else if (upright(*last_) && upright(print)) {
      travel_level(tool_at(last_->tip_to, last_->axis, last_->out_to),
                   tool_at(print.tip_from, print.axis, print.out_from));
      return;
    } else {
      travel_along(last_->departure);
    }
    travel_along(print.arrival);
  }

  static bool upright(const StrutPrint& print) { return print.axis.z() > 1 - kSameAxis; }

  // Along the level of the higher one: what is built lies below both.
  void travel_level(const Pose& from, const Pose& to) {
    const double level = std::max(from.translation().z(), to.translation().z());
    Pose above_from = from, above_to = to;
    above_from.translation().z() = above_to.translation().z() = level;
    travel_along({from, above_from, above_to, to});
  }

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

}  // namespace

LatticeProgram plan_lattice(const Lattice& lattice, const LatticePlan& plan) {
  check(plan);
  LatticeProgram result;
  result.sequence = sequence_struts(lattice, plan.limits);
  LatticePrint print(lattice, plan);
  for (const StrutPrint& strut : result.sequence.prints) print.add(strut);
  result.program = print.finish();
  result.printed = print.printed();
  return result;
}

}  // namespace understudy::toolpath
