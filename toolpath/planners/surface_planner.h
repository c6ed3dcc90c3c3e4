// Prints a curve on any surface with the tool along the local normal (Song 2015, 3.2 and 6.2).
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "geometry/mesh.h"
#include "toolpath/bead.h"
#include "toolpath/program.h"

namespace understudy::toolpath {

struct SurfacePlan {
  double gap = 0;                ///< [m], tip above the surface along the normal
  double standoff = 0;           ///< [m], S' out along the normal from S
  double clearance = 0;          ///< [m], where travel ends before S' and after E, along the normal
  double step = 0;               ///< [m], largest distance of points along the curve
  double chord_tolerance = 0;    ///< [m], largest deviation of the chords from the surface
  double feed = 0;               ///< [m/s]
  double approach_feed = 0;      ///< [m/s], from S' to S
  double bead_width = 0;         ///< [m]
  double bead_height = 0;        ///< [m]
  double filament_diameter = 0;  ///< [m]
  double temperature = 0;        ///< [K]
  double fan = 0;                ///< 0..1
  double tilt_max = 0;           ///< [rad], largest tilt from vertical that the machine allows
  bool upright = false;          ///< the tool stays vertical whatever the normal: to compare with
  /// An end mill, its face on the surface: nothing is laid, filament, heater and gap do not count, and layers
  /// are passes from the outermost inwards, bead_height apart.
  bool cuts = false;
  std::vector<std::string> curve_files = {};  ///< of the curves, in order, for errors; may be empty
  Progress progress = {};
};

/// `curve` is a polyline near the surface. Its smooth stretches are divided into equal steps, each point is
/// projected to the nearest surface point, steps are halved where the chord leaves the surface or the normal
/// swings more than 5 degrees, and each point gets the shortest-arc orientation that puts the tool on the
/// surface's normal, or stays upright. The tip runs `gap` above the surface along the normal. Filament per
/// step is the bead's area times its length (taken half a bead height above the surface) over the filament's
/// area. Order of steps: temperature and wait, fan, travel above, S' (travel), S (move: the approach), print
/// moves, retreat (travel, straight along the tool axis). Throws InputError when a value of the plan is out
/// of range, the curve has no length, leaves the mesh by more than 5 mm, crosses a sharp edge (normals of
/// neighbours more than 20 degrees apart however close they are), or tilts the tool beyond tilt_max; the
/// curve's file is then its place.
Program plan_surface(const geometry::Mesh& mesh, const std::vector<Vec3>& curve, const SurfacePlan& plan);

/// The same for several curves, each with its own approach and retreat, and for `layers` layers of them:
/// layer k = 0, 1, ... runs k bead heights farther out along the surface's normals.
Program plan_surface(const geometry::Mesh& mesh, const std::vector<std::vector<Vec3>>& curves, int layers,
                     const SurfacePlan& plan);

}  // namespace understudy::toolpath
