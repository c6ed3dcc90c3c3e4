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
    : mechanics_(machine.visit(
          [&](const machine::HexapodModel&) { return make_hexapod_mechanics(machine, as_built, options); },
          [&](const machine::ChainModel&) { return make_chain_mechanics(machine, as_built, options); })),
      drives_(machine.drives),
      plays_(mechanics_->axis_count()),
      behind_(plays_),
      inertia_(options.inertia),
      mass_(axis_count(), axis_count()) {
  for (int i = 0; i < axis_count(); ++i) zero_[i] = mechanics_->axis_zero(i);
  repair();
}

void QuasistaticMachine::start_from_home() {
  mechanics_->start_from_home();
  plays_.centre();
  force_ = {};
}

void QuasistaticMachine::repair() {
  for (int i = 0; i < axis_count(); ++i) {
    const double stiffness = drives_[i].stiffness;
    compliance_[i] = stiffness > 0 ? 1 / stiffness : 0;
    growth_[i] = 0;
    plays_.set_play(i, mechanics_->built_play(i));
  }
  behind_ = plays_;
}

kinematics::AxisVector QuasistaticMachine::home_displacement() const {
  kinematics::AxisVector home = mechanics_->home();
  for (int i = 0; i < axis_count(); ++i) home[i] -= zero_[i];
  return home;
}

void QuasistaticMachine::loosen(int axis, double play_added) {
  SeriesPlay play = mechanics_->built_play(axis);
  play.inner += play_added;
  plays_.set_play(axis, play);
  behind_.set_play(axis, play);
}

AxisVector QuasistaticMachine::deflection() const {
  AxisVector yielded;
  elements(yielded) = elements(compliance_) * elements(force_);
  return yielded;
}

SolveStatus QuasistaticMachine::place(const AxisVector& position) {
  AxisVector truth;
  elements(truth) = elements(position) + elements(zero_) + elements(growth_) + elements(plays_.gap()) -
                    elements(deflection());
  return mechanics_->place(truth);
}

SolveStatus QuasistaticMachine::load(const AxisVector& velocity, const AxisVector& acceleration) {
  if (inertia_) return mechanics_->load(velocity, acceleration, load_);
  constexpr AxisVector kStill{};
  return mechanics_->load(kStill, kStill, load_);
}

/// True when a play has moved.
bool QuasistaticMachine::let_plays_rest(kinematics::PerAxis<bool>& floating, const AxisVector& position,
                                        const AxisVector& velocity, const AxisVector& acceleration,
                                        SolveStatus& status) {
  const AxisLoad first = load_;
  const AxisVector from = plays_.gap();
  bool moved = false;
  for (int i = 0; i < axis_count(); ++i) {
    const double target = plays_.resting_gap(i, first);
    if (floating[i] || target == from[i]) continue;
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
    const double to = plays_.gap()[i];
    const double before = first.drive[i] - first.between[i], after = load_.drive[i] - load_.between[i];
    if (to == from[i] || before * after >= 0 || plays_.resting_gap(i, load_) == to) continue;
    plays_.place(i, from[i] + (to - from[i]) * before / (before - after));
    floating[i] = true;
  }
  return true;
}

SolveStatus QuasistaticMachine::settle(const AxisVector& position, const AxisVector& velocity,
                                       const AxisVector& acceleration) {
  kinematics::PerAxis<bool> floating{};
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
  return compliance_ == AxisVector{} ? SolveStatus::ok : place(position);
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
