#include "toolpath/lattice/lattice_planner.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "toolpath/bead.h"
#include "toolpath/lattice/tool_envelope.h"
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
      : lattice_(lattice),
        plan_(plan),
        tool_radius_(ToolEnvelope(plan.limits.tool).radius()),
        builder_(plan.filament_diameter) {}

  void add(const StrutPrint& print) {
    const bool goes_on = last_ && last_->to == print.from && (last_->axis - print.axis).norm() < kSameAxis;
    if (!goes_on) {
      come_to(print);
      const Pose start = tool(print.from, print.axis);
      builder_.travel(tool(print.from, print.axis, std::min(plan_.approach, print.out_from)));
      builder_.move(start, plan_.approach_feed);
    }
    const double length = lattice_.length(print.strut);
    builder_.print(tool(print.to, print.axis), plan_.feed, strand_area(plan_.limits.strut_diameter) * length);
    builder_.dwell(plan_.dwell);
    for (const int node : {print.from, print.to}) top_ = std::max(top_, lattice_.nodes[node].position.z());
    printed_ += length;
    last_ = &print;
  }

  Program finish() {
    leave();
    return builder_.take();
  }
  double printed() const { return printed_; }

 private:
  Pose tool(int node, const Vec3& axis, double out = 0) const {
    const LatticeNode& n = lattice_.nodes[node];
    return tool_at(tip_at(n, axis, plan_.limits.strut_diameter, plan_.limits.ground_gap), axis, out);
  }

  void leave() { builder_.travel(tool(last_->to, last_->axis, last_->out_to)); }

  void come_to(const StrutPrint& print) {
    const Pose outside = tool(print.from, print.axis, print.out_from);
    if (!last_) {
      builder_.begin(above(outside, print.axis), plan_.temperature, plan_.fan);
      if (print.axis.z() < 1 - kSameAxis) builder_.travel(above(outside, print.axis));
    } else {
      leave();
      if ((last_->axis - print.axis).norm() >= kSameAxis) {
        builder_.travel(above(builder_.tool(), last_->axis));
        builder_.travel(above(outside, print.axis));
      } else {
        travel_level(outside, print.axis);
      }
    }
    builder_.travel(outside);
  }

  // With one axis the path leads along the plane across it that is farther out.
  void travel_level(const Pose& to, const Vec3& axis) {
    const double up = axis.dot(to.translation() - builder_.tool().translation());
    if (std::abs(up) < kMicrometre) return;
    Pose corner = up > 0 ? builder_.tool() : to;
    corner.translation() += std::abs(up) * axis;
    builder_.travel(corner);
  }

  // High enough for the tool to turn from vertical to `axis` without any body of it coming down to the
  // struts.
  Pose above(Pose X_WT, const Vec3& axis) const {
    const double dips = tool_radius_ * std::sqrt(std::max(0.0, 1 - axis.z() * axis.z()));
    const double level = top_ + plan_.limits.lift + dips;
    X_WT.translation().z() = std::max(X_WT.translation().z(), level);
    return X_WT;
  }

  const Lattice& lattice_;
  const LatticePlan& plan_;
  double tool_radius_;
  ProgramBuilder builder_;
  const StrutPrint* last_ = nullptr;
  double top_ = 0;  // [m], of what is printed
  double printed_ = 0;
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
