// The nominal hexapod of the tests (docs/reference.md#machine-g4), by hand: a plant's figures must not move
// when somebody tunes the shipped model.
#pragma once

#include <cmath>

#include "core/units.h"
#include "machine/description.h"

namespace understudy::sim {

inline machine::MachineDescription machine_g4() {
  machine::MachineDescription m;
  m.name = "G4";
  m.mechanism = "hexapod";
  m.X_WB = make_pose(Quat::Identity(), Vec3(0, 0, from_mm(256)));
  m.X_BT_home = make_pose(Quat::Identity(), Vec3(0, 0, -from_mm(206)));
  for (int i = 0; i < kinematics::kStruts; ++i) {
    const auto s = static_cast<std::size_t>(i);
    const int pair = i / 2;
    const double side = i % 2 == 0 ? -1 : 1;
    const double base = from_deg(120.0 * pair + side * 43), platform = from_deg(120.0 * pair + side * 17);
    m.hexapod().geometry.base_joint[s] = from_mm(80) * Vec3(std::cos(base), std::sin(base), 0);
    m.hexapod().geometry.platform_joint[s] = from_mm(29) * Vec3(std::cos(platform), std::sin(platform), 0);
    m.hexapod().geometry.platform_joint[s].z() = from_mm(25);
    m.hexapod().geometry.length_offset[s] = from_mm(170);
  }
  m.hexapod().geometry.deviation = from_mm(15);
  m.hexapod().joints = kinematics::joints_at_home(m.hexapod().geometry, m.X_BT_home);
  m.hexapod().limits.strut_min = from_mm(170);
  m.hexapod().limits.strut_max = from_mm(240);
  for (machine::Drive& drive : m.drives) drive.velocity_max = 0.2;
  m.hexapod().play.screw_nut = 50e-6;
  m.hexapod().play.ball_joint = 25e-6;
  m.hexapod().masses.platform = 1.0;
  m.hexapod().masses.nut = 0.02;
  m.hexapod().masses.motor = 0.3;
  m.hexapod().masses.platform_centre_T = Vec3(0, 0, from_mm(35));
  m.hexapod().masses.platform_inertia = Vec3(6e-4, 6e-4, 8e-4);
  m.tolerances.manufactured = {from_mm(0.5), from_mm(0.5)};
  m.tolerances.after_calibration = {from_mm(0.1), from_mm(0.1)};
  return m;
}

}  // namespace understudy::sim
