// What the rest of the code asks a description that no single key tells.
#include <cmath>
#include <numbers>

#include "machine/description.h"

namespace understudy::machine {

double Drive::rotor() const {
  if (!(stiffness > 0)) return 0;
  const double omega = 2 * std::numbers::pi * resonance;
  return stiffness / (omega * omega);
}

std::unique_ptr<kinematics::Mechanism> MachineDescription::make_mechanism() const {
  if (chain) return kinematics::make_chain_mechanism(chain->kinematics);
  const bool coupled = hexapod.screw_rotation == ScrewRotation::compensated;
  return kinematics::make_hexapod(hexapod.geometry, hexapod.joints, hexapod.limits, X_BT_home,
                                  coupled ? screw_coupling() : kinematics::ScrewCoupling{});
}

kinematics::ScrewCoupling MachineDescription::screw_coupling() const {
  const double lead = hexapod.screw_rotation == ScrewRotation::guided ? 0 : drives[0].lead;
  return kinematics::screw_coupling(hexapod.geometry, hexapod.joints, X_BT_home, lead);
}

std::array<double, kinematics::kMaxAxes> MachineDescription::drive_zero() const {
  std::array<double, kinematics::kMaxAxes> zero{};
  if (!chain)
    for (std::size_t i = 0; i < kinematics::kStruts; ++i) zero[i] = hexapod.geometry.length_offset[i];
  return zero;
}

double MachineDescription::tip_play() const {
  // A strut's play is one nut and two ball joints; struts stand within 45 degrees of any way that is used.
  if (!chain) return std::numbers::sqrt2 * (hexapod.play.screw_nut + 2 * hexapod.play.ball_joint);
  kinematics::ChainJacobian J;
  kinematics::forward(chain->kinematics.chain, chain->kinematics.home, J);
  double shift = 0;
  for (int i = 0; i < J.cols(); ++i)
    shift += J.col(i).head<3>().norm() * chain->play[static_cast<std::size_t>(i)];
  return shift;
}

}  // namespace understudy::machine
