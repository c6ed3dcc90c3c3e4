#include "drivers/gcode/path_sampler.h"

namespace understudy::drivers {
namespace {

machine::SetpointQueueOptions queue_options(const machine::MachineDescription& machine,
                                            std::size_t capacity) {
  machine::SetpointQueueOptions queue;
  queue.capacity = capacity;
  const auto mechanism = machine.make_mechanism();
  for (int i = 0; i < mechanism->axis_count(); ++i) {
    queue.ranges.push_back(mechanism->axis_range(i));
    queue.rest_velocity[static_cast<std::size_t>(i)] = machine.drives[static_cast<std::size_t>(i)].step();
  }
  return queue;
}

}  // namespace

PathSampler::PathSampler(const machine::MachineDescription& machine, std::size_t capacity,
                         const machine::AxisVector& start, PoseWords* words)
    : queue_(queue_options(machine, capacity), start, 0), words_(words) {
  last_.position = start;
}

PathSample PathSampler::last_in_words() {
  PathSample sample = last_;
  if (words_ != nullptr) sample.position = words_->of_axes(last_.position);
  return sample;
}

PathSampler::Passed PathSampler::pass(double now, double next, BlockFitter& fitter) {
  if (queue_.moving() || queue_.rate_changes()) {
    if (!in_motion_) {
      last_.time = now;
      last_.executed = queue_.executed();
      fitter.begin(last_in_words());
      in_motion_ = true;
    }
    const auto& target = queue_.advance_to(next);
    last_ = {next, target.position, target.filament, target.line, queue_.executed()};
    fitter.add(last_in_words());
    if (queue_.ran_dry()) {
      in_motion_ = false;
      return Passed::ran_dry;
    }
  }
  queue_.pass(next - now, next);
  if (!in_motion_ || queue_.moving() || queue_.rate_changes()) return Passed::on;
  in_motion_ = false;
  return Passed::rests;
}

}  // namespace understudy::drivers
