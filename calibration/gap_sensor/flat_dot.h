// Where the laser's dot appears over a flat.
#pragma once

#include "core/image.h"
#include "machine/description.h"

namespace understudy::calibration {

/// A flat below the tip, in T: z = slope . (x, y) - gap.
struct Flat {
  Vec2 slope{0, 0};
  double gap = 0;  ///< [m], along the tool axis
};

/// Where the beam meets the flat, in T; nothing where it runs along it or away from it.
std::optional<Vec3> dot_on_flat(const machine::OpticsMounting& mounting, const Flat& flat);

/// Its pixel, within the picture or beyond; `camera` but for its focal length, which is the mounting's.
std::optional<Vec2> dot_pixel(const machine::OpticsMounting& mounting, Camera camera, const Flat& flat);

/// Second moments [px^2] of the dot of a round Gaussian beam, by the lens alone: without its blur.
std::optional<Eigen::Matrix2d> dot_spread(const machine::OpticsMounting& mounting, double waist_diameter,
                                          const Camera& camera, const Flat& flat);

}  // namespace understudy::calibration
