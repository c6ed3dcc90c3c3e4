// The plant and the sampler: commands and time around QuasistaticMachine.
#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "sim/plant/quasistatic/quasistatic.h"
#include "sim/plant/quasistatic/quasistatic_machine.h"

namespace understudy::sim {
namespace {

using kinematics::SolveStatus;

// A velocity that changes faster than this, in accelerations of the drive, is a jump: it is over already.
constexpr double kJump = 1.5;

void check_input(const machine::MachineDescription& machine, const AsBuilt& as_built,
                 const QuasistaticOptions& options) {
  if (!(options.timestep > 0 && std::isfinite(options.timestep)))
    throw InputError(fmt::format("timestep is {} s, not above 0", options.timestep));
  if (!options.nozzle_force_T.allFinite()) throw InputError("the nozzle force is not finite");
  if (machine.is_chain() && machine.chain().kinematics.chain.size() != as_built.chain.size())
    throw InputError(fmt::format("the as-built machine has {} axes, its description {}",
                                 as_built.chain.size(), machine.chain().kinematics.chain.size()));
}

class QuasistaticPlant final : public Plant {
 public:
  QuasistaticPlant(const machine::MachineDescription& machine, const AsBuilt& as_built,
                   const QuasistaticOptions& options)
      : drives_(machine.drives),
        timestep_(options.timestep),
        machine_(machine, as_built, options),
        motion_{.duration = options.timestep} {
    reset(machine_.home_displacement());
  }

  std::string engine() const override { return "quasistatic"; }
  double timestep() const override { return timestep_; }
  double time() const override { return static_cast<double>(steps_) * timestep_; }

  void reset(const AxisVector& displacement) override;
  void step(const DriveCommand& command) override;
  void set_condition(int axis, const AxisCondition& condition) override;

  Pose tool_pose() const override { return machine_.tool_pose(); }
  AxisVector displacement() const override;
  AxisVector drive_force() const override { return machine_.drive_force(); }
  double closure_error() const override { return machine_.mechanics().closure_error(); }

 private:
  void demand(SolveStatus status) const;
  void follow(const DriveCommand& command);

