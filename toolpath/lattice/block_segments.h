// Ishak 2018, region based segmentation: a part as a base and what protrudes from its four sides, in cubes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

/// In the order in which they are printed.
enum class BuildDirection : unsigned char { z_up, y_minus, y_plus, x_minus, x_plus };

Vec3 axis_of(BuildDirection direction);         ///< unit
const char* name_of(BuildDirection direction);  ///< "Z+", "Y-"

struct Segment {
  BuildDirection direction = BuildDirection::z_up;
  std::vector<std::array<int, 3>> cubes;  ///< steps of `strut` from the origin to the lowest corner
};

struct SegmentedPart {
  double strut = 0;               ///< [m], side of a cube
  Vec3 origin{0, 0, 0};           ///< [m]
  std::vector<Segment> segments;  ///< in printing order; the base first
  double share = 0;               ///< of the part's volume that the cubes take
};

/// The cubes within the part, on a grid that stands on the ground and is centred on the face that the part
/// stands on. The base are the columns without overhang, printed upwards. What lies beyond its limits in x
/// protrudes along x, what else lies beyond its limits in y protrudes along y, and each is printed away from
/// the base. A segment along y is therefore no wider than the base, and stands on it; one along x stands on
/// the base and on the segments along y. Throws InputError naming the place for a part that is open, that
/// stands on no face, without room for a cube, whose base has two pieces, with an overhang within the base's
/// limits, with two protrusions on one side, with one that hangs beyond what it stands on, or that reaches
/// farther than its cubes by a cube's side.
SegmentedPart segment_part(const geometry::Mesh& part, double strut);

}  // namespace understudy::toolpath
