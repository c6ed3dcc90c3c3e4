#include "control/motion/timed_plan.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace understudy::control {
namespace {

constexpr std::size_t kBatch = 64;  // steps

}  // namespace

TimedPlan::TimedPlan(const machine::MachineDescription& machine, const MotionLimits& limits)
    : mechanism_(machine.make_mechanism()),
      cycle_time_(limits.cycle_time),
      planner_(*mechanism_, machine.X_WB, limits, {machine.X_WB * machine.X_BT_home}, PoseCheck::solvable),
      thread_(
          [this](std::vector<Next>& batch) {
            for (const Next& next : batch) take(next);
          },
          kBatch) {}

void TimedPlan::add(const toolpath::Step& step) { thread_.push({&step, std::exchange(found_, {})}); }

void TimedPlan::finish() {
  thread_.push({nullptr, std::exchange(found_, {})});
  thread_.drain();
}

double TimedPlan::time_of(std::size_t finding) const {
  return finding < times_.size() ? times_[finding].value_or(duration_) : duration_;
}

void TimedPlan::take(const Next& next) {
  for (const auto& [finding, at] : next.found) {
    if (finding >= places_.size()) {
      places_.resize(finding + 1);
      times_.resize(finding + 1);
    }
    if (places_[finding]) open_.erase({*places_[finding], finding});
    places_[finding] = at;
    times_[finding].reset();
    open_.emplace(at, finding);
  }
  if (!next.step) {
    planner_.finish();
    pass_points();
  } else if (!refused_) {
    plan(*next.step);
  }
}

void TimedPlan::plan(const toolpath::Step& step) {
  try {
    planner_.push(step);
  } catch (const InputError&) {
    refused_ = planned_;
    return;
  }
  ++planned_;
  // The machine waits here until the outputs are set.
  if (step.kind == toolpath::StepKind::temperature || step.kind == toolpath::StepKind::fan) planner_.finish();
  pass_points();
}

void TimedPlan::pass_points() {
  PlannedPoint point;
  while (planner_.next(point)) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(mechanism_->axis_count()); ++i) {
      const double velocity = point.setpoint.velocity[i];
      velocity_max_[i] = std::max(velocity_max_[i], std::abs(velocity));
      acceleration_max_[i] = std::max(acceleration_max_[i], std::abs(velocity - velocity_[i]) / cycle_time_);
      velocity_[i] = velocity;
    }
    pass({point.step, point.fraction}, point.setpoint.time);
  }
}

void TimedPlan::pass(const PathLocation& here, double time) {
  duration_ = time;
  while (!open_.empty() && !(here < open_.begin()->first)) {
    const std::size_t finding = open_.begin()->second;
    times_[finding] = time;
    places_[finding].reset();
    open_.erase(open_.begin());
  }
}

}  // namespace understudy::control