  kinematics::PerAxis<machine::Drive> drives_;
  double timestep_;
  QuasistaticMachine machine_;
  kinematics::PerAxis<bool> held_{};
  AxisVector reached_{};  ///< by the drives, deflection not counted
  QuasistaticMachine::Step motion_;
  long steps_ = 0;
  bool failed_ = true;  ///< the state is no result
};

void QuasistaticPlant::demand(SolveStatus status) const {
  if (status == SolveStatus::ok) return;
  std::string places;
  for (int i = 0; i < machine_.axis_count(); ++i)
    places += fmt::format(" {:.3f}", 1e3 * (reached_[i] + machine_.mechanics().axis_zero(i)));
  throw MachineError(fmt::format(
      "engine failure at {:.4f} s: the loops cannot be closed for axis positions{} (mm or mrad): {}", time(),
      places, kinematics::to_string(status)));
}

void QuasistaticPlant::reset(const AxisVector& displacement) {
  failed_ = true;
  steps_ = 0;
  held_.fill(false);
  motion_ = {.duration = timestep_};
  reached_ = displacement;
  machine_.repair();
  machine_.start_from_home();
  demand(machine_.settle(reached_, {}, {}));
  failed_ = false;
}

AxisVector QuasistaticPlant::displacement() const {
  AxisVector displacement;
  elements(displacement) = elements(reached_) - elements(machine_.deflection());
  return displacement;
}

void QuasistaticPlant::follow(const DriveCommand& command) {
  for (int i = 0; i < machine_.axis_count(); ++i) {
    if (!std::isfinite(command.position[i] + command.velocity[i]))
      throw MachineError(
          fmt::format("drive {} is commanded to a position that is not finite at {:.4f} s", i + 1, time()));
    motion_.acceleration[i] = motion_.ahead[i] = 0;
    if (held_[i]) continue;
    const double acceleration = (command.velocity[i] - motion_.velocity[i]) / timestep_;
    const bool jump =
        drives_[i].acceleration_max > 0 && std::abs(acceleration) > kJump * drives_[i].acceleration_max;
    motion_.velocity[i] = command.velocity[i];
    motion_.acceleration[i] = acceleration;
    motion_.ahead[i] = jump ? 0 : acceleration;
    reached_[i] = command.position[i] + timestep_ * (command.velocity[i] + timestep_ / 2 * motion_.ahead[i]);
  }
  motion_.end = reached_;
}

void QuasistaticPlant::step(const DriveCommand& command) {
  if (failed_) throw MachineError("engine failure: the plant has failed before and was not reset");
  failed_ = true;
  follow(command);
  demand(machine_.advance(motion_));
  ++steps_;
  failed_ = false;
}

void QuasistaticPlant::set_condition(int axis, const AxisCondition& condition) {
  if (axis < 0 || axis >= machine_.axis_count())
    throw InputError(fmt::format("axis {} is not one of {}", axis + 1, machine_.axis_count()));
  const std::string name = machine_.mechanics().axis_name(axis);
  if (condition.released && !drives_[axis].self_locking)
    throw MachineError(
        fmt::format("{} is released and not self-locking: quasistatic cannot play an axis that falls", name));
  const double built = machine_.mechanics().built_play(axis).total();
  if (!(built + condition.play_added >= 0) || !std::isfinite(condition.play_added))
    throw InputError(fmt::format("{}: {} m or rad more play than {} is not at least 0", name,
                                 condition.play_added, built));
  if (!std::isfinite(condition.growth)) throw InputError(fmt::format("{}: growth is not finite", name));
  machine_.loosen(axis, condition.play_added);
  machine_.grow(axis, condition.growth);
  if (condition.released && !held_[axis]) {
    reached_[axis] -= machine_.deflection()[axis];
    machine_.stiffen(axis);
    motion_.velocity[axis] = 0;
  }
  held_[axis] = condition.released;
}

}  // namespace

std::unique_ptr<Plant> make_quasistatic_plant(const machine::MachineDescription& machine,
                                              const AsBuilt& as_built, const QuasistaticOptions& options) {
  check_input(machine, as_built, options);
  return std::make_unique<QuasistaticPlant>(machine, as_built, options);
}

QuasistaticSampler::QuasistaticSampler(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                       const QuasistaticOptions& options) {
  check_input(machine, as_built, options);
  machine_ = std::make_unique<QuasistaticMachine>(machine, as_built, options);
  restart();
}

QuasistaticSampler::~QuasistaticSampler() = default;
QuasistaticSampler::QuasistaticSampler(QuasistaticSampler&&) noexcept = default;
QuasistaticSampler& QuasistaticSampler::operator=(QuasistaticSampler&&) noexcept = default;

void QuasistaticSampler::restart() {
  machine_->start_from_home();
  const SolveStatus status = machine_->settle(machine_->home_displacement(), {}, {});
  if (status != SolveStatus::ok)
    throw MachineError(
        fmt::format("the machine cannot be assembled at home: {}", kinematics::to_string(status)));
}

SolveStatus QuasistaticSampler::sample(const PathSample& at, Pose& X_WT) {
  for (int i = 0; i < machine_->axis_count(); ++i)
    if (!std::isfinite(at.position[i] + at.velocity[i] + at.acceleration[i])) return SolveStatus::bad_input;
  const SolveStatus status = machine_->settle(at.position, at.velocity, at.acceleration);
  if (status == SolveStatus::ok)
    X_WT = machine_->tool_pose();
  else
    machine_->start_from_home();
  return status;
}

std::size_t QuasistaticSampler::sample(std::span<const PathSample> path, std::span<Pose> X_WT) {
  const std::size_t count = std::min(path.size(), X_WT.size());
  for (std::size_t k = 0; k < count; ++k)
    if (sample(path[k], X_WT[k]) != SolveStatus::ok) return k;
  return count;
}

AxisVector QuasistaticSampler::drive_force() const { return machine_->drive_force(); }
AxisVector QuasistaticSampler::gap() const { return machine_->plays().gap(); }
void QuasistaticSampler::place_gap(int axis, double gap) { machine_->place_gap(axis, gap); }

}  // namespace understudy::sim
