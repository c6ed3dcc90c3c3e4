#include "machine/cure.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::machine {
namespace {

/// 5 mW through 0.5 mm into resin of 0.1 mm and 10 mJ/cm2.
Cure resin() { return {0.5e-3, 5e-3, 0.1e-3, 100}; }

/// [m/s], at which the middle of a line gets `times` the critical exposure.
double speed_for(double times) { return 4 * 5e-3 / (std::numbers::pi * 0.5e-3 * 100 * times); }

// Jacobs 1992: Cd = Dp ln(E / Ec). At e times the critical exposure a line is as deep as the light
// penetrates.
TEST(Cure, ReachesAsDeepAsTheLogarithmOfItsLight) {
  const Cure cure = resin();
  EXPECT_NEAR(cure.depth(speed_for(std::numbers::e)), 0.1e-3, 1e-12);
  EXPECT_NEAR(cure.depth(speed_for(std::exp(4))), 0.4e-3, 1e-12);
  EXPECT_EQ(cure.depth(speed_for(0.9)), 0);
}

// All that the guide sends goes through a strip of its diameter: its exposure, summed across, is P / v.
TEST(Cure, SpendsTheLightThatItHas) {
  const Cure cure = resin();
  const double speed = 2e-3;
  double sum = 0;
  constexpr int kSlices = 100000;
  for (int i = 0; i < kSlices; ++i) {
    const double y = -0.25e-3 + 0.5e-3 * (i + 0.5) / kSlices;
    sum += cure.exposure(speed) * std::sqrt(1 - y * y / (0.25e-3 * 0.25e-3)) * 0.5e-3 / kSlices;
  }
  EXPECT_NEAR(sum, cure.power / speed, 1e-6 * cure.power / speed);
}

// At sqrt(2) times the critical exposure the chord where it is reached lies at d / 2 sqrt(2) from the middle.
TEST(Cure, IsAsWideAsTheLightSuffices) {
  EXPECT_NEAR(resin().width(speed_for(std::numbers::sqrt2)), 0.5e-3 / std::numbers::sqrt2, 1e-12);
  EXPECT_EQ(resin().width(speed_for(1)), 0);
}

// With far more light than needed a thin gap is full but for its edges: a band as wide as the guide.
TEST(Cure, FillsTheGapAndNoMore) {
  const Cure cure = resin();
  EXPECT_NEAR(cure.area(speed_for(1e4), 0.05e-3), 0.05e-3 * 0.5e-3, 0.001 * 0.05e-3 * 0.5e-3);
  // Free: below Dp ln(E0/Ec) a chord deep. Integral of Dp (L + ln sqrt(1 - u^2)) over all of the disc, for L
  // large: d Dp (L - (1 - ln 2)), for the mean of ln(1 - u^2) / 2 over -1..1 is ln 2 - 1.
  const double free = 0.5e-3 * 0.1e-3 * (20 - (1 - std::numbers::ln2));
  EXPECT_NEAR(cure.area(speed_for(std::exp(20)), 1), free, 1e-3 * free);
  EXPECT_EQ(cure.area(speed_for(2), 0), 0);
}

}  // namespace
}  // namespace understudy::machine
