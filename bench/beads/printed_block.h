// Beads of a solid block as a slicer fills it: layers of zigzag lines, turned by a right angle each layer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/frames.h"
#include "sim/beads/bead.h"

namespace understudy::sim {

constexpr double kLineWidth = 0.4e-3, kLayerHeight = 0.2e-3;  // [m]

struct PrintedBlock {
  std::vector<Bead> beads;
  double side = 0;               ///< [m], of its square base, centred on the origin
  double height = 0;             ///< [m], of its finished layers
  Pose X_WS = Pose::Identity();  ///< of the block, whose layers lie along its own z = 0
};

/// A block three times as wide as high. Pieces of 0.5 to 1 mm, as curves are cut; layers tilted by `tilt`
/// [rad].
PrintedBlock printed_block(std::size_t beads, double tilt, std::uint64_t seed);

}  // namespace understudy::sim
