#include "sim/twin/simulated_port.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace understudy::sim {

using kinematics::AxisVector;
using machine::Fault;
using machine::Setpoint;
using machine::Status;

namespace {

/// A hold brings the axes to rest in this time: at full speed (60 mm/s) well below the drives' acceleration.
constexpr double kHoldTime = 0.1;  // [s]

/// Long enough to see where the tool goes when no motor holds it: free fall is 1.2 m.
constexpr double kCoastTime = 0.5;  // [s]

/// Rest means slower than one microstep a second: what is left cannot be seen by the drives.
bool at_rest(const Setpoint& s, std::size_t axes, const machine::MachineDescription& machine) {
  for (std::size_t i = 0; i < axes; ++i)
    if (std::abs(s.velocity[i]) > machine.drives[i].step()) return false;
  return true;
}

/// Cubic Hermite between two setpoints.
void blend(const Setpoint& a, const Setpoint& b, double time, AxisVector& position, AxisVector& velocity) {
  const double h = b.time - a.time;
  const double u = std::clamp((time - a.time) / h, 0.0, 1.0);
  const double u2 = u * u, u3 = u2 * u;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const double step = b.position[i] - a.position[i];
    const double va = a.velocity[i] * h, vb = b.velocity[i] * h;
    position[i] = a.position[i] + step * (3 * u2 - 2 * u3) + va * (u3 - 2 * u2 + u) + vb * (u3 - u2);
    velocity[i] = (step * (6 * u - 6 * u2) + va * (3 * u2 - 4 * u + 1) + vb * (3 * u2 - 2 * u)) / h;
  }
}

}  // namespace

/// Where the controller wants the axes now, by its own geometry.
struct SimulatedPort::Target {
  AxisVector position{};
  AxisVector velocity{};
  double filament = 0;
  int line = 0;
};

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
      ring_(options.queue_capacity),
      X_BT_commanded_(machine.X_BT_home) {
  const int axes = mechanism_->axis_count();
  for (int i = 0; i < axes; ++i) ranges_.push_back(mechanism_->axis_range(i));
  const auto solved = mechanism_->inverse(machine.X_BT_home, {},
                                          std::span(last_.position).first(static_cast<std::size_t>(axes)));
  if (solved != kinematics::SolveStatus::ok)
    throw InputError(machine.file.string() + ": the home pose cannot be reached: " + to_string(solved));
  AxisVector displacement{};
  for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] = last_.position[i] - drive_zero_[i];
  plant_.reset(displacement);
  last_.time = plant_.time();
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
  s.accepted = accepted_;
  s.executed = executed_;
  s.free_slots = ring_.size() - size_;
  s.moving = size_ > 0 && queue_rate_ > 0;
  s.fault = fault_;
  return s;
}

Status SimulatedPort::submit(std::span<const Setpoint> setpoints, double deadline) {
  if (fault_ != Fault::none) return Status::faulted;
  if (plant_.time() > deadline) return Status::deadline_exceeded;
  if (setpoints.size() > ring_.size() - size_) return Status::queue_full;
  double time =
      size_ > 0 ? ring_[(head_ + size_ - 1) % ring_.size()].time : std::max(last_.time, now() - queue_lag_);
  for (const Setpoint& s : setpoints) {
    if (!(s.time > time) || !std::isfinite(s.filament)) return Status::rejected;
    for (int i = 0; i < axis_count(); ++i) {
      const auto axis = static_cast<std::size_t>(i);
      if (!std::isfinite(s.position[axis]) || !std::isfinite(s.velocity[axis])) return Status::rejected;
      if (s.position[axis] < ranges_[axis].lower || s.position[axis] > ranges_[axis].upper)
        return Status::rejected;
    }
    time = s.time;
  }
  if (size_ == 0) last_.time = now() - queue_lag_;  // the axes have rested at `last_` until now
  for (const Setpoint& s : setpoints) ring_[(head_ + size_++) % ring_.size()] = s;
  accepted_ += setpoints.size();
  return Status::ok;
}

