// A program's motion, planned beside the check of its poses (constraint_check.h): how fast the axes are, how
// long it takes, and when it comes past the places where something was found.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "control/motion/motion_planner.h"
#include "core/batch_thread.h"
#include "machine/description.h"

namespace understudy::control {

/// A place on a program's path.
struct PathLocation {
  std::size_t step = 0;
  double fraction = 0;  ///< of the step's path
  bool operator<(const PathLocation& o) const {
    return std::tie(step, fraction) < std::tie(o.step, o.fraction);
  }
};

/// Plans on a thread of its own. Calls are those of the program's order: first what was found on a step, then
/// the step.
class TimedPlan {
 public:
  TimedPlan(const machine::MachineDescription& machine, const MotionLimits& limits);

  /// Time is wanted of where `finding` lies now; of a finding that has moved, the newest place's.
  void find_time(std::size_t finding, const PathLocation& at) { found_.emplace_back(finding, at); }
  /// Next step of the program, which must outlive the plan.
  void add(const toolpath::Step& step);
  void add(toolpath::Step&& step) = delete;
  /// What is planned ends here: no step is added any more.
  void finish();

  // After finish().
  double duration() const { return duration_; }  ///< [s]
  /// [s]; of a place that the plan does not come to, its end.
  double time_of(std::size_t finding) const;
  const kinematics::AxisVector& velocity_max() const { return velocity_max_; }
  const kinematics::AxisVector& acceleration_max() const { return acceleration_max_; }
  /// The step, counted from 0, that the planner refuses: nothing is planned from there on.
  const std::optional<std::size_t>& refused() const { return refused_; }

 private:
  struct Next {
    const toolpath::Step* step = nullptr;  // none: the end
    std::vector<std::pair<std::size_t, PathLocation>> found;
  };

  void take(const Next& next);
  void plan(const toolpath::Step& step);
  void pass_points();
  void pass(const PathLocation& here, double time);

  std::unique_ptr<kinematics::Mechanism> mechanism_;
  double cycle_time_;  // [s]
  MotionPlanner planner_;
  std::size_t planned_ = 0;  // steps
  std::optional<std::size_t> refused_;
  kinematics::AxisVector velocity_{}, velocity_max_{}, acceleration_max_{};
  double duration_ = 0;
  std::vector<std::optional<double>> times_;             // by finding
  std::set<std::pair<PathLocation, std::size_t>> open_;  // findings that the plan has not passed
  std::vector<std::optional<PathLocation>> places_;      // by finding, of `open_`

  std::vector<std::pair<std::size_t, PathLocation>> found_;  // for the next step
  BatchThread<Next> thread_;
};

}  // namespace understudy::control
