// Ishak 2018: the cubic lattice of a segmented part, and the order in which its struts are printed.
#pragma once

#include "toolpath/lattice/block_segments.h"
#include "toolpath/lattice/disassembly.h"
#include "toolpath/lattice/lattice.h"

namespace understudy::toolpath {

/// Struts of one segment in their order: each begins where something stands.
struct SegmentOrder {
  BuildDirection direction = BuildDirection::z_up;  ///< seen from the part
  Vec3 axis{0, 0, 1};                               ///< unit, the same in the frame of the lattice
  std::vector<Removal> struts;
};

struct SegmentLattice {
  Lattice lattice;
  std::vector<SegmentOrder> segments;  ///< in printing order
};

/// Nodes at the corners of the cubes, struts along their edges; what two segments share belongs to the first.
/// Segment by segment and layer by layer along the build direction: the struts that rise from a layer, then
/// the grid that they carry; the base begins with its grid on the ground. Within a layer each strut begins
/// where the last one ended, if possible, else at the nearest node that has one left.
SegmentLattice segment_lattice(const SegmentedPart& part);

/// Turns everything by `angle` [rad] about z.
void turn(SegmentLattice& segments, double angle);

}  // namespace understudy::toolpath