SimulatedPort::Target SimulatedPort::target_at_queue_clock() {
  const double clock = plant_.time() - queue_lag_;
  while (size_ > 0 && ring_[head_].time <= clock) {
    last_ = ring_[head_];
    head_ = (head_ + 1) % ring_.size();
    --size_;
    ++executed_;
  }
  Target target;
  target.line = last_.line;
  target.filament = last_.filament;
  if (size_ == 0) {
    target.position = last_.position;
    if (!at_rest(last_, ranges_.size(), machine_)) fault_ = Fault::underrun;
    return target;
  }
  const Setpoint& next = ring_[head_];
  blend(last_, next, clock, target.position, target.velocity);
  const double share = std::clamp((clock - last_.time) / (next.time - last_.time), 0.0, 1.0);
  target.filament += share * (next.filament - last_.filament);
  target.line = next.line;
  for (double& v : target.velocity) v *= queue_rate_;
  return target;
}

void SimulatedPort::advance() {
  const Target target = target_at_queue_clock();
  DriveCommand command;
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    double displacement = target.position[i] - drive_zero_[i];
    if (options_.quantise_steps) {
      const double step = machine_.drives[i].step();
      displacement = std::round(displacement / step) * step;
    }
    command.position[i] = displacement;
    command.velocity[i] = target.velocity[i];
    asked_[i] = displacement + drive_zero_[i];
  }
  drives_.apply(plant_.time(), command, plant_);
  if (steps_ % static_cast<std::uint64_t>(steps_per_observation_) == 0) observe(target);
  plant_.step(command);
  ++steps_;
  closure_max_ = std::max(closure_max_, plant_.closure_error());
  if (drives_.power_is_cut()) return coast(target, command);

  const double dt = plant_.timestep();
  if (rate_slope_ != 0) {
    queue_rate_ = std::clamp(queue_rate_ + rate_slope_ * dt, 0.0, 1.0);
    if (queue_rate_ == 0 || queue_rate_ == 1) rate_slope_ = 0;
    if (queue_rate_ == 0 && drop_when_held_) return drop_queue(target);
  }
  queue_lag_ += (1 - queue_rate_) * dt;
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
  fault_ = Fault::power;
}

void SimulatedPort::drop_queue(const Target& target) {
  last_.position = target.position;
  last_.velocity = {};
  last_.filament = target.filament;
  last_.time = plant_.time();
  size_ = 0;
  queue_rate_ = 1;
  queue_lag_ = 0;
  drop_when_held_ = false;
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
  s.line = target.line;
  s.closure_error = plant_.closure_error();
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
      fault_ = Fault::engine;
    }
  }
  return fault_ == Fault::none ? Status::ok : Status::faulted;
}

Status SimulatedPort::urgent(machine::UrgentCommand command) {
  switch (command) {
    case machine::UrgentCommand::hold:
    case machine::UrgentCommand::stop:
      rate_slope_ = -1 / kHoldTime;
      drop_when_held_ = command == machine::UrgentCommand::stop;
      return Status::ok;
    case machine::UrgentCommand::resume:
      rate_slope_ = drop_when_held_ ? rate_slope_ : 1 / kHoldTime;
      return Status::ok;
    case machine::UrgentCommand::clear_fault:
      if (fault_ == Fault::engine || fault_ == Fault::power)
        return Status::faulted;  // no state to go on from: it diverged, or must be homed again
      fault_ = Fault::none;
      last_.velocity = {};
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

Status SimulatedPort::capture(const Region& region, machine::Frame& frame, double deadline) {
  const auto& microscope = machine_.microscope;
  const double start = now();
  if (start + microscope.exposure + microscope.transfer > deadline) return Status::deadline_exceeded;
  if (!exposure_) return Status::no_frame;
  if (const Status s = wait_until(start + 0.5 * microscope.exposure); s != Status::ok) return s;
  const double exposed_at = now();
  Image image = exposure_(plant_.tool_pose(), region, frame_number_);
  if (const Status s = wait_until(start + microscope.exposure + microscope.transfer); s != Status::ok)
    return s;
  if (image.pixels.empty()) return Status::no_frame;
  frame.image = std::move(image);
  frame.exposed_at = exposed_at;
  frame.received_at = now();
  frame.number = frame_number_++;
  return Status::ok;
}

}  // namespace understudy::sim
