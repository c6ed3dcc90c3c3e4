#include "sim/plant/quasistatic/quasistatic_machine.h"

namespace understudy::sim {
namespace {

using kinematics::SolveStatus;

// Each round lets every play go where its load pushes it. A play that moves changes the loads of others by
// the play over the size of the machine, so a second round is rare.
constexpr int kRounds = 4;

}  // namespace

QuasistaticMachine::QuasistaticMachine(const machine::MachineDescription& machine, const AsBuilt& as_built,
                                       const QuasistaticOptions& options)
    : mechanics_(machine.chain ? make_chain_mechanics(machine, as_built, options)
                               : make_hexapod_mechanics(machine, as_built, options)),
      drives_(machine.drives),
      plays_(mechanics_->axis_count()),
      behind_(plays_),
      inertia_(options.inertia),
      zero_(axis_count()),
      growth_(AxisVector::Zero(axis_count())),
      compliance_(AxisVector::Zero(axis_count())),
      force_(AxisVector::Zero(axis_count())),
      load_{force_, force_},
      mass_(axis_count(), axis_count()) {
  for (int i = 0; i < axis_count(); ++i) zero_(i) = mechanics_->axis_zero(i);
  repair();
}

void QuasistaticMachine::start_from_home() {
  mechanics_->start_from_home();
  plays_.centre();
  force_.setZero();
}

void QuasistaticMachine::repair() {
  for (int i = 0; i < axis_count(); ++i) {
    const double stiffness = drives_[static_cast<std::size_t>(i)].stiffness;
    compliance_(i) = stiffness > 0 ? 1 / stiffness : 0;
    growth_(i) = 0;
    plays_.set_play(i, mechanics_->built_play(i));
  }
  behind_ = plays_;
}

machine::AxisArray QuasistaticMachine::home_displacement() const {
  machine::AxisArray home = mechanics_->home();
  for (int i = 0; i < axis_count(); ++i) home[static_cast<std::size_t>(i)] -= zero_(i);
  return home;
}

void QuasistaticMachine::loosen(int axis, double play_added) {
  SeriesPlay play = mechanics_->built_play(axis);
  play.inner += play_added;
  plays_.set_play(axis, play);
  behind_.set_play(axis, play);
}

SolveStatus QuasistaticMachine::place(const AxisVector& position) {
  const AxisVector truth = position + zero_ + growth_ + plays_.gap() - deflection();
  return mechanics_->place(truth);
}

SolveStatus QuasistaticMachine::load(const AxisVector& velocity, const AxisVector& acceleration) {
  if (inertia_) return mechanics_->load(velocity, acceleration, load_);
  const AxisVector still = AxisVector::Zero(axis_count());
  return mechanics_->load(still, still, load_);
}

/// True when a play has moved.
bool QuasistaticMachine::let_plays_rest(std::array<bool, kMaxPlays>& floating, const AxisVector& position,
                                        const AxisVector& velocity, const AxisVector& acceleration,
                                        SolveStatus& status) {
  const AxisLoad first = load_;
  const AxisVector from = plays_.gap();
  bool moved = false;
  for (int i = 0; i < axis_count(); ++i) {
    const double target = plays_.resting_gap(i, first);
    if (floating[static_cast<std::size_t>(i)] || target == from(i)) continue;
    plays_.place(i, target);
    moved = true;
  }
  if (!moved) return false;
  status = place(position);
  if (status == SolveStatus::ok) status = load(velocity, acceleration);
  if (status != SolveStatus::ok) return false;
  // The pose that a play makes changes its own load. Where that pushes it back again, it floats between, in
  // the one place where it carries nothing.
  for (int i = 0; i < axis_count(); ++i) {
    const double to = plays_.gap()(i);
    const double before = first.drive(i) - first.between(i), after = load_.drive(i) - load_.between(i);
    if (to == from(i) || before * after >= 0 || plays_.resting_gap(i, load_) == to) continue;
    plays_.place(i, from(i) + (to - from(i)) * before / (before - after));
    floating[static_cast<std::size_t>(i)] = true;
  }
  return true;
}

SolveStatus QuasistaticMachine::settle(const AxisVector& position, const AxisVector& velocity,
                                       const AxisVector& acceleration) {
  std::array<bool, kMaxPlays> floating{};
  for (int round = 0; round < kRounds; ++round) {
    SolveStatus status = place(position);
    if (status == SolveStatus::ok) status = load(velocity, acceleration);
    if (status != SolveStatus::ok) return status;
    const bool moved = let_plays_rest(floating, position, velocity, acceleration, status);
    if (status != SolveStatus::ok) return status;
    force_ = load_.drive;
    if (!moved) break;
  }
  behind_ = plays_;
  return compliance_.isZero() ? SolveStatus::ok : place(position);
}

SolveStatus QuasistaticMachine::advance(const Step& step) {
  SolveStatus status = load(step.velocity, step.acceleration);
  if (status != SolveStatus::ok) return status;
  if (behind_.rests(load_)) {
    force_ = load_.drive;
    plays_ = behind_;
  } else {
    mechanics_->mass_matrix(mass_);
    behind_.advance(mass_, load_, step.duration);
    if (step.ahead != step.acceleration) status = load(step.velocity, step.ahead);
    if (status != SolveStatus::ok) return status;
    plays_ = behind_;
    force_ = plays_.advance(mass_, load_, step.duration);
  }
  return place(step.end);
}

}  // namespace understudy::sim
