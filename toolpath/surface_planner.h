// Prints a curve on any surface with the tool along the local normal (Song 2015, 3.2 and 6.2).
#pragma once

#include <vector>

#include "geometry/mesh.h"
#include "toolpath/program.h"

namespace understudy::toolpath {

struct SurfacePlan {
  double gap = 0;               ///< [m], tip above the surface along the normal
  double standoff = 0;          ///< [m], S' out along the normal from S
  double clearance = 0;         ///< [m], where travel ends before S' and after E, along the normal
  double step = 0;              ///< [m], largest distance of points along the curve
  double chord_tolerance = 0;   ///< [m], largest deviation of the chords from the surface
  double feed = 0;              ///< [m/s]
  double approach_feed = 0;     ///< [m/s], from S' to S
  double bead_width = 0;        ///< [m]
  double bead_height = 0;       ///< [m]
  double filament_diameter = 0; ///< [m]
  double temperature = 0;       ///< [K]
  double fan = 0;               ///< 0..1
  double tilt_max = 0;          ///< [rad], largest tilt from vertical that the machine allows
};

/// `curve` is a polyline near the surface; each point is projected to the nearest surface point, refined by
/// step and chord, and given the shortest-arc orientation that puts the tool on the surface's normal.
/// Order of steps: temperature, fan, travel above, S' (travel), S (move: the approach), print moves, retreat.
/// Throws InputError when the curve leaves the mesh by more than 5 mm, doubles back over a sharp edge
/// (normals of neighbours more than 20 degrees apart), or tilts the tool beyond tilt_max.
Program plan_surface(const geometry::Mesh& mesh, const std::vector<Vec3>& curve, const SurfacePlan& plan);

/// The intersection of the mesh with a plane through `point` with unit `normal`: the longest connected
/// polyline on the side that faces `up` (unit).
std::vector<Vec3> section_curve(const geometry::Mesh& mesh, const Vec3& point, const Vec3& normal, const Vec3& up);

}  // namespace understudy::toolpath
