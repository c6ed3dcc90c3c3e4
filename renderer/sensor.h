// From light to grey levels: blur of the optics, integration over the pixel, photons, electronics, 8 bits.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "renderer/lens.h"

namespace understudy::renderer {

struct SensorNoise {
  double full_well = 0;   ///< [electrons] at 255 grey levels; 0 leaves shot noise out
  double read_noise = 0;  ///< [electrons] 1 sigma
  std::uint64_t key = 0;  ///< one for each frame
};

/// How far light spreads [px].
int blur_margin(double blur_px);

/// Mean light over each pixel of `region` [grey levels]; the grid must reach blur_margin beyond it.
std::vector<float> integrate(const SampleGrid& grid, const Region& region, double blur_px);

/// Photons are Poisson, the amplifier Gaussian; clipped to 0..255. The noise of a pixel depends on the key
/// and on its place on the sensor (`sensor_width` pixels wide), not on the region that is read out.
Image digitise(const std::vector<float>& levels, const Region& region, int sensor_width,
               const SensorNoise* noise);

}  // namespace understudy::renderer
