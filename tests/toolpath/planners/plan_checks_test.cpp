#include "toolpath/planners/plan_checks.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/complaint.h"

namespace understudy::toolpath {
namespace {

TEST(PlanChecks, APositiveValueIsFiniteAndAboveZero) {
  EXPECT_EQ(complaint([] { check_positive("feed", 0.1, "mm/min"); }), "accepted");
  EXPECT_EQ(complaint([] { check_positive("feed", -3, "mm/min"); }),
            "feed is -3 mm/min, it must be above 0 mm/min");
  for (const double bad : {0.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_NE(complaint([&] { check_positive("feed", bad, "mm/min"); }), "accepted") << bad;
}

TEST(PlanChecks, ARangeIncludesItsEnds) {
  for (const double good : {5.0, 8.0, 11.0})
    EXPECT_EQ(complaint([&] { check_within("strut", good, 5, 11, "mm"); }), "accepted");
  EXPECT_EQ(complaint([] { check_within("strut", 4.5, 5, 11, "mm"); }),
            "strut is 4.5 mm, outside 5 to 11 mm");
  EXPECT_NE(complaint([] { check_within("strut", std::nan(""), 5, 11, "mm"); }), "accepted");
}

TEST(PlanChecks, ABeadIsAtLeastAsWideAsHigh) {
  EXPECT_EQ(complaint([] { check_bead(0.2e-3, 0.2e-3); }), "accepted");
  EXPECT_EQ(complaint([] { check_bead(0.4e-3, 0.5e-3); }),
            "bead width is 0.4 mm, less than its height of 0.5 mm");
}

TEST(PlanChecks, TheFanIsAShareAndTheHeaterNotBelowAbsoluteZero) {
  EXPECT_EQ(complaint([] { check_nozzle(0, 1); }), "accepted");
  EXPECT_NE(complaint([] { check_nozzle(483, 1.01); }), "accepted");
  EXPECT_NE(complaint([] { check_nozzle(-1, 0.5); }), "accepted");
}

TEST(PlanChecks, StepsAreCountedUpToALimit) {
  EXPECT_EQ(step_count(1, 0.3), 4);
  EXPECT_EQ(step_count(0.9, 0.3), 3);
  EXPECT_EQ(step_count(0, 0.3), 1);
  EXPECT_EQ(step_count(10, 1e-6), 10'000'000);
  // Beyond an int, a cast would make any number of it.
  for (const double step : {0.9e-6, 1e-12, 1e-300, 0.0, std::nan("")})
    EXPECT_NE(complaint([&] { step_count(10, step); }), "accepted") << step;
  EXPECT_EQ(complaint([] { step_count(0.05, 1e-12); }),
            "a path of 5e+10 steps, more than 1e+07: choose longer steps, or is the part in another unit?");
}

TEST(PlanChecks, PlacesAreShownInMillimetres) {
  EXPECT_EQ(in_mm(Vec3(1e-3, -2.5e-3, 0.0300004)), "(1.000, -2.500, 30.000) mm");
}

}  // namespace
}  // namespace understudy::toolpath
