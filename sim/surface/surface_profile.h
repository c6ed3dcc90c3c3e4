// A stylus' trace of the surface as printed, by rays.
#pragma once

#include <cstddef>
#include <vector>

#include "core/frames.h"
#include "geometry/mesh.h"
#include "sim/deposition/workpiece.h"

namespace understudy::sim {

struct ProfileLine {
  Vec3 from_W{0, 0, 0}, to_W{0, 0, 0};  ///< [m], on or near the surface
  Vec3 probe_W{0, 0, -1};               ///< into the part; any length
  double pitch = 5e-6;                  ///< [m], between rays
  double reach = 2e-3;                  ///< [m], rays begin and end so far before and behind the line
  /// [m], of the stylus (ISO 3274: 2, 5 or 10 um): three points of its ball touch, the foremost and one half
  /// a radius to either side, so that it does not fall into slits between touching beads. 0: a single ray.
  double tip_radius = 2e-6;
};

struct SurfaceProfile {
  double pitch = 0;             ///< [m], along the surface
  std::vector<double> heights;  ///< [m], across the surface, outward positive, form removed
  double tilt = 0;              ///< [rad], of the probe from the surface's normal, the largest met
  std::size_t on_beads = 0, on_insert = 0, on_table = 0;  ///< points
};

/// Minus the normal of the intended surface nearest to the line's middle, turned square to the line. Throws
/// InputError where the line stands upright on the surface.
Vec3 probe_into(const geometry::Mesh& intended, const Vec3& from_W, const Vec3& to_W);

/// What rays along the probe meet first of beads, insert and table. Form is the intended surface (met by the
/// same rays; `intended` in W) or, where that is null, the least-squares straight line. Throws InputError: a
/// line, pitch or reach that makes no sense, more than a million points, a ray that meets nothing, a line
/// that meets no bead, a probe more than 30 degrees off the surface's normal.
SurfaceProfile measure_profile(const Workpiece& workpiece, const geometry::Mesh* intended,
                               const ProfileLine& line);

}  // namespace understudy::sim
