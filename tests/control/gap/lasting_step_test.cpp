#include "control/gap/lasting_step.h"

#include <utility>

#include <gtest/gtest.h>

namespace understudy::control {
namespace {

constexpr double kStep = 30e-6, kNoise = 3e-6;  // [m]

LastingStep of_four() { return LastingStep({.step_max = 50e-6, .gate = 4, .samples = 4}); }

TEST(LastingStep, FourReadingsInARowThatAgreeAreOne) {
  LastingStep step = of_four();
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(step.add(kStep + (i % 2 ? kNoise : -kNoise), kNoise * kNoise));
  EXPECT_TRUE(step.add(kStep + kNoise, kNoise * kNoise));
  EXPECT_NEAR(step.mean(), kStep, 1e-12);
}

TEST(LastingStep, ABeadIsNone) {
  LastingStep step = of_four();
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(step.add(-51e-6, kNoise * kNoise));
}

TEST(LastingStep, AReadingOffToTheOtherSideOrByABeadBeginsAnew) {
  for (const double other : {-kStep, 51e-6}) {
    LastingStep step = of_four();
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(step.add(kStep, kNoise * kNoise));
    EXPECT_FALSE(step.add(other, kNoise * kNoise));
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(step.add(kStep, kNoise * kNoise)) << i;
    EXPECT_TRUE(step.add(kStep, kNoise * kNoise));
  }
}

// 8, 16, 24, 32 um scatter by 8.9 um: within four times 3 um they agree, within four times 2 um they do not.
TEST(LastingStep, ReadingsThatStillMoveAreNone) {
  for (const auto& [sigma, agrees] : {std::pair{3e-6, true}, {2e-6, false}}) {
    LastingStep step = of_four();
    for (const double off : {8e-6, 16e-6, 24e-6}) step.add(off, sigma * sigma);
    EXPECT_EQ(step.add(32e-6, sigma * sigma), agrees) << sigma;
  }
}

}  // namespace
}  // namespace understudy::control
