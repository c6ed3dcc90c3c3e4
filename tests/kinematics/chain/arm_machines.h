// The arm of docs/reference.md#robot-arm with a tilted tool, and an arm whose wrist axes do not meet.
#pragma once

#include <numbers>
#include <vector>

#include "core/random.h"
#include "core/units.h"
#include "kinematics/chain/arm.h"

namespace understudy::kinematics {

/// d1 a1 a2 a3 d4 d6, then a mount of our own: 100 mm on the flange, 20 mm aside, tilted by 30 degrees.
inline std::vector<double> sv3x_parameters() {
  std::vector<double> p;
  for (const double mm : {300., 150., 260., 60., 260., 90., 20., -10., 100.}) p.push_back(from_mm(mm));
  p.push_back(from_deg(30));
  return p;
}

inline ChainDescription sv3x() {
  ChainDescription d;
  d.kind = "arm";
  d.parameters = sv3x_parameters();
  d.chain = arm_chain(arm_geometry(d.parameters));
  const double lower[] = {-170, -45, -190, -180, -135, -350}, upper[] = {170, 150, 70, 180, 135, 350};
  for (std::size_t i = 0; i < 6; ++i) {
    d.chain.axes[i].lower = from_deg(lower[i]);
    d.chain.axes[i].upper = from_deg(upper[i]);
  }
  d.home = {0, from_deg(20), from_deg(10), 0, from_deg(60), 0};
  d.condition_max = 1e6;
  return d;
}

/// Six axes of which no three meet in a point, as in collaborative arms: no closed form by a wrist centre.
inline ChainDescription offset_wrist_arm() {
  ChainDescription d;
  d.kind = "chain";
  const auto axis = [&](const Vec3& direction, const Vec3& point) {
    ChainAxis a;
    a.name = "j" + std::to_string(d.chain.axes.size() + 1);
    a.direction = direction;
    a.point = point;
    a.parent = d.chain.size() - 1;
    a.lower = -2 * std::numbers::pi;
    a.upper = 2 * std::numbers::pi;
    d.chain.axes.push_back(a);
  };
  axis({0, 0, 1}, {0, 0, 0});
  axis({0, 1, 0}, {0, 0, 0.15});
  axis({0, 1, 0}, {0.38, 0, 0.15});
  axis({0, 1, 0}, {0.72, 0, 0.15});
  axis({0, 0, -1}, {0.72, 0.12, 0.15});
  axis({0, 1, 0}, {0.72, 0.12, 0.06});
  d.chain.tool_axis = 5;
  Mat3 R;  // z back along -y
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  d.chain.X_OT_zero = make_pose(R, Vec3(0.72, 0.30, 0.06));
  d.home = {0, from_deg(-70), from_deg(100), from_deg(-120), from_deg(-90), 0};
  return d;
}

inline ArmAxes random_axes(Random& random) {
  ArmAxes q{};
  for (double& v : q) v = random.uniform(-std::numbers::pi, std::numbers::pi);
  return q;
}

inline double position_error(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm();
}

}  // namespace understudy::kinematics
