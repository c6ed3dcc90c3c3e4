// Pictures of spots from closed forms, so that the truth does not come from a renderer.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/image.h"
#include "core/random.h"

namespace understudy::vision {

using LightField = std::vector<double>;  // grey levels, row-major

struct SyntheticSpot {
  Vec2 centre{0, 0};
  double sigma_x = 2.4, sigma_y = 2.4;  // [px]; the 1/e^2 radius is twice that
  double peak = 120;                    // grey levels
};

inline LightField flat_light(int width, int height, double level) {
  return LightField(static_cast<std::size_t>(width * height), level);
}

/// The exact integral of a Gaussian over each pixel.
inline void add_spot(LightField& light, int width, const SyntheticSpot& s) {
  const auto integral = [](double x, double c, double sigma) {
    const double k = sigma * std::numbers::sqrt2;
    return sigma * std::sqrt(std::numbers::pi / 2) *
           (std::erf((x + 0.5 - c) / k) - std::erf((x - 0.5 - c) / k));
  };
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double x = static_cast<double>(i % static_cast<std::size_t>(width));
    const double y = static_cast<double>(i / static_cast<std::size_t>(width));
    light[i] += s.peak * integral(x, s.centre.x(), s.sigma_x) * integral(y, s.centre.y(), s.sigma_y);
  }
}

/// Fully developed speckle whose field has a Gaussian correlation: |mu|^2 = exp(-r^2 / 2 a^2), correlation
/// area 2 pi a^2. Point samples on a grid of half pixels, then the mean over each pixel. Mean 1.
inline LightField speckle(int width, int height, double area_px2, Random& random) {
  const double a = 2 * std::sqrt(area_px2 / (2 * std::numbers::pi));  // half pixels
  const int reach = static_cast<int>(std::ceil(4 * a)), w = 2 * width, h = 2 * height;
  const int wide = w + 2 * reach, high = h + 2 * reach;
  std::vector<std::complex<double>> white(static_cast<std::size_t>(wide * high)), rows(white.size());
  for (auto& v : white) v = {random.normal() / std::numbers::sqrt2, random.normal() / std::numbers::sqrt2};
  std::vector<double> kernel;
  double energy = 0;
  for (int d = -reach; d <= reach; ++d) kernel.push_back(std::exp(-d * d / (2 * a * a)));
  for (const double k : kernel) energy += k * k;
  for (double& k : kernel) k /= std::sqrt(energy);
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * wide + x); };
  for (int y = 0; y < high; ++y) {
    for (int x = reach; x < wide - reach; ++x) {
      for (int d = -reach; d <= reach; ++d)
        rows[at(x, y)] += kernel[static_cast<std::size_t>(d + reach)] * white[at(x + d, y)];
    }
  }
  LightField factor(static_cast<std::size_t>(width * height), 0.0);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      std::complex<double> field = 0;
      for (int d = -reach; d <= reach; ++d) {
        field += kernel[static_cast<std::size_t>(d + reach)] * rows[at(x + reach, y + reach + d)];
      }
      factor[static_cast<std::size_t>(y / 2 * width + x / 2)] += std::norm(field) / 4;
    }
  }
  return factor;
}

struct SyntheticSensor {
  double electrons_per_grey = 10000.0 / 255;
  double read_noise = 10;  // electrons
};

inline Image expose(const LightField& light, int width, const SyntheticSensor& sensor, Random& random) {
  Image image{{0, 0, width, static_cast<int>(light.size()) / width}, {}};
  for (const double level : light) {
    const double electrons = level * sensor.electrons_per_grey;
    const double noisy =
        electrons + std::sqrt(electrons) * random.normal() + sensor.read_noise * random.normal();
    image.pixels.push_back(
        static_cast<std::uint8_t>(std::clamp(std::lround(noisy / sensor.electrons_per_grey), 0L, 255L)));
  }
  return image;
}

/// 8 bits, nothing else.
inline Image quantise(const LightField& light, int width) {
  Image image{{0, 0, width, static_cast<int>(light.size()) / width}, {}};
  for (const double level : light) {
    image.pixels.push_back(static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L)));
  }
  return image;
}

}  // namespace understudy::vision
