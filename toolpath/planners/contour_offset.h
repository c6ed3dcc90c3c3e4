// Tool paths along the outline of a flat section: polygon offsets by Clipper, on a grid of 1 nm.
#pragma once

#include <functional>
#include <vector>

#include "core/frames.h"

namespace understudy::toolpath {

/// Closed polygon without a repeated point; the material is on its left: outlines run counter-clockwise,
/// holes clockwise. [m]
using Contour = std::vector<Vec2>;

/// Without points that lie within `tolerance` [m] of the line of their neighbours, or on each other.
Contour simplified(const Contour& contour, double tolerance);

/// A path inside the section; closed ones end where they begin.
using FlatPath = std::vector<Vec2>;

/// The outline of the section, shrunk by `offset` [m] into the material with mitred corners, where `wanted`
/// holds, found to 1 um. Where the section is narrower than two offsets nothing is left. Pieces shorter than
/// `shortest` [m] are left out. A loop begins by the first point of the nearest contour, so that the loops of
/// one outline begin side by side; coordinates round to 1 nm.
std::vector<FlatPath> inset_paths(const std::vector<Contour>& contours, double offset, double shortest,
                                  const std::function<bool(const Vec2&)>& wanted);

}  // namespace understudy::toolpath
