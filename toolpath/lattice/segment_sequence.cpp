#include "toolpath/lattice/segment_sequence.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/lattice/lattice_access.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

Vec3 tool_axis(const Pose& X_WT) { return X_WT.linear().col(2); }

class SegmentSequence {
 public:
  SegmentSequence(const SegmentLattice& segments, const SequenceLimits& limits)
      : segments_(segments),
        limits_(limits),
        access_(segments.lattice, limits),
        tool_(limits.tool),
        escape_(tool_, limits.margin, limits.lift),
        standing_(segments.lattice.struts.size()) {}

  StrutSequence run() {
    for (const SegmentOrder& segment : segments_.segments) {
      name_ = name_of(segment.direction);
      axis_ = segment.axis;
      require_room_above_table(segment);
      for (const Removal& strut : segment.struts) add(strut, &strut == &segment.struts.front());
    }
    leave();
    return std::move(sequence_);
  }

 private:
  void add(const Removal& strut, bool first) {
    StrutPrint print;
    const std::string why = access_.blocked(strut, axis_, standing_, print);
    if (!why.empty()) refuse(strut, why);
    if (first) {
      leave();
      print.arrival = way_from(print.tip_from, print.out_from, strut);
      std::reverse(print.arrival.begin(), print.arrival.end());
      if (!sequence_.prints.empty())
        require_clear({sequence_.prints.back().departure.back(), print.arrival.front()}, strut);
    } else {
      require_clear(level_travel(sequence_.prints.back(), print), strut);
    }
    standing_[static_cast<std::size_t>(strut.strut)] = 1;
    tell(limits_.progress, built_.size() + 1, standing_.size(), fmt::format("struts along {}", name_));
    built_.push_back(access_.body(strut.strut));
    sequence_.prints.push_back(std::move(print));
    last_ = strut;
  }

  // Out of the segment that is done, outside of what is printed.
  void leave() {
    if (sequence_.prints.empty()) return;
    StrutPrint& last = sequence_.prints.back();
    const Vec3 axis = std::exchange(axis_, last.axis);
    last.departure = way_from(last.tip_to, last.out_to, last_);
    axis_ = axis;
  }

  std::vector<Pose> way_from(const Vec3& tip, double out, const Removal& strut) const {
    std::string why = "the tool cannot turn upright clear of what is built";
    const auto way = escape_.find(tip + out * axis_, axis_, built_, [&](std::vector<Pose> out_of_it) {
      if (!limits_.way) return true;
      std::reverse(out_of_it.begin(), out_of_it.end());
      const std::string said = limits_.way(out_of_it, true);
      if (!said.empty()) why = "between segments " + said + "; --turn and --place may help";
      return said.empty();
    });
    if (!way) refuse(strut, why);
    return *way;
  }

  // Straight moves without a turn.
  void require_clear(const std::vector<Pose>& way, const Removal& strut) const {
    for (std::size_t i = 1; i < way.size(); ++i) {
      const ToolMotion motion{way[i - 1].translation(), way[i].translation(), tool_axis(way[i])};
      for (std::size_t k = 0; k < built_.size(); ++k)
        if (!tool_.clears(built_[k], motion, limits_.margin))
          refuse(strut,
                 fmt::format("on the way to it the tool comes to {:.3f} mm from the strut from {} to {}",
                             to_mm(tool_.distance(built_[k], motion, kMicrometre)), in_mm(built_[k].from),
                             in_mm(built_[k].to)));
    }
  }

  // A tool that lies on its side needs room below it.
  void require_room_above_table(const SegmentOrder& segment) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const Removal& r : segment.struts)
      for (const int n : {r.from, r.to})
        lowest = std::min(lowest, segments_.lattice.nodes[static_cast<std::size_t>(n)].position.z());
    const double needed = limits_.margin - tool_.lowest(axis_);
    if (axis_.z() < 0.5 && lowest < needed)
      throw InputError(
          fmt::format("segment {} begins {:.3f} mm above the table; a tool along {} needs {:.3f} mm", name_,
                      to_mm(lowest), name_, to_mm(needed)));
  }

  [[noreturn]] void refuse(const Removal& strut, const std::string& why) const {
    const auto& nodes = segments_.lattice.nodes;
    throw InputError(fmt::format("segment {}, strut from {} to {}: {}", name_,
                                 in_mm(nodes[static_cast<std::size_t>(strut.from)].position),
                                 in_mm(nodes[static_cast<std::size_t>(strut.to)].position), why));
  }

  const SegmentLattice& segments_;
  const SequenceLimits& limits_;
  StrutAccess access_;
  ToolEnvelope tool_;
  ToolEscape escape_;
  std::vector<char> standing_;
  std::vector<StrutBody> built_;
  StrutSequence sequence_;
  Removal last_;
  Vec3 axis_{0, 0, 1};
  const char* name_ = "";
};

}  // namespace

std::vector<Pose> level_travel(const StrutPrint& last, const StrutPrint& next) {
  const Pose from = tool_at(last.tip_to, last.axis, last.out_to);
  const Pose to = tool_at(next.tip_from, last.axis, next.out_from);
  const double rise = last.axis.dot(to.translation() - from.translation());
  Pose above_from = from, above_to = to;
  above_from.translation() += std::max(0.0, rise) * last.axis;
  above_to.translation() += std::max(0.0, -rise) * last.axis;
  return {from, above_from, above_to, to};
}

StrutSequence sequence_segments(const SegmentLattice& segments, const SequenceLimits& limits) {
  return SegmentSequence(segments, limits).run();
}

}  // namespace understudy::toolpath
