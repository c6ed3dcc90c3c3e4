// Chains of one or two axes by hand, whose statics and swings are closed forms.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/units.h"
#include "machine/description.h"
#include "sim/plant/plant.h"

namespace understudy::sim {

struct SmallAxis {
  bool angle = true;
  Vec3 direction = Vec3::UnitY();
  Vec3 point = Vec3::Zero();   ///< [m]
  double mass = 1;             ///< [kg]
  Vec3 centre = Vec3::Zero();  ///< [m]
  double inertia = 1e-3;       ///< [kg m^2], about the centre, the same about all axes
  double home = 0;             ///< [m] or [rad]
  double play = 0;             ///< [m] or [rad]
  double friction = 0;         ///< [N] or [N m]
};

/// Each axis carries the next; the tip is at `tip` with all axes at 0.
inline machine::MachineDescription small_chain(const std::vector<SmallAxis>& axes, const Vec3& tip) {
  machine::MachineDescription m;
  m.name = "small";
  m.mechanism = "chain";
  machine::ChainModel& model = m.model.emplace<machine::ChainModel>();
  model.kinematics.kind = "chain";
  model.kinematics.length_scale = 0.1;
  kinematics::Chain& chain = model.kinematics.chain;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const SmallAxis& a = axes[i];
    kinematics::ChainAxis axis;
    axis.name = "q" + std::to_string(i + 1);
    axis.angle = a.angle;
    axis.direction = a.direction;
    axis.point = a.point;
    axis.parent = static_cast<int>(i) - 1;
    chain.axes.push_back(axis);
    model.kinematics.home[i] = a.home;
    model.links.push_back({a.mass, a.centre, a.inertia * Mat3::Identity(), {}});
    model.play[i] = a.play;
    model.friction[i] = a.friction;
    m.drives[i].lead = a.angle ? from_deg(3.6) : from_mm(5);
    m.drives[i].steps_per_turn = 200;
    m.drives[i].microsteps = 16;
    m.drives[i].velocity_max = 1;
    m.drives[i].acceleration_max = 10;
  }
  chain.tool_axis = chain.size() - 1;
  chain.X_OT_zero.translation() = tip;
  m.X_BT_home = kinematics::forward(chain, model.kinematics.home);
  return m;
}

/// Horizontal hinges along x at zero; a positive turn about y lowers them.
inline machine::MachineDescription two_links(double q1, double q2) {
  const SmallAxis upper{true, Vec3::UnitY(), {0, 0, 0}, 3.0, {0.12, 0, 0}, 4e-3, q1};
  const SmallAxis lower{true, Vec3::UnitY(), {0.3, 0, 0}, 1.5, {0.4, 0, 0}, 2e-3, q2};
  return small_chain({upper, lower}, {0.55, 0, 0});
}

inline DriveCommand hold(const kinematics::AxisVector& position) { return {position, {}}; }

inline kinematics::AxisVector home_of(const machine::MachineDescription& machine) {
  kinematics::AxisVector home{};
  const auto& axes = machine.chain().kinematics.home;
  std::copy(axes.begin(), axes.end(), home.begin());
  return home;
}

}  // namespace understudy::sim
