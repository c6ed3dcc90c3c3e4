// A flat drawing laid on a surface.
#pragma once

#include <vector>

#include "geometry/mesh.h"

namespace understudy::toolpath {

struct DrawingPlace {
  Vec3 point_W{0, 0, 0};  ///< [m], near the surface: above it the middle of the drawing lies
  double turn = 0;        ///< [rad], about the surface's normal there; at 0 the drawing's x is level
  double width = 0;       ///< [m], of the whole drawing; 0: as it is
};

/// Strokes [m] of a drawing, onto the mesh along the normal that it has at the place. The drawing's upper
/// side is uphill; where the surface is level, towards +y of W. On a plane lengths and angles stay; a curved
/// surface stretches them by the cosine of its lean against that normal. Throws InputError for a drawing
/// without width, a place farther than 5 mm from the mesh, and a point of a stroke that has no surface below
/// it.
std::vector<std::vector<Vec3>> drawing_on_surface(const geometry::Mesh& mesh,
                                                  const std::vector<std::vector<Vec2>>& strokes,
                                                  const DrawingPlace& place);

}  // namespace understudy::toolpath
