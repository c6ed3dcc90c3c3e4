// What the rest of the code asks a description that no single key tells.
#include <algorithm>
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
  return visit(
      [&](const HexapodModel& hexapod) {
        const bool coupled = hexapod.screw_rotation == ScrewRotation::compensated;
        return kinematics::make_hexapod(hexapod.geometry, hexapod.joints, hexapod.limits, X_BT_home,
                                        coupled ? screw_coupling() : kinematics::ScrewCoupling{});
      },
      [](const ChainModel& chain) { return kinematics::make_chain_mechanism(chain.kinematics); });
}

kinematics::ScrewCoupling MachineDescription::screw_coupling() const {
  const double lead = hexapod().screw_rotation == ScrewRotation::guided ? 0 : drives[0].lead;
  return kinematics::screw_coupling(hexapod().geometry, hexapod().joints, X_BT_home, lead);
}

kinematics::AxisVector MachineDescription::drive_zero() const {
  kinematics::AxisVector zero{};
  visit([&](const HexapodModel& hexapod) { std::ranges::copy(hexapod.geometry.length_offset, zero.begin()); },
        [](const ChainModel&) {});
  return zero;
}

bool MachineDescription::has_play(int axis) const {
  return visit(
      [](const HexapodModel& hexapod) { return hexapod.play.screw_nut > 0 || hexapod.play.ball_joint > 0; },
      [axis](const ChainModel& chain) { return chain.play[axis] > 0; });
}

double MachineDescription::tip_play() const {
  return visit(
      // A strut's play is one nut and two ball joints; struts stand within 45 degrees of any way that is
      // used.
      [](const HexapodModel& hexapod) {
        return std::numbers::sqrt2 * (hexapod.play.screw_nut + 2 * hexapod.play.ball_joint);
      },
      [](const ChainModel& chain) {
        kinematics::ChainJacobian J;
        kinematics::forward(chain.kinematics.chain, chain.kinematics.home, J);
        double shift = 0;
        for (int i = 0; i < J.cols(); ++i) shift += J.col(i).head<3>().norm() * chain.play[i];
        return shift;
      });
}

}  // namespace understudy::machine
