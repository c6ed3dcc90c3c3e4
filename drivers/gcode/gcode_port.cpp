#include "drivers/gcode/gcode_port.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"

namespace understudy::drivers {

using machine::AxisVector;
using machine::Fault;
using machine::Status;

namespace {

constexpr double kTick = 4e-3;       // [s], between two looks at the link
constexpr double kSlip = 0.02;       // [s], by which our clock catches up; beyond, it is put back
constexpr double kBacklogMax = 1.0;  // [s], of blocks that the controller does not take
constexpr double kSettleTime = 10;   // [s], for what a fault leaves on its way
constexpr double kBlockTime = 0.1;   // [s], at most: what a stop waits for
constexpr double kPoseTime = 0.2;    // [s], likewise on LinuxCNC, which takes few blocks

FitTolerance driving(const GcodeSetup& setup) {
  FitTolerance tolerance = setup.tolerance;
  tolerance.block_time_max =
      std::min(tolerance.block_time_max, setup.family == GcodeFamily::linuxcnc ? kPoseTime : kBlockTime);
  return tolerance;
}

/// Connected before the queue is made of where the machine stands.
std::unique_ptr<Controller> connected(ByteLink& link, const GcodeSetup& setup, PoseWords* words) {
  std::unique_ptr<Controller> controller;
  if (words != nullptr)
    controller = std::make_unique<LinuxcncSession>(link, *words, setup.session, setup.another);
  else
    controller = std::make_unique<GcodeSession>(link, GcodeWriter(setup.family, setup.axes), setup.session);
  controller->connect();
  return controller;
}

}  // namespace

GcodePort::GcodePort(std::unique_ptr<ByteLink> link, const GcodeSetup& setup,
                     const machine::MachineDescription& machine)
    : setup_(setup),
      link_(std::move(link)),
      words_(setup.family == GcodeFamily::linuxcnc ? std::make_unique<PoseWords>(machine) : nullptr),
      controller_(connected(*link_, setup, words_.get())),
      path_(machine, setup.queue_capacity, controller_->position(), words_.get()),
      fitter_(driving(setup), setup.axes.grid, setup.axes.turns),
      anchor_(link_->now()) {
  fitter_.begin(path_.last_in_words());
  controller_->begin(path_.last_in_words());
}

machine::AxisState GcodePort::state() const {
  machine::AxisState s;
  s.time = now_;
  s.sampled_at = std::min(now_, controller_->position_time() - anchor_);
  s.position = controller_->position();
  s.accepted = path_.queue().accepted();
  s.executed = controller_->executed();
  s.free_slots = path_.queue().free_slots();
  s.moving = fault_ == Fault::none &&
             (path_.queue().moving() || path_.queue().rate_changes() || path_.in_motion() || streaming_);
  s.fault = fault_;
  return s;
}

Status GcodePort::submit(std::span<const machine::Setpoint> setpoints, double deadline) {
  if (fault_ != Fault::none) return Status::faulted;
  if (now_ > deadline) return Status::deadline_exceeded;
  return path_.queue().submit(setpoints, now_);
}

/// Nothing of the path is on its way any more.
void GcodePort::raise(Fault fault, const std::string& why) {
  if (fault_ != Fault::none) return;
  fault_ = fault;
  fault_text_ = why;
  path_.queue().advance_to(now_);
  path_.queue().clear(now_);
}

bool GcodePort::time_stands() const { return heating_ || controller_->backlog() > kBacklogMax; }

/// Blocks that are settled; to the controller once it has enough ahead, or `all`.
void GcodePort::hand_over(bool all) {
  while (const auto block = fitter_.take()) {
    held_.push_back(*block);
    held_time_ += block->duration;
  }
  if (!all && !streaming_ && held_time_ + fitter_.pending() < setup_.latency) return;
  for (const Block& block : held_) controller_->push(block);
  streaming_ = streaming_ || !held_.empty();
  held_.clear();
  held_time_ = 0;
}

/// The queue is empty and its last setpoint rests: the controller is to say that it stands there.
void GcodePort::end_of_motion() {
  fitter_.finish();
  hand_over(true);
  controller_->push_rest(path_.last().position);
  streaming_ = true;
}

/// The queue's clock runs to `until`, and the path that it passes becomes blocks.
void GcodePort::release(double until) {
  while (now_ < until && fault_ == Fault::none) {
    const double next = std::min(until, now_ + kSampleTime);
    const auto passed = path_.pass(now_, next, fitter_);
    now_ = next;
    if (passed != PathSampler::Passed::on) end_of_motion();
    if (passed == PathSampler::Passed::ran_dry)
      raise(Fault::underrun, "the queue ran empty in motion: the computer is too slow for the path");
  }
  hand_over(false);
}

/// One look at the link and, unless time stands, a step of the port's clock. False: a fault came.
bool GcodePort::step(double until) {
  const double next = std::min(until, now_ + kTick);
  if (link_->now() - anchor_ - now_ > kSlip) anchor_ = link_->now() - now_ - kSlip;
  try {
    link_->wait(time_stands() ? link_->now() + kTick : anchor_ + next);
  } catch (const MachineError& error) {
    controller_->fail(Fault::power, error.what());
  }
  controller_->pump();
  if (words_ != nullptr && words_->lost())
    controller_->fail(Fault::drive, "these axis positions belong to no pose: the kinematics has no answer");
  if (controller_->settled()) {
    streaming_ = false;
    heating_ = false;
  }
  if (controller_->fault() != Fault::none) {
    raise(controller_->fault(), controller_->fault_text());
    if (!outputs_.off()) controller_->outputs_off();
    return false;
  }
  if (time_stands()) {
    anchor_ = link_->now() - now_;
    if (anchor_ - stood_from_ > kHeatTime)
      raise(Fault::drive,
            heating_ ? "the nozzle does not become hot" : "the controller takes no more blocks");
    return fault_ == Fault::none;
  }
  stood_from_ = anchor_;
  if (link_->now() < anchor_ + next) return true;  // bytes came first
  release(next);
  controller_->pump();
  return fault_ == Fault::none;
}

/// The controller goes on to where it was sent, on its own time.
void GcodePort::settle() {
  const double deadline = link_->now() + kSettleTime;
  while (!controller_->settled() && controller_->fault() == Fault::none && link_->now() < deadline) {
    try {
      link_->wait(link_->now() + kTick);
    } catch (const MachineError& error) {
      controller_->fail(Fault::power, error.what());
    }
    controller_->pump();
  }
}

Status GcodePort::wait_until(double time) {
  while (fault_ == Fault::none && now_ < time) step(time);
  if (fault_ == Fault::underrun) {
    settle();
    streaming_ = false;
  }
  return fault_ == Fault::none ? Status::ok : Status::faulted;
}

Status GcodePort::urgent(machine::UrgentCommand command) {
  switch (command) {
    case machine::UrgentCommand::hold:
      path_.queue().hold();
      return Status::ok;
    case machine::UrgentCommand::resume:
      path_.queue().resume();
      return Status::ok;
    case machine::UrgentCommand::stop:
      path_.queue().stop(now_);
      return Status::ok;
    case machine::UrgentCommand::clear_fault:
      if (fault_ != Fault::none && controller_->fault() != Fault::none) return Status::faulted;
      if (fault_ == Fault::emergency_stop) return Status::faulted;
      fault_ = Fault::none;
      fault_text_.clear();
      return Status::ok;
  }
  return Status::rejected;
}

Status GcodePort::set_outputs(const machine::Outputs& outputs, double deadline) {
  if (fault_ != Fault::none && !outputs.off()) return Status::faulted;
  if (now_ > deadline) return Status::deadline_exceeded;
  if (!setup_.outputs) return outputs.off() ? Status::ok : Status::rejected;
  if (controller_->fault() != Fault::none) {
    controller_->outputs_off();
  } else {
    heating_ = controller_->push_outputs(outputs_, outputs) || heating_;
    const bool same =
        outputs.fan == outputs_.fan && outputs.nozzle_temperature == outputs_.nozzle_temperature;
    if (!same) controller_->push_rest(path_.last().position);
    controller_->pump();
    if (words_ != nullptr && outputs.off() && !same) settle();  // LinuxCNC takes its time for a line
  }
  outputs_ = outputs;
  return Status::ok;
}

Status GcodePort::capture(const Region& /*region*/, machine::Frame& /*frame*/, double deadline) {
  return now_ > deadline ? Status::deadline_exceeded : Status::no_frame;
}

void GcodePort::emergency_stop() {
  controller_->emergency_stop();
  controller_->fail(Fault::emergency_stop, "stopped as an emergency");
  raise(Fault::emergency_stop, "stopped as an emergency: home the machine before the next print");
}

}  // namespace understudy::drivers
