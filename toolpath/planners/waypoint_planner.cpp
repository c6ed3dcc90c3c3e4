#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/bead.h"
#include "toolpath/planners/plan_checks.h"
#include "toolpath/planners/waypoints.h"
#include "toolpath/program_builder.h"

namespace understudy::toolpath {
namespace {

constexpr double kJump = 30 * kDegree;  // normals of neighbours on a surface that a nozzle can follow

double angle(const Vec3& u, const Vec3& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); }

void check(const std::vector<WaypointLayer>& layers, const WaypointPlan& plan) {
  check_bead(plan.bead_width, plan.bead_height);
  check_positive("feed", plan.feed / kMillimetrePerMinute, "mm/min");
  check_positive("approach feed", plan.approach_feed / kMillimetrePerMinute, "mm/min");
  check_positive("clearance", to_mm(plan.clearance), "mm");
  check_positive("largest step", to_mm(plan.largest_step), "mm");
  check_positive("largest tilt", to_deg(plan.tilt_max), "deg");
  check_positive("filament diameter", to_mm(plan.filament_diameter), "mm");
  check_nozzle(plan.temperature, plan.fan);
  for (std::size_t l = 0; l < layers.size(); ++l)
    for (std::size_t i = 0; i < layers[l].size(); ++i) {
      const Waypoint& w = layers[l][i];
      const auto refuse = [&](const std::string& why) {
        throw InputError(
            Place{l < plan.files.size() ? plan.files[l] : ""},
            fmt::format("waypoint {} of layer {} at {} {}", i + 1, l + 1, in_mm(w.position), why));
      };
      if (w.position.z() < 0)
        refuse(fmt::format("lies {:.3f} mm under the table, lower than 0 mm", -to_mm(w.position.z())));
      if (const double tilt = angle(w.normal, Vec3::UnitZ()); tilt > plan.tilt_max)
        refuse(fmt::format("tilts the tool {:.3f} deg, more than {:.3f} deg", to_deg(tilt),
                           to_deg(plan.tilt_max)));
    }
}

class WaypointPrint {
 public:
  explicit WaypointPrint(const WaypointPlan& plan) : plan_(plan), builder_(plan.filament_diameter) {}

  WaypointProgram run(const std::vector<WaypointLayer>& layers) {
    for (const WaypointLayer& layer : layers)
      for (std::size_t first = 0; first < layer.size();) {
        std::size_t last = first;
        while (last + 1 < layer.size() && joined(layer[last], layer[last + 1])) ++last;
        last > first ? add_stroke(layer, first, last) : void(++result_.single_points);
        first = last + 1;
      }
    if (result_.strokes == 0)
      throw InputError(fmt::format("no two waypoints in a row are within the largest step of {:g} mm",
                                   to_mm(plan_.largest_step)));
    builder_.travel(clear_of(builder_.tool()));
    result_.program = builder_.take();
    return std::move(result_);
  }

 private:
  static Pose tool(const Waypoint& w) { return tool_at(w.position, w.normal); }

  // Two waypoints at one place are one.
  bool joined(const Waypoint& from, const Waypoint& to) const {
    const double step = (to.position - from.position).norm();
    return step > 0 && step <= plan_.largest_step && angle(from.normal, to.normal) <= kJump;
  }

  Pose clear_of(const Pose& X_WT) const {
    Pose clear = X_WT;
    clear.translation() += plan_.clearance * tool_axis(X_WT);
    return clear;
  }

  void add_stroke(const WaypointLayer& layer, std::size_t first, std::size_t last) {
    const Pose start = tool(layer[first]);
    if (builder_.empty())
      builder_.begin(clear_of(start), plan_.temperature, plan_.fan);
    else
      cross(start);
    builder_.travel(clear_of(start));
    builder_.move(start, plan_.approach_feed);
    printed_.push_back(layer[first].position);
    for (std::size_t i = first + 1; i <= last; ++i) {
      const double length = (layer[i].position - layer[i - 1].position).norm();
      builder_.print(tool(layer[i]), plan_.feed, bead_area(plan_.bead_width, plan_.bead_height) * length);
      printed_.push_back(layer[i].position);
      result_.printed += length;
    }
    ++result_.strokes;
  }

  // Away from the last stroke and over to where the next one is come down to: both ends are lifted along the
  // mean axis until what is printed lies below, so that the path across cannot cut through a bulge of it.
  void cross(const Pose& next) {
    const Pose from = clear_of(builder_.tool()), to = clear_of(next);
    builder_.travel(from);
    Vec3 up = tool_axis(from) + tool_axis(to);
    up = up.norm() > 0.1 ? Vec3(up.normalized()) : Vec3::UnitZ();  // 0.1: the axes face each other
    double level = std::max(up.dot(next.translation()), up.dot(builder_.tool().translation()));
    for (const Vec3& p : printed_) level = std::max(level, up.dot(p) + plan_.clearance);
    const auto lifted = [&](Pose X_WT) {
      X_WT.translation() += std::max(0.0, level - up.dot(X_WT.translation())) * up;
      return X_WT;
    };
    if (up.dot(from.translation()) < level) builder_.travel(lifted(from));
    if (up.dot(to.translation()) < level) builder_.travel(lifted(to));
  }

  WaypointPlan plan_;
  ProgramBuilder builder_;
  WaypointProgram result_;
  std::vector<Vec3> printed_;
};

}  // namespace

WaypointProgram plan_waypoints(const std::vector<WaypointLayer>& layers, const WaypointPlan& plan) {
  check(layers, plan);
  return WaypointPrint(plan).run(layers);
}

}  // namespace understudy::toolpath
