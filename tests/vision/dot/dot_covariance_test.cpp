#include <Eigen/LU>

#include <gtest/gtest.h>

#include "tests/vision/dot/synthetic_spot.h"
#include "vision/dot/dot.h"

namespace understudy::vision {
namespace {

constexpr int kSize = 56;
constexpr int kFrames = 500;
// Sum of 500 squared normalised errors of two components: chi-square of 1000 degrees of freedom, standard
// deviation sqrt(2000) = 45; 3.3 of them leave 0.1 % outside.
constexpr double kLow = 1000 - 3.3 * 44.7, kHigh = 1000 + 3.3 * 44.7;

struct Consistency {
  double normalised = 0;  // sum over frames of e^T C^-1 e
  double rms = 0;         // [px] per axis
  double spread = 0;      // mean square of the second moments' errors over what is told of them
};

Consistency consistency(const SyntheticSpot& shape, double area, DotOptions options) {
  options.saturated_fraction_max = 1;  // a rare grain is six times as bright as the mean
  Consistency c;
  for (int k = 0; k < kFrames; ++k) {
    Random random(static_cast<std::uint64_t>(k), "covariance");
    SyntheticSpot spot = shape;
    spot.centre = Vec2(random.uniform(26, 30), random.uniform(26, 30));
    LightField light = flat_light(kSize, kSize, 0);
    add_spot(light, kSize, spot);
    if (area > 0) {
      const LightField grains = speckle(kSize, kSize, area, random);
      for (std::size_t i = 0; i < light.size(); ++i) light[i] *= grains[i];
    }
    for (double& level : light) level += 12;
    const DotMeasurement m = measure_dot(expose(light, kSize, {}, random), options);
    EXPECT_EQ(m.status, DotStatus::ok) << "frame " << k;
    const Vec2 error = m.position_px - spot.centre;
    c.normalised += error.dot(m.covariance_px2.inverse() * error);
    c.rms += error.squaredNorm() / (2 * kFrames);
    const double pixel = 1.0 / 12;  // of its own square
    const Vec2 truth(std::pow(spot.sigma_x, 2) + pixel, std::pow(spot.sigma_y, 2) + pixel);
    const Vec2 off = m.spread_px2.diagonal().cwiseQuotient(truth) - Vec2::Ones();
    c.spread += off.squaredNorm() / std::pow(m.spread_sigma, 2) / (2 * kFrames);
  }
  c.rms = std::sqrt(c.rms);
  return c;
}

TEST(LaserDotCovariance, HoldsForShotAndReadNoise) {
  const Consistency c = consistency({.sigma_x = 2.4, .sigma_y = 3.2, .peak = 130}, 0, {});
  EXPECT_GT(c.normalised, kLow);
  EXPECT_LT(c.normalised, kHigh);
  // The level of the surroundings errs too, and is not in it.
  EXPECT_GT(c.spread, 0.75);
  EXPECT_LT(c.spread, 1.5);
}

TEST(LaserDotCovariance, HoldsUnderSpeckleOfKnownGrain) {
  constexpr double kArea = 1.5;  // [px^2]
  const Consistency c =
      consistency({.sigma_x = 2.4, .sigma_y = 2.4, .peak = 40}, kArea, {.speckle_area_px2 = kArea});
  EXPECT_GT(c.normalised, kLow);
  EXPECT_LT(c.normalised, kHigh);
  // Closed form for a round spot: sigma^2 = A / (8 pi); RMS of 1000 numbers is good to 2.3 %, thrice that.
  EXPECT_NEAR(c.rms, std::sqrt(kArea / (8 * std::numbers::pi)),
              0.08 * std::sqrt(kArea / (8 * std::numbers::pi)));
  EXPECT_NEAR(c.spread, 1, 0.25);
}

TEST(LaserDotCovariance, ReadsTheGrainFromThePictureWhenNobodyTellsIt) {
  // Few grains tell their own size badly, and an inverse of a scattered variance averages high: up to
  // twice the ideal is accepted, and no less than three quarters.
  for (const double area : {0.4, 1.5}) {
    const Consistency c = consistency({.sigma_x = 2.4, .sigma_y = 2.4, .peak = 40}, area, {});
    EXPECT_GT(c.normalised, 750) << "area " << area;
    EXPECT_LT(c.normalised, 2000) << "area " << area;
  }
}

TEST(SpeckleArea, IsThatOfARoundAperture) {
  // lambda^2 / (pi sin^2 u) = 0.65^2 / (pi 0.05^2) = 53.8 um^2, times (0.064 px/um)^2
  EXPECT_NEAR(speckle_area_px2(650e-9, 0.05, 64e3), 0.2203, 1e-4);
}

}  // namespace
}  // namespace understudy::vision
