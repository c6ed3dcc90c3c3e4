// Cubic lattices that fill a part or a box.
#pragma once

#include "core/units.h"
#include "geometry/mesh.h"
#include "toolpath/lattice/lattice.h"

namespace understudy::toolpath {

/// Struts that a cubic lattice can be printed with (Ishak 2018: the nozzle's clearance) [m].
constexpr double kShortestStrut = 5 * kMillimetre;
constexpr double kLongestStrut = 11 * kMillimetre;

/// A lattice of cubes of `strut`, and how many nodes within the part had no connection to the table.
struct LatticeFill {
  Lattice lattice;
  int dropped = 0;
};

/// Nodes on the grid of cubes that lie in the closed part or on it, struts where neighbours' middle does too;
/// as many cubes as fit, centred in x and y on the part's bounding box, from its lowest point upwards; the
/// lowest nodes are grounded. Throws InputError for a strut outside 5..11 mm, an open part, or a part without
/// room for one cube's strut.
LatticeFill fill_part(const geometry::Mesh& part, double strut);
/// The same for a box that stands on z = 0, centred in x and y.
LatticeFill fill_box(const Vec3& size, double strut);

}  // namespace understudy::toolpath
