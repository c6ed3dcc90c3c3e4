// What was laid in each of many equal times, each as a mesh of its own: for pictures that move.
#pragma once

#include <cstddef>
#include <vector>

#include "sim/surface/bead_sweep.h"

namespace understudy::sim {

struct SliceSettings {
  std::size_t count = 200;    ///< equal times from the first section to the last
  double chord_error = 3e-6;  ///< [m], as sides_within() takes it
};

/// Closed shells as append_sweep() makes them, cut where one slice ends and the next begins.
struct BeadSlice {
  double by = 0;  ///< [s], when the last of it was laid at the latest
  BeadMesh mesh;
  std::vector<Vec3> normals;       ///< unit, outward, of each vertex
  std::vector<BeadSection> where;  ///< of each vertex, the section that it belongs to
};

/// In order of time; those in which nothing was laid are left out. InputError for no slices, or a mesh beyond
/// 2^31 - 1 vertices.
std::vector<BeadSlice> slice_beads(const std::vector<BeadStretch>& stretches,
                                   const SliceSettings& settings = {});

}  // namespace understudy::sim
