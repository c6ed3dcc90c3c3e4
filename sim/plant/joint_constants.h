// What every plant assumes about joints where the description is silent, so that engines differ in their
// mathematics only. Private to this room.
#pragma once

#include <cmath>

#include "machine/description.h"

namespace understudy::sim {

/// Joint clearances are greasy: damping of a play that slides (docs/reference.md#play). A play that turns has
/// it at the chain's length scale.
constexpr double kPlayDamping = 2.0;  // [N s/m]
/// Of the universal joints, small compared with gravity: 1 rad/s costs a strut 0.5 mN at its ball.
constexpr double kHingeDamping = 1e-4;  // [N m s/rad]
/// Share of the nut-and-rod mass that sits beyond the ball joint's play.
constexpr double kRodEndShare = 0.5;
/// Motor and rod are taken for solid cubes of this density: the description states only their masses.
constexpr double kSteelDensity = 7850;  // [kg/m^3]

/// [kg m^2], of a solid cube of `mass` about any axis through its centre.
inline double cube_moment(double mass) {
  const double side = std::cbrt(mass / kSteelDensity);
  return mass * side * side / 6;
}

/// Throws InputError for a timestep that is not positive, or too long for an elastic drive: a semi-implicit
/// step of a spring is stable below 2 radians and true well below 1.
void check_timestep(const machine::MachineDescription& machine, double timestep);

// Being at rest, and being lost.
constexpr double kSettledSpeed = 1e-6;  // [m/s] and [rad/s], of every joint
constexpr double kSettledTime = 0.02;   // [s] that it has to last
constexpr double kSettleCap = 2.0;      // [s]
/// A pose in which a strut carries next to nothing lets the platform float in that strut's play for long: at
/// the cap that is rest. Free fall through a play of 0.2 mm ends at 60 mm/s, so beyond this it is not.
constexpr double kFloatingSpeed = 0.06;  // [m/s] and [rad/s]
/// A drive this far from its command is an integration that no longer follows the machine.
constexpr double kFollowingLimit = 0.5e-3;  // [m] or [rad]
/// So is a closed joint that has come this far apart: a hard stop from full speed opens a joint by a tenth.
constexpr double kClosureLimit = 0.1e-3;  // [m]

}  // namespace understudy::sim
