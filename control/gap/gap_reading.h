// From the dot's pixel to the gap: the laser's line, the local surface and the camera, inverted.
#pragma once

#include "control/gap/local_surface.h"
#include "machine/description.h"
#include "vision/dot/dot.h"

namespace understudy::control {

struct GapReading {
  double gap = 0;          ///< [m], along the tool axis, positive outside the part
  double sigma = 0;        ///< [m], from the dot's covariance
  double residual_px = 0;  ///< [px], distance of the dot from the line on which it must move
  /// Second moment of the dot over that of the whole beam, in the direction where it is smallest: 0.36 where
  /// an edge hides half of it.
  double narrowest = 1;
  double whole_sigma = 0;  ///< of the whole beam's second moment, a share of it: its waist was measured
};

/// Where the dot must appear for a gap. False when the beam misses the modelled surface or the camera.
bool predict_dot(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
                 Vec2& pixel);

/// The same for a laser and a microscope, within the picture or beyond its edge. False when the beam misses
/// the modelled surface, or the dot is behind the camera. Does not allocate.
bool dot_pixel(const machine::Laser& laser, const machine::Microscope& microscope,
               const LocalSurface& surface, double gap, Vec2& pixel);

/// Where the beam meets the surface for a gap, in T. False when it misses the modelled surface.
bool dot_place(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
               Vec3& p_T);

/// Second moments [px^2] of the dot's picture for a gap: a round Gaussian beam on the surface's tangent
/// plane, seen by the camera through its blur. False when the beam misses the modelled surface.
bool predict_spread(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
                    Eigen::Matrix2d& spread_px2);

/// Inverts predict_dot by Newton; false when there is no gap in [-1 mm, 8 mm] that explains the dot.
bool read_gap(const machine::MachineDescription& machine, const LocalSurface& surface,
              const vision::DotMeasurement& dot, GapReading& reading);

/// Whether the dot is as wide as the whole beam draws it: noise may narrow it, an edge that hides a tenth of
/// it does so by more.
bool whole(const GapReading& reading, const vision::DotMeasurement& dot);

/// Part of the sensor in which the dot of gaps in [gap - below, gap + above] lies, with margin; clipped.
Region region_for_gap(const machine::MachineDescription& machine, const LocalSurface& surface, double gap,
                      double below, double above, int margin_px);

}  // namespace understudy::control
