// Chains whose tool hangs on rods: three spheres' intersection, and what slides, rods and tool ask of the
// drives. Rods are thin: a pair of mass m whose ends have the accelerations a and b takes m (2 a + b) / 6 at
// the one and m (a + 2 b) / 6 at the other. All in O.
#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "kinematics/chain/rods.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/quasistatic/axis_mechanics.h"

namespace understudy::sim {
namespace {

using kinematics::kRods;
using kinematics::SolveStatus;

class RodMechanics final : public AxisMechanics {
 public:
  RodMechanics(const machine::MachineDescription& machine, const AsBuilt& as_built,
               const QuasistaticOptions& options)
      : chain_(as_built.chain),
        links_(machine.chain().links),
        rods_(machine.chain().rods),
        zero_(as_built.axis_zero),
        home_(machine.chain().kinematics.home),
        X_WO_(machine.X_WB * as_built.chain.X_OS_zero.inverse()),
        gravity_(0, 0, options.gravity ? kGravity : 0.0),
        nozzle_force_(as_built.chain.X_OT_zero.linear() * options.nozzle_force_T) {
    for (std::size_t i = 0; i < kRods; ++i) {
      home_[i] += zero_[i];
      play_[i].damping = kPlayDamping;
      play_[i].friction = machine.chain().friction[i];
      if (options.play) play_[i].inner = as_built.axis_play[i];
    }
    start_from_home();
  }

  int axis_count() const override { return kRods; }
  std::string axis_name(int axis) const override { return "axis " + chain_.axes[std::size_t(axis)].name; }
  double axis_zero(int axis) const override { return zero_[std::size_t(axis)]; }
  SeriesPlay built_play(int axis) const override { return play_[std::size_t(axis)]; }
  AxisVector home() const override { return home_; }

  void start_from_home() override { static_cast<void>(place(home_)); }
  SolveStatus place(const AxisVector& position) override;
  Pose tool_pose() const override { return X_WO_ * (Eigen::Translation3d(meet_) * chain_.X_OT_zero); }
  double closure_error() const override;

  SolveStatus load(const AxisVector& velocity, const AxisVector& acceleration, AxisLoad& load) override;
  void mass_matrix(AxisMatrix& mass) const override;

 private:
  const Vec3& direction(int i) const { return chain_.axes[std::size_t(i)].direction; }

  kinematics::Chain chain_;
  std::vector<machine::Link> links_;
  machine::Rods rods_;
  AxisVector zero_, home_;
  PerAxis<SeriesPlay> play_;
  Pose X_WO_;
  Vec3 gravity_;  ///< as an acceleration of the frame, upwards
  Vec3 nozzle_force_;

  AxisVector position_{};
  Vec3 meet_ = Vec3::Zero();
  Mat3 vectors_ = Mat3::Zero(), J_ = Mat3::Zero();  ///< of the rods; d(meet)/d(slides)
};

SolveStatus RodMechanics::place(const AxisVector& position) {
  if (!kinematics::column(position, kRods).allFinite()) return SolveStatus::bad_input;
  Vec3 meet;
  const SolveStatus status = kinematics::rods_meet(chain_, position, meet);
  if (status != SolveStatus::ok) return status;
  position_ = position;
  meet_ = meet;
  vectors_ = kinematics::rod_vectors(chain_, position_, meet_);
  J_ = kinematics::rod_jacobian(chain_, vectors_);
  return SolveStatus::ok;
}

double RodMechanics::closure_error() const {
  double worst = 0;
  for (int i = 0; i < kRods; ++i)
    worst = std::max(worst, std::abs(vectors_.row(i).norm() - chain_.rods[std::size_t(i)]));
  return worst;
}

SolveStatus RodMechanics::load(const AxisVector& velocity, const AxisVector& acceleration, AxisLoad& load) {
  if (J_.isZero()) return SolveStatus::singular;
  const Vec3 q_rate(velocity[0], velocity[1], velocity[2]),
      q_rate2(acceleration[0], acceleration[1], acceleration[2]);
  const Vec3 v = J_ * q_rate;
  // u (p'' - d q'') + |p' - d q'|^2 = 0 for every rod u.
  Vec3 turning;
  for (int i = 0; i < kRods; ++i) turning[i] = -(v - q_rate[i] * direction(i)).squaredNorm();
  const Vec3 tool = J_ * q_rate2 + vectors_.inverse() * turning + gravity_;

  Vec3 carried = rods_.carried * tool - nozzle_force_, slides;
  for (int i = 0; i < kRods; ++i) {
    const Vec3 slide = q_rate2[i] * direction(i) + gravity_;
    carried += rods_.mass / 6 * (slide + 2 * tool);
    slides[i] = direction(i).dot(links_[std::size_t(i)].mass * slide + rods_.mass / 6 * (2 * slide + tool));
  }
  const Vec3 force = slides + J_.transpose() * carried;
  for (int i = 0; i < kRods; ++i) {
    load.drive[std::size_t(i)] = force[i];
    load.between[std::size_t(i)] = 0;
  }
  return SolveStatus::ok;
}

void RodMechanics::mass_matrix(AxisMatrix& mass) const {
  mass = (rods_.carried + kRods * rods_.mass / 3) * (J_.transpose() * J_);
  for (int i = 0; i < kRods; ++i) {
    mass(i, i) += links_[std::size_t(i)].mass + rods_.mass / 3;
    const Vec3 coupled = rods_.mass / 6 * (J_.transpose() * direction(i));
    mass.row(i) += coupled.transpose();
    mass.col(i) += coupled;
  }
}

}  // namespace

std::unique_ptr<AxisMechanics> make_rod_mechanics(const machine::MachineDescription& machine,
                                                  const AsBuilt& as_built,
                                                  const QuasistaticOptions& options) {
  return std::make_unique<RodMechanics>(machine, as_built, options);
}

}  // namespace understudy::sim
