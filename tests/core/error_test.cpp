#include "core/error.h"

#include <vector>

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(Errors, InputErrorLeadsWithItsPlace) {
  EXPECT_STREQ(InputError(Place{"a.gcode", 12, 7}, "strut 3 is too long").what(),
               "a.gcode:12:7: strut 3 is too long");
  EXPECT_STREQ(InputError(Place{"a.gcode", 0, 0}, "empty").what(), "a.gcode: empty");
  EXPECT_STREQ(InputError("no such machine").what(), "no such machine");
}

TEST(Errors, EditDistanceCountsTheFewestEdits) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);  // the textbook's example
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("same", "same"), 0);
}

TEST(Errors, NearestWordFindsATypoAndNothingFarAway) {
  const std::vector<std::string> known{"lead_mm", "velocity_max_mm_per_s", "microsteps"};
  EXPECT_EQ(nearest_word("leed_mm", known), "lead_mm");
  EXPECT_EQ(nearest_word("zzzz", known), "");
}

}  // namespace
}  // namespace understudy
