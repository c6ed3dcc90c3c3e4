#include "sim/collision/conservative_advancement.h"

#include <gtest/gtest.h>

namespace understudy::sim {
namespace {

constexpr double kRounding = 1e-15;  // [m], of sums of millimetres

/// Touching at 0, near at 0.5 mm; nothing on record yet.
ClearanceLimits limits() {
  ClearanceLimits l;
  l.near = 0.5e-3;
  l.depth_accuracy = l.resolution = 0.02e-3;
  l.accuracy = 0.05e-3;
  return l;
}

TEST(ConservativeAdvancement, AFarPairMayMoveUntilItIsNear) {
  ClearanceLimits l = limits();
  l.least = 0.1e-3;
  EXPECT_NEAR(allowed_motion(10e-3, l), 9.5e-3, kRounding);
}

TEST(ConservativeAdvancement, ANearPairMayMoveUntilItTouches) {
  ClearanceLimits l = limits();
  l.deepest = l.least = 0.02e-3;  // both already seen nearer than the accuracy asks for
  EXPECT_NEAR(allowed_motion(0.3e-3, l), 0.3e-3, kRounding);
}

TEST(ConservativeAdvancement, TheFirstPairMayNotMoveFartherThanItsResolutionForItMayBeTheNearest) {
  EXPECT_NEAR(allowed_motion(10e-3, limits()), 0.02e-3, kRounding) << "the least clearance is not known yet";
}

TEST(ConservativeAdvancement, OnlyAClearanceThatBeatsTheLeastByTheAccuracyMustBeSeen) {
  ClearanceLimits l = limits();
  l.least = 2e-3;
  EXPECT_NEAR(allowed_motion(10e-3, l), 10e-3 - 1.95e-3, kRounding) << "0.05 mm is more than 1 %";
  l.least = 8e-3;
  EXPECT_NEAR(allowed_motion(10e-3, l), 10e-3 - 7.92e-3, kRounding) << "1 % is more than 0.05 mm";
}

TEST(ConservativeAdvancement, ATouchingPairMayMoveByTheAccuracyOfItsDepth) {
  ClearanceLimits l = limits();
  l.deepest = l.least = -1e-3;
  EXPECT_NEAR(allowed_motion(-1e-3, l), 0.05e-3, kRounding) << "5 % of the depth";
  EXPECT_NEAR(allowed_motion(-0.5e-3, l), 0.55e-3, kRounding) << "down to 5 % below the deepest";
  l.deepest = l.least = -0.1e-3;
  EXPECT_NEAR(allowed_motion(-0.1e-3, l), 0.02e-3, kRounding)
      << "the stated accuracy, where it is more than 5 %";
}

}  // namespace
}  // namespace understudy::sim
