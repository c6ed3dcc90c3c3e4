// Parallel lines that fill a flat section, to and fro.
#pragma once

#include <vector>

#include "toolpath/planners/contour_offset.h"

namespace understudy::toolpath {

/// Smallest rectangle around a contour: its middle, the unit direction of its longer side, and its sides [m].
struct BoundingRectangle {
  Vec2 centre{0, 0}, along{1, 0};
  double length = 0, width = 0;
};

/// That of `along` as given, unless another is smaller by more than 2 %: so that the rectangles of layers
/// that hardly differ do not turn.
BoundingRectangle bounding_rectangle(const Contour& contour, const Vec2& along);

/// Lines across the longer side, no farther apart than `pitch` [m], between the borders of the region; each
/// goes on to its neighbour where they face each other, so that a region without waists is one path. The
/// first begins at the end of the region nearest to `from`. `spacing` [m] of lines goes out. Source: Han
/// 2024, 3.2.2.
std::vector<FlatPath> zigzag(const std::vector<Contour>& region, const Vec2& along, double pitch,
                             const Vec2& from, double& spacing);

}  // namespace understudy::toolpath
