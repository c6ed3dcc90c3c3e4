// Tool paths beside the outline of a flat section.
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

/// Even-odd rule over all contours.
bool inside(const std::vector<Contour>& contours, const Vec2& p);
double distance_to(const std::vector<Contour>& contours, const Vec2& p);

/// A path inside the section; closed ones end where they begin.
using FlatPath = std::vector<Vec2>;

/// The parts of the contours, moved by `offset` [m] into the material with mitred corners, that are inside
/// and no nearer than the offset to any contour, and where `wanted` holds, found to 1 um. Where the section
/// is narrower than two offsets nothing is left. Pieces shorter than `shortest` [m] are left out.
std::vector<FlatPath> inset_paths(const std::vector<Contour>& contours, double offset, double shortest,
                                  const std::function<bool(const Vec2&)>& wanted);

}  // namespace understudy::toolpath
