#include "toolpath/polyline.h"

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

TEST(Polyline, LengthIsTheSumOfItsSides) {
  EXPECT_EQ(polyline_length({}), 0);
  EXPECT_EQ(polyline_length({Vec3(1, 2, 3)}), 0);
  EXPECT_DOUBLE_EQ(polyline_length({Vec3(0, 0, 0), Vec3(3, 4, 0), Vec3(3, 4, 12), Vec3(0, 0, 12)}),
                   5 + 12 + 5);
}

TEST(Polyline, SegmentDistanceIsToTheLineBetweenItsEndsAndToAnEndBeyond) {
  const Vec3 a(0, 0, 0), b(10, 0, 0);
  EXPECT_DOUBLE_EQ(segment_distance(Vec3(4, 3, 4), a, b), 5);
  EXPECT_DOUBLE_EQ(segment_distance(Vec3(-3, 4, 0), a, b), 5);
  EXPECT_DOUBLE_EQ(segment_distance(Vec3(22, 3, 4), a, b), 13);
  EXPECT_EQ(segment_distance(Vec3(7, 0, 0), a, b), 0);
  EXPECT_DOUBLE_EQ(segment_distance(Vec3(3, 4, 0), a, a), 5) << "a segment without length is a point";
}

}  // namespace
}  // namespace understudy::toolpath
