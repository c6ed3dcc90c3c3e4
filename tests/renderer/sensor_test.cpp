#include "renderer/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace understudy::renderer {
namespace {

SampleGrid dark(int x, int y, int size) {
  SampleGrid grid{x, y, size, size, {}};
  grid.samples.resize(static_cast<std::size_t>(size * size));
  return grid;
}

TEST(Sensor, BlurKeepsLightAndCentreAndHasItsWidth) {
  constexpr double kBlur = 1.3;
  SampleGrid grid = dark(0, 0, 80);
  grid.at(41, 40).laser = 4000;
  const Region region{8, 8, 24, 24};
  const std::vector<float> levels = integrate(grid, region, kBlur);
  double sum = 0, x = 0, xx = 0;
  for (int k = 0; k < 24 * 24; ++k) {
    const double light = static_cast<double>(levels[static_cast<std::size_t>(k)]), column = 8 + k % 24;
    sum += light, x += light * column, xx += light * column * column;
  }
  EXPECT_NEAR(sum, 1000, 0.1);        // four samples make a pixel
  EXPECT_NEAR(x / sum, 20.25, 1e-3);  // (41 + 1/2) / 2 - 1/2
  // Of the two samples of a pixel the nearer takes it: variance 1/16 px^2.
  EXPECT_NEAR(xx / sum - x / sum * x / sum, kBlur * kBlur + 1.0 / 16, 0.01);
}

struct Statistics {
  double mean = 0, variance = 0;
};

Statistics of_level(float level, const SensorNoise& noise) {
  const Region region{0, 0, 200, 200};
  const Image image = digitise(std::vector<float>(40000, level), region, 640, &noise);
  Statistics s;
  for (const auto p : image.pixels) s.mean += p / 40000.0;
  for (const auto p : image.pixels) s.variance += (p - s.mean) * (p - s.mean) / 40000.0;
  return s;
}

TEST(Sensor, NoiseIsThatOfPhotonsAndAmplifier) {
  // 10 000 electrons at 255 levels: 39.2 electrons a level.
  const SensorNoise noise{10000, 10, 7};
  for (const float level : {20.0f, 90.0f, 180.0f}) {
    const Statistics s = of_level(level, noise);
    const double electrons_per_level = 10000 / 255.0;
    const double variance =
        static_cast<double>(level) / electrons_per_level + std::pow(10 / electrons_per_level, 2) + 1.0 / 12;
    EXPECT_NEAR(s.mean, static_cast<double>(level), 0.05);
    EXPECT_NEAR(s.variance, variance, 0.05 * variance);  // 40 000 pixels: 0.7 % 1 sigma, and rounding
  }
}

TEST(Sensor, FewPhotonsFollowPoisson) {
  // One electron a level: level 3 is a Poisson law of mean 3.
  const SensorNoise noise{255, 0, 3};
  const Image image = digitise(std::vector<float>(40000, 3.0f), {0, 0, 200, 200}, 640, &noise);
  double none = 0, five = 0;
  for (const auto p : image.pixels) none += p == 0, five += p == 5;
  EXPECT_NEAR(none / 40000, std::exp(-3), 0.004);
  EXPECT_NEAR(five / 40000, std::exp(-3) * 243 / 120, 0.006);
}

TEST(Sensor, SaturatesAndDependsOnPlaceNotOnRegion) {
  const SensorNoise noise{10000, 10, 7};
  const Image bright = digitise(std::vector<float>(100, 900.0f), {0, 0, 10, 10}, 640, &noise);
  for (const auto p : bright.pixels) EXPECT_EQ(p, 255);
  const Image whole = digitise(std::vector<float>(400, 50.0f), {10, 20, 20, 20}, 640, &noise);
  const Image part = digitise(std::vector<float>(25, 50.0f), {17, 23, 5, 5}, 640, &noise);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x) EXPECT_EQ(part.at(x, y), whole.at(x + 7, y + 3));
  }
}

}  // namespace
}  // namespace understudy::renderer
