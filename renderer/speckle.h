// Laser speckle: what a rough surface adds to a coherent spot.
#pragma once

#include <cstdint>

#include "core/frames.h"
#include "renderer/lens.h"

namespace understudy::renderer {

/// The surface is covered with scatterers of random, fixed phase and amplitude. The lens passes what its
/// aperture lets through: the field in the picture is the scatterers' amplitudes convolved with the
/// amplitude point spread 2 J1(v) / v, v = 2 pi sin(u) r / wavelength, of a round aperture. Its squared
/// magnitude is fully developed speckle (exponential intensity, mean 1, correlation area
/// wavelength^2 / (pi sin^2 u)), bound to the surface and changing with the direction of view.
struct SpeckleOptics {
  double wavelength = 0;         ///< [m]
  double aperture_sine = 0;      ///< sin u on the object side
  double focal_px = 0;           ///< [px]
  double distance = 0;           ///< [m], typical depth of the surface
  Pose X_WC = Pose::Identity();  ///< scatterers of the scenery rest in W
  Pose X_TC = Pose::Identity();  ///< and those of the tool in T
  std::uint64_t seed = 0;
};

/// How far a scatterer reaches in the picture [px].
int speckle_margin(const SpeckleOptics& optics);

/// Multiplies the laser light of each sample. Samples nearer to the grid's edge than the margin are not
/// right, for want of the scatterers outside.
void apply_speckle(SampleGrid& grid, const Lens& lens, const SpeckleOptics& optics);

}  // namespace understudy::renderer
