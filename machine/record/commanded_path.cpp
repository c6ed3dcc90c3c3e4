#include "machine/record/commanded_path.h"

#include <algorithm>
#include <limits>

#include "core/error.h"

namespace understudy::machine {
namespace {

constexpr double kGrain = 0.5e-3;             // [s], of the queue's clock while it brakes: as the twin's
constexpr std::size_t kCapacity = 1U << 17U;  // more than any port's

SetpointQueueOptions endless(int axes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SetpointQueueOptions options;
  options.capacity = kCapacity;
  options.ranges.assign(static_cast<std::size_t>(axes), {-kInfinity, kInfinity});
  return options;
}

AxisVector home_of(const MachineDescription& machine) {
  AxisVector home{};
  const auto mechanism = machine.make_mechanism();
  const auto axes = static_cast<std::size_t>(mechanism->axis_count());
  if (mechanism->inverse(machine.X_BT_home, {}, std::span(home).first(axes)) != kinematics::SolveStatus::ok)
    throw InputError(machine.file.string() + ": the home pose cannot be reached");
  return home;
}

}  // namespace

CommandedPath::CommandedPath(const RecordedMotion& motion, const MachineDescription& machine)
    : motion_(motion), queue_(endless(motion.axes), home_of(machine), motion.begins), now_(motion.begins) {}

void CommandedPath::run_to(double time) {
  while (now_ < time) {
    const double step = std::min(kGrain, time - now_);
    now_ = time - now_ <= kGrain ? time : now_ + step;
    queue_.advance_to(now_);
    queue_.pass(step, now_);
  }
}

void CommandedPath::apply(const RecordedCommand& command) {
  if (const auto* setpoints = std::get_if<std::vector<Setpoint>>(&command.what)) {
    // The port took them; so does this queue, which is larger.
    static_cast<void>(queue_.submit(*setpoints, now_));
    return;
  }
  switch (std::get<UrgentCommand>(command.what)) {
    case UrgentCommand::hold:
      return queue_.hold();
    case UrgentCommand::resume:
      return queue_.resume();
    case UrgentCommand::stop:
      return queue_.stop(now_);
    case UrgentCommand::clear_fault:
      return;
  }
}

const SetpointQueue::Target& CommandedPath::at(double time) {
  while (next_ < motion_.commands.size() && motion_.commands[next_].now <= time) {
    run_to(motion_.commands[next_].now);
    apply(motion_.commands[next_++]);
  }
  run_to(time);
  return queue_.advance_to(now_);
}

}  // namespace understudy::machine
