// Open chains: forward kinematics and a recursive Newton-Euler. Everything is expressed in the frame O of the
// chain, which stands still: twists, wrenches and inertias about O's origin add without being moved.
#include <array>
#include <cmath>

#include "core/cross_matrix.h"
#include "core/units.h"
#include "sim/plant/joint_constants.h"
#include "sim/plant/quasistatic/axis_mechanics.h"

namespace understudy::sim {
namespace {

using kinematics::SolveStatus;
using Vec6 = Eigen::Matrix<double, 6, 1>;

/// What an axis carries, where it is now; about O's origin.
struct LinkState {
  Vec6 screw;     ///< twist per unit of the axis: (velocity of what is at the origin, angular)
  Vec3 centre_O;  ///< [m]
  Mat3 inertia_O;
  Vec6 velocity, acceleration;  ///< spatial; weight is an acceleration of the frame
  Vec6 wrench;                  ///< (force, moment) that the axis and all it carries need
};

class ChainMechanics final : public AxisMechanics {
 public:
  ChainMechanics(const machine::MachineDescription& machine, const AsBuilt& as_built,
                 const QuasistaticOptions& options);

  int axis_count() const override { return chain_.size(); }
  std::string axis_name(int axis) const override { return "axis " + chain_.axes[axis].name; }
  double axis_zero(int axis) const override { return axis_zero_[axis]; }
  SeriesPlay built_play(int axis) const override { return play_[axis]; }
  kinematics::AxisVector home() const override;

  void start_from_home() override {}
  SolveStatus place(const AxisVector& position) override;
  Pose tool_pose() const override;
  double closure_error() const override { return 0; }  // nothing closes

  SolveStatus load(const AxisVector& velocity, const AxisVector& acceleration, AxisLoad& load) override;
  void mass_matrix(AxisMatrix& mass) const override;

 private:
  Pose carried_by(int axis, const Pose& X_zero) const { return axis < 0 ? X_zero : pose_[axis] * X_zero; }
  void move_link(int axis, double velocity, double acceleration);
  void add_nozzle_force();

  kinematics::Chain chain_;
  std::vector<machine::Link> links_;
  kinematics::AxisVector axis_zero_{}, home_{};
  PerAxis<SeriesPlay> play_;
  Pose X_WB_;
  double gravity_;
  Vec3 nozzle_force_T_;

