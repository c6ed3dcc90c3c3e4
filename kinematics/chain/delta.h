// A linear delta: three carriages on upright towers, whose rods carry the tool (rods.h). In the words of its
// firmwares, with (x, y, z) the tip and (A_i) the tower's place less the offset of the rod's joint on the
// tool:
//   h_i = z + joint height + sqrt(L_i^2 - |(x, y) - A_i|^2).
// Axes a b c are the heights h_i of the carriages' joints. The tool cannot tilt, and its spin is not the
// machine's to choose.
#pragma once

#include <array>
#include <span>

#include "kinematics/chain/chain.h"

namespace understudy::kinematics {

struct DeltaTower {
  double radius = 0;  ///< [m], of A_i from the middle
  double angle = 0;   ///< [rad], of A_i about z from x
  double rod = 0;     ///< [m], L_i
  double zero = 0;    ///< [m], of the carriage above what its axis says: the correction of its end stop
};

struct DeltaGeometry {
  std::array<DeltaTower, 3> towers;
  double joint_height = 0;  ///< [m], of the joints on the tool above the tip
  double lean_max = 0;      ///< [rad], largest angle between a rod and its tower
};

/// From the parameters of the kind "delta", in SI and their order.
DeltaGeometry delta_geometry(std::span<const double> parameters);

Chain delta_chain(const DeltaGeometry& geometry);

}  // namespace understudy::kinematics
