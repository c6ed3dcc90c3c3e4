#include "renderer/speckle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace understudy::renderer {
namespace {

constexpr double kFocal = 2112, kDistance = 33e-3;
constexpr double kSampleSize = kDistance / kFocal / kSamplesPerPixel;  // [m] on the surface

SpeckleOptics optics(double aperture_sine, const Vec3& camera = Vec3::Zero(), std::uint64_t seed = 42) {
  return {650e-9,           aperture_sine, kFocal, kDistance, make_pose(Quat::Identity(), camera),
          Pose::Identity(), seed};
}

/// An evenly lit wall before the camera; the even border that lacks scatterers is cut off.
SampleGrid speckled_wall(const SpeckleOptics& o, int size) {
  const int margin = kSamplesPerPixel * speckle_margin(o);
  const int whole = size + 2 * margin;
  SampleGrid grid{100 - margin, 60 - margin, whole, whole, {}};
  grid.samples.assign(static_cast<std::size_t>(whole * whole),
                      {1.0f, 0.0f, static_cast<float>(kDistance), 1.0f});
  const Lens lens({.width = 640, .height = 480, .focal_px = kFocal, .centre_px = {319.5, 239.5}}, 200);
  apply_speckle(grid, lens, o);
  SampleGrid inside{100, 60, size, size, {}};
  for (int j = 60; j < 60 + size; ++j) {
    for (int i = 100; i < 100 + size; ++i) inside.samples.push_back(grid.at(i, j));
  }
  return inside;
}

TEST(Speckle, IsFullyDeveloped) {
  // Samples of 7.8 um under grains of 26 um: the intensity's law is exponential. 240^2 samples hold some 4000
  // grains, so means are good to 2 %; thrice that.
  const SampleGrid wall = speckled_wall(optics(0.012), 240);
  double mean = 0, square = 0, above_two = 0;
  for (const Sample& s : wall.samples) {
    const double i = static_cast<double>(s.laser);
    mean += i, square += i * i, above_two += i > 2;
  }
  const double n = static_cast<double>(wall.samples.size());
  mean /= n;
  EXPECT_NEAR(mean, 1, 0.06);
  EXPECT_NEAR(square / n, 2 * mean * mean, 0.15);          // contrast 1
  EXPECT_NEAR(above_two / n, std::exp(-2 / mean), 0.015);  // exponential tail
}

/// Sum of the autocovariance over all lags [m^2].
double correlation_area(const SampleGrid& wall, int reach) {
  double sum = 0;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      double products = 0;
      int count = 0;
      for (int j = wall.y + reach; j < wall.y + wall.height - reach; ++j) {
        for (int i = wall.x + reach; i < wall.x + wall.width - reach; ++i, ++count) {
          products += (static_cast<double>(wall.at(i, j).laser) - 1) *
                      (static_cast<double>(wall.at(i + dx, j + dy).laser) - 1);
        }
      }
      sum += products / count;
    }
  }
  return sum * kSampleSize * kSampleSize;
}

TEST(Speckle, GrainHasTheCorrelationAreaOfTheAperture) {
  // lambda^2 / (pi sin^2 u), however finely or coarsely it is sampled: grains of 3 and of 0.8 samples.
  for (const double sine : {0.012, 0.05}) {
    constexpr int kWalls = 8;
    const int reach = static_cast<int>(std::ceil(1.3 * 650e-9 / sine / kSampleSize));
    double area = 0;
    for (std::uint64_t seed = 0; seed < kWalls; ++seed) {
      area += correlation_area(speckled_wall(optics(sine, Vec3::Zero(), seed), 200), reach) / kWalls;
    }
    const double expected = std::pow(650e-9 / sine, 2) / std::numbers::pi;
    // One wall scatters by 10 %, eight by 3.5 %; three of that.
    EXPECT_NEAR(area / expected, 1, 0.105) << "sin u " << sine;
  }
}

double correlation(const SampleGrid& a, const SampleGrid& b, int dx, int dy) {
  double ab = 0, aa = 0, bb = 0;
  for (int j = 80; j < 160; ++j) {
    for (int i = 120; i < 200; ++i) {
      const double p = static_cast<double>(a.at(i, j).laser) - 1,
                   q = static_cast<double>(b.at(i + dx, j + dy).laser) - 1;
      ab += p * q, aa += p * p, bb += q * q;
    }
  }
  return ab / std::sqrt(aa * bb);
}

TEST(Speckle, IsFrozenToTheSurface) {
  const SampleGrid before = speckled_wall(optics(0.015), 160);
  // The camera steps to the right: the picture of the wall moves to the left.
  const SampleGrid whole = speckled_wall(optics(0.015, Vec3(6 * kSampleSize, 0, 0)), 160);
  EXPECT_GT(correlation(before, whole, -6, 0), 0.95);
  EXPECT_LT(correlation(before, whole, 0, 0), 0.3);
  // Steps that are no multiple of anything move it too, not make it anew. Half a sample between the two
  // pictures leaves 1 - v^2/4 = 0.92 of the correlation, v = 2 pi sin(u) 3.9 um / lambda; placing the
  // scatterers by samples takes some more.
  const SampleGrid odd = speckled_wall(optics(0.015, Vec3(2.4 * kSampleSize, -1.3 * kSampleSize, 0)), 160);
  EXPECT_GT(correlation(before, odd, -2, 1), 0.65);
  // Another surface, another pattern.
  SpeckleOptics other = optics(0.015);
  other.seed = 43;
  EXPECT_LT(std::abs(correlation(before, speckled_wall(other, 160), 0, 0)), 0.2);
}

/// A wall that leans by 45 degrees towards the camera, lit in a disc of `radius` samples.
SampleGrid leaning_wall(double radius) {
  constexpr int kSize = 160, kMiddle = kSize / 2;
  SampleGrid grid{100, 60, kSize, kSize, {}};
  for (int j = 0; j < kSize; ++j) {
    for (int i = 0; i < kSize; ++i) {
      const bool is_lit = std::hypot(i - kMiddle, j - kMiddle) <= radius;
      const double depth = kDistance + kSampleSize * (i - kMiddle);
      grid.samples.push_back({is_lit ? 1.0f : 0.0f, 0.0f, static_cast<float>(depth), 1.0f});
    }
  }
  return grid;
}

TEST(Speckle, OfASpotIsThatOfTheSameWallLitAllOver) {
  const Lens lens({.width = 640, .height = 480, .focal_px = kFocal, .centre_px = {319.5, 239.5}}, 200);
  for (const double sine : {0.012, 0.05}) {
    SampleGrid all = leaning_wall(1000), spot = leaning_wall(12);
    apply_speckle(all, lens, optics(sine));
    apply_speckle(spot, lens, optics(sine));
    int lit = 0, differ = 0;
    for (std::size_t k = 0; k < spot.samples.size(); ++k) {
      if (spot.samples[k].laser == 0) continue;
      ++lit;
      differ += spot.samples[k].laser != all.samples[k].laser;
    }
    EXPECT_GT(lit, 400) << "sin u " << sine;
    EXPECT_EQ(differ, 0) << "sin u " << sine;
  }
}

}  // namespace
}  // namespace understudy::renderer