  PerAxis<Pose> pose_;  ///< X_OL
  PerAxis<LinkState> state_;
};

ChainMechanics::ChainMechanics(const machine::MachineDescription& machine, const AsBuilt& as_built,
                               const QuasistaticOptions& options)
    : chain_(as_built.chain),
      links_(machine.chain().links),
      axis_zero_(as_built.axis_zero),
      X_WB_(machine.X_WB),
      gravity_(options.gravity ? kGravity : 0.0),
      nozzle_force_T_(options.nozzle_force_T) {
  pose_.fill(Pose::Identity());
  const auto& home = machine.chain().kinematics.home;
  for (std::size_t i = 0; i < chain_.axes.size(); ++i) {
    home_[i] = home[i];
    // Grease at the machine's length scale, as in the MuJoCo plant.
    const double scale = chain_.axes[i].angle ? machine.chain().kinematics.length_scale : 1.0;
    play_[i].damping = kPlayDamping * scale * scale;
    play_[i].friction = machine.chain().friction[i];
    if (options.play) play_[i].inner = as_built.axis_play[i];
  }
}

kinematics::AxisVector ChainMechanics::home() const {
  kinematics::AxisVector home = home_;
  for (std::size_t i = 0; i < chain_.axes.size(); ++i) home[i] += axis_zero_[i];
  return home;
}

SolveStatus ChainMechanics::place(const AxisVector& position) {
  if (!kinematics::column(position, chain_.size()).allFinite()) return SolveStatus::bad_input;
  kinematics::link_poses(chain_, std::span(position.data(), chain_.axes.size()), pose_);
  return SolveStatus::ok;
}

Pose ChainMechanics::tool_pose() const {
  return X_WB_ * carried_by(chain_.work_axis, chain_.X_OS_zero).inverse() *
         carried_by(chain_.tool_axis, chain_.X_OT_zero);
}

void ChainMechanics::move_link(int axis, double velocity, double acceleration) {
  const kinematics::ChainAxis& a = chain_.axes[axis];
  const machine::Link& link = links_[axis];
  const Pose& X = pose_[axis];
  LinkState& s = state_[axis];
  const Vec3 direction = X.linear() * a.direction;
  if (a.angle)
    s.screw << (X * a.point).cross(direction), direction;
  else
    s.screw << direction, Vec3::Zero();
  Vec6 carrier_velocity = Vec6::Zero(), carrier_acceleration = Vec6::Zero();
  carrier_acceleration(2) = gravity_;
  if (a.parent >= 0) {
    carrier_velocity = state_[a.parent].velocity;
    carrier_acceleration = state_[a.parent].acceleration;
  }
  s.velocity = carrier_velocity + velocity * s.screw;
  // The screw is carried along: its rate is the cross product of twists.
  const Vec3 v = s.velocity.head<3>(), omega = s.velocity.tail<3>();
  Vec6 carried;
  carried << omega.cross(s.screw.head<3>()) + v.cross(s.screw.tail<3>()), omega.cross(s.screw.tail<3>());
  s.acceleration = carrier_acceleration + acceleration * s.screw + velocity * carried;

  s.centre_O = X * link.centre_O;
  s.inertia_O = X.linear() * link.inertia_O * X.linear().transpose();
  const Vec3 omega_rate = s.acceleration.tail<3>();
  const Vec3 centre_acceleration =
      s.acceleration.head<3>() + omega_rate.cross(s.centre_O) + omega.cross(v + omega.cross(s.centre_O));
  const Vec3 force = link.mass * centre_acceleration;
  s.wrench << force, s.centre_O.cross(force) + s.inertia_O * omega_rate + omega.cross(s.inertia_O * omega);
}

/// On the tip; the work takes its reaction.
void ChainMechanics::add_nozzle_force() {
  const Pose X_OT = carried_by(chain_.tool_axis, chain_.X_OT_zero);
  const Vec3 force = X_OT.linear() * nozzle_force_T_;
  Vec6 wrench;
  wrench << force, X_OT.translation().cross(force);
  if (chain_.tool_axis >= 0) state_[chain_.tool_axis].wrench -= wrench;
  if (chain_.work_axis >= 0) state_[chain_.work_axis].wrench += wrench;
}

SolveStatus ChainMechanics::load(const AxisVector& velocity, const AxisVector& acceleration, AxisLoad& load) {
  for (int i = 0; i < chain_.size(); ++i) move_link(i, velocity[i], acceleration[i]);
  add_nozzle_force();
  for (int i = chain_.size() - 1; i >= 0; --i) {
    const LinkState& s = state_[i];
    load.drive[i] = s.screw.dot(s.wrench);
    load.between[i] = 0;
    const int parent = chain_.axes[i].parent;
    if (parent >= 0) state_[parent].wrench += s.wrench;
  }
  return SolveStatus::ok;
}

void ChainMechanics::mass_matrix(AxisMatrix& mass) const {
  kinematics::PerAxis<Mat6> composite;
  for (int i = 0; i < chain_.size(); ++i) {
    const LinkState& s = state_[i];
    const double m = links_[i].mass;
    const Mat3 P = cross_matrix(s.centre_O);
    composite[i] << m * Mat3::Identity(), -m * P, m * P, s.inertia_O - m * P * P;
  }
  mass.setZero(chain_.size(), chain_.size());
  for (int i = chain_.size() - 1; i >= 0; --i) {
    const int parent = chain_.axes[i].parent;
    if (parent >= 0) composite[parent] += composite[i];
    const Vec6 momentum = composite[i] * state_[i].screw;
    for (int j = i; j >= 0; j = chain_.axes[j].parent)
      mass(i, j) = mass(j, i) = momentum.dot(state_[j].screw);
  }
}

}  // namespace

std::unique_ptr<AxisMechanics> make_chain_mechanics(const machine::MachineDescription& machine,
                                                    const AsBuilt& as_built,
                                                    const QuasistaticOptions& options) {
  if (!as_built.chain.rods.empty()) return make_rod_mechanics(machine, as_built, options);
  return std::make_unique<ChainMechanics>(machine, as_built, options);
}

}  // namespace understudy::sim
