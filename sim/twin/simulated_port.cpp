#include "sim/twin/simulated_port.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/process/process_age.h"

namespace understudy::sim {

using kinematics::AxisVector;
using machine::Fault;
using machine::Setpoint;
using machine::Status;

namespace {

/// Long enough to see where the tool goes when no motor holds it: free fall is 1.2 m.
constexpr double kCoastTime = 0.5;  // [s]

machine::SetpointQueueOptions queue_options(const machine::MachineDescription& machine,
                                            const kinematics::Mechanism& mechanism,
                                            const TwinOptions& options) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  machine::SetpointQueueOptions queue;
  queue.capacity = options.queue_capacity;
  for (int i = 0; i < mechanism.axis_count(); ++i) {
    queue.ranges.push_back(options.hold_at_limits ? kinematics::AxisRange{-kInfinity, kInfinity}
                                                  : mechanism.axis_range(i));
    // Rest means slower than one microstep a second: what is left cannot be seen by the drives.
    const auto axis = static_cast<std::size_t>(i);
    queue.rest_velocity[axis] = machine.drives[axis].step();
  }
  return queue;
}

AxisVector axes_at_home(const machine::MachineDescription& machine, const kinematics::Mechanism& mechanism) {
  AxisVector home{};
  const auto axes = static_cast<std::size_t>(mechanism.axis_count());
  const auto solved = mechanism.inverse(machine.X_BT_home, {}, std::span(home).first(axes));
  if (solved != kinematics::SolveStatus::ok)
    throw InputError(machine.file.string() + ": the home pose cannot be reached: " + to_string(solved));
  return home;
}

}  // namespace

SimulatedPort::SimulatedPort(const machine::MachineDescription& machine, Plant& plant, Exposure exposure,
                             std::vector<Observer*> observers, const TwinOptions& options)
    : machine_(machine),
      mechanism_(machine.make_mechanism()),
      plant_(plant),
      exposure_(std::move(exposure)),
      observers_(std::move(observers)),
      options_(options),
      drive_zero_(machine.drive_zero()),
      drives_(machine, options.faults),
      camera_(machine.microscope.camera, options.camera_faults, options.seed),
      queue_(queue_options(machine, *mechanism_, options), axes_at_home(machine, *mechanism_), plant.time()),
      X_BT_commanded_(machine.X_BT_home) {
  AxisVector displacement = queue_.target().position;
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] -= drive_zero_[i];
  plant_.reset(displacement);
  queue_.clear(plant_.time());
  steps_per_observation_ =
      std::max(1, static_cast<int>(std::lround(options.observation_period / plant_.timestep())));
}

SimulatedPort::~SimulatedPort() = default;

int SimulatedPort::axis_count() const { return mechanism_->axis_count(); }
double SimulatedPort::now() const { return plant_.time(); }

machine::AxisState SimulatedPort::state() const {
  machine::AxisState s;
  s.time = s.sampled_at = plant_.time();
  s.position = plant_.displacement();
  for (std::size_t i = 0; i < s.position.size(); ++i)
    s.position[i] = drives_.counts_only(static_cast<int>(i)) ? asked_[i] : s.position[i] + drive_zero_[i];
  s.accepted = queue_.accepted();
  s.executed = queue_.executed();
  s.free_slots = queue_.free_slots();
  s.moving = queue_.moving();
  s.fault = fault_;
  return s;
}

bool SimulatedPort::read_load(machine::LoadReading& reading) const {
  if (!options_.load_encoders || !options_.load_encoders->present()) return false;
  AxisVector near = plant_.displacement();
  for (std::size_t i = 0; i < near.size(); ++i) near[i] += drive_zero_[i];
  if (!options_.load_encoders->read(plant_.tool_pose(), near, reading.position)) return false;
  reading.sampled_at = plant_.time();
  return true;
}

Status SimulatedPort::submit(std::span<const Setpoint> setpoints, double deadline) {
  if (fault_ != Fault::none) return Status::faulted;
  if (plant_.time() > deadline) return Status::deadline_exceeded;
  if (!first_setpoint_at_) first_setpoint_at_ = process_age();
  return queue_.submit(setpoints, plant_.time());
}

/// The axes rest where they are to be, and what is queued is lost.
void SimulatedPort::raise(Fault fault) {
  fault_ = fault;
  queue_.clear(plant_.time());
}

DriveCommand SimulatedPort::command_for(const Target& target) {
  DriveCommand command;
  for (int axis = 0; axis < axis_count(); ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    double position = target.position[i], velocity = target.velocity[i];
    const kinematics::AxisRange range = mechanism_->axis_range(axis);
    if (options_.hold_at_limits && (position < range.lower || position > range.upper)) {
      position = std::clamp(position, range.lower, range.upper);
      velocity = 0;
    }
    double displacement = position - drive_zero_[i];
    if (options_.quantise_steps) {
      const double step = machine_.drives[i].step();
      displacement = std::round(displacement / step) * step;
    }
    command.position[i] = displacement;
    command.velocity[i] = velocity;
    asked_[i] = displacement + drive_zero_[i];
  }
  return command;
}

