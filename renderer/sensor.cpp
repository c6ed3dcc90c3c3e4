#include "renderer/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.h"

namespace understudy::renderer {
namespace {

/// Weights of the samples 2 x - reach ... 2 x + 1 + reach of pixel x: a Gaussian integrated over the pixel.
std::vector<float> pixel_kernel(double blur_px) {
  const int reach = kSamplesPerPixel * blur_margin(blur_px);
  std::vector<double> weights(static_cast<std::size_t>(kSamplesPerPixel + 2 * reach), 0.0);
  double sum = 0;
  for (int inside = 0; inside < kSamplesPerPixel; ++inside) {
    for (int d = -reach; d <= reach; ++d) {
      const double s = d / (kSamplesPerPixel * std::max(blur_px, 1e-9));
      const double w = std::exp(-0.5 * s * s);
      weights[static_cast<std::size_t>(inside + d + reach)] += w;
      sum += w;
    }
  }
  std::vector<float> kernel;
  for (const double w : weights) kernel.push_back(static_cast<float>(w / sum));
  return kernel;
}

double unit_interval(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1.0p-53; }

double normal(double u, double v) { return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v); }

/// Electrons of a Poisson law; from some forty on, a rounded Gaussian cannot be distinguished from it at 8
/// bits.
double photo_electrons(double mean, std::uint64_t key, std::uint64_t counter) {
  const double u = unit_interval(hash_bits(key, counter));
  if (mean > 40) {
    const double v = unit_interval(hash_bits(key, counter + 1));
    return std::max(0.0, std::round(mean + std::sqrt(mean) * normal(u, v)));
  }
  double probability = std::exp(-mean), below = probability;
  int count = 0;
  while (below < u && count < 400) {
    ++count;
    probability *= mean / count;
    below += probability;
  }
  return count;
}

}  // namespace

int blur_margin(double blur_px) { return static_cast<int>(std::ceil(4 * blur_px)); }

std::vector<float> integrate(const SampleGrid& grid, const Region& region, double blur_px) {
  const std::vector<float> kernel = pixel_kernel(blur_px);
  const int taps = static_cast<int>(kernel.size());
  const int reach = kSamplesPerPixel * blur_margin(blur_px);
  const auto width = static_cast<std::size_t>(region.width);
  const int first_row = kSamplesPerPixel * region.y - reach;
  const int rows = kSamplesPerPixel * region.height + 2 * reach;

  std::vector<float> across(static_cast<std::size_t>(rows) * width, 0.0f);
  // Of a row, the samples that lie at the same place in their pixels, side by side.
  std::array<std::vector<float>, kSamplesPerPixel> light;
  for (auto& lane : light) lane.resize(static_cast<std::size_t>(grid.width / kSamplesPerPixel + 1));
  for (int row = 0; row < rows; ++row) {
    const Sample* samples = &grid.at(grid.x, first_row + row);
    for (int i = 0; i < grid.width; ++i)
      light[static_cast<std::size_t>(i % kSamplesPerPixel)][static_cast<std::size_t>(i / kSamplesPerPixel)] =
          samples[i].laser + samples[i].ambient;
    float* out = &across[static_cast<std::size_t>(row) * width];
    for (int t = 0; t < taps; ++t) {
      const float w = kernel[static_cast<std::size_t>(t)];
      const int first = kSamplesPerPixel * region.x - reach - grid.x + t;
      const float* from =
          light[static_cast<std::size_t>(first % kSamplesPerPixel)].data() + first / kSamplesPerPixel;
      for (std::size_t x = 0; x < width; ++x) out[x] += w * from[x];
    }
  }
  std::vector<float> levels(static_cast<std::size_t>(region.height) * width, 0.0f);
  for (int y = 0; y < region.height; ++y) {
    float* out = &levels[static_cast<std::size_t>(y) * width];
    for (int t = 0; t < taps; ++t) {
      const float w = kernel[static_cast<std::size_t>(t)];
      const float* in = &across[static_cast<std::size_t>(kSamplesPerPixel * y + t) * width];
      for (std::size_t x = 0; x < width; ++x) out[x] += w * in[x];
    }
  }
  return levels;
}

Image digitise(const std::vector<float>& levels, const Region& region, int sensor_width,
               const SensorNoise* noise) {
  Image image{region, std::vector<std::uint8_t>(levels.size())};
  std::size_t k = 0;
  for (int y = region.y; y < region.y + region.height; ++y) {
    for (int x = region.x; x < region.x + region.width; ++x, ++k) {
      double level = levels[k];
      if (noise && noise->full_well > 0) {
        const double electrons_per_level = noise->full_well / 255;
        const std::uint64_t counter =
            4 * (static_cast<std::uint64_t>(y) * static_cast<std::uint64_t>(sensor_width) +
                 static_cast<std::uint64_t>(x));
        double electrons = photo_electrons(std::max(0.0, level * electrons_per_level), noise->key, counter);
        electrons += noise->read_noise * normal(unit_interval(hash_bits(noise->key, counter + 2)),
                                                unit_interval(hash_bits(noise->key, counter + 3)));
        level = electrons / electrons_per_level;
      }
      image.pixels[k] = static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
    }
  }
  return image;
}

}  // namespace understudy::renderer