void SimulatedPort::advance() {
  const Target target = queue_.advance_to(plant_.time());
  if (queue_.ran_dry()) raise(Fault::underrun);
  DriveCommand command = command_for(target);
  drives_.apply(plant_.time(), command, plant_);
  if (steps_ % static_cast<std::uint64_t>(steps_per_observation_) == 0) observe(target);
  plant_.step(command);
  ++steps_;
  closure_max_ = std::max(closure_max_, plant_.closure_error());
  if (drives_.power_is_cut()) return coast(target, command);

  queue_.pass(plant_.timestep(), plant_.time());
}

/// The controller is gone with the power; the machine goes on moving as its load wants.
void SimulatedPort::coast(const Target& target, DriveCommand command) {
  command.velocity = {};
  const double end = plant_.time() + kCoastTime;
  while (plant_.time() < end) {
    if (steps_ % static_cast<std::uint64_t>(steps_per_observation_) == 0) observe(target);
    plant_.step(command);
    ++steps_;
  }
  outputs_ = {};
  raise(Fault::power);
}

void SimulatedPort::observe(const Target& target) {
  if (observers_.empty()) return;
  Snapshot s;
  s.time = plant_.time();
  s.X_WT = plant_.tool_pose();
  const auto axes = std::span(target.position).first(static_cast<std::size_t>(axis_count()));
  Pose X_BT;
  if (mechanism_->forward(axes, X_BT_commanded_, X_BT) == kinematics::SolveStatus::ok) X_BT_commanded_ = X_BT;
  s.X_WT_commanded = machine_.X_WB * X_BT_commanded_;
  s.axes_commanded = target.position;
  s.axes = state().position;
  s.axes_reached = plant_.displacement();
  for (std::size_t i = 0; i < s.axes_reached.size(); ++i) s.axes_reached[i] += drive_zero_[i];
  s.filament = target.filament;
  s.fan = outputs_.fan;
  s.nozzle_temperature = outputs_.nozzle_temperature;
  if (s.nozzle_temperature > 0) s.nozzle_temperature += options_.nozzle_offset;
  s.line = target.line;
  s.closure_error = plant_.closure_error();
  s.drive_force = plant_.drive_force();
  for (Observer* observer : observers_) observer->observe(s);
}

Status SimulatedPort::wait_until(double time) {
  // Half a step of slack: the clock is a sum of steps and must not run one step too far for its rounding.
  const double end = time - 0.5 * plant_.timestep();
  while (plant_.time() < end) {
    if (fault_ != Fault::none) return Status::faulted;
    try {
      advance();
    } catch (const MachineError& error) {
      engine_failure_ = error.what();
      raise(Fault::engine);
    }
  }
  return fault_ == Fault::none ? Status::ok : Status::faulted;
}

Status SimulatedPort::urgent(machine::UrgentCommand command) {
  switch (command) {
    case machine::UrgentCommand::hold:
      queue_.hold();
      return Status::ok;
    case machine::UrgentCommand::resume:
      queue_.resume();
      return Status::ok;
    case machine::UrgentCommand::stop:
      queue_.stop(plant_.time());
      return Status::ok;
    case machine::UrgentCommand::clear_fault:
      if (fault_ == Fault::engine || fault_ == Fault::power)
        return Status::faulted;  // no state to go on from: it diverged, or must be homed again
      fault_ = Fault::none;
      return Status::ok;
  }
  return Status::rejected;
}

Status SimulatedPort::set_outputs(const machine::Outputs& outputs, double deadline) {
  if (fault_ != Fault::none && !outputs.off()) return Status::faulted;
  if (plant_.time() > deadline) return Status::deadline_exceeded;
  outputs_ = outputs;
  return Status::ok;
}

/// In the middle of its exposure. Without pixels: it is lost.
machine::Frame SimulatedPort::expose(const Region& region) {
  camera_.ask(now());
  if (camera_.repeats_former() && !former_frame_.image.pixels.empty()) {
    camera_.count_former();
    return former_frame_;
  }
  machine::Frame frame;
  frame.image = camera_.expose({plant_.tool_pose(), region, frame_number_}, exposure_);
  frame.exposed_at = now();
  frame.number = frame_number_;
  return frame;
}

Status SimulatedPort::capture(const Region& region, machine::Frame& frame, double deadline) {
  const auto& microscope = machine_.microscope;
  const double start = now();
  if (start + microscope.exposure + microscope.transfer > deadline) return Status::deadline_exceeded;
  if (!exposure_) return Status::no_frame;
  if (const Status s = wait_until(start + 0.5 * microscope.exposure); s != Status::ok) return s;
  machine::Frame exposed = expose(region);
  if (const Status s = wait_until(start + microscope.exposure + microscope.transfer); s != Status::ok)
    return s;
  if (exposed.image.pixels.empty()) return Status::no_frame;
  frame = std::move(exposed);
  frame.received_at = now();
  if (frame.number == frame_number_) ++frame_number_;
  if (!camera_.sound()) former_frame_ = frame;
  return Status::ok;
}

}  // namespace understudy::sim
