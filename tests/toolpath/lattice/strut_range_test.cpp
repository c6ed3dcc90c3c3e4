#include "toolpath/lattice/strut_range.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr double kDiameter = 0.48e-3, kMargin = 0.1e-3;

geometry::Shape cylinder(const char* name, double radius_mm, double from_mm_, double to_mm_) {
  const Vec3 middle(0, 0, 0.5e-3 * (from_mm_ + to_mm_));
  return {name, geometry::Cylinder{radius_mm * 1e-3, (to_mm_ - from_mm_) * 1e-3},
          make_pose(Quat::Identity(), middle)};
}
std::vector<StrutRange> ranges(const std::vector<geometry::Shape>& tool) {
  return strut_ranges(ToolEnvelope(tool), kDiameter, kMargin);
}

// Beside a straight nozzle of radius r the next strut's surface is at length - d/2, so the length is at least
// r + d/2 + margin; what is above it at height h allows at most h - margin.
TEST(StrutRange, OfAStraightNozzleBelowAPlateIsToldByWidthAndHeight) {
  const auto found = ranges({cylinder("nozzle", 2, 0, 9), cylinder("plate", 200, 9, 20)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(to_mm(found[0].from), 2 + 0.24 + 0.1, 5e-3);
  EXPECT_NEAR(to_mm(found[0].to), 9 - 0.1, 5e-3);
  EXPECT_TRUE(in_ranges(5e-3, found));
  EXPECT_FALSE(in_ranges(2.2e-3, found));
  EXPECT_FALSE(in_ranges(9.1e-3, found));
}

// A cone of 45 degrees: the rim of the strut's top, d/2 round, is at (length, length) but for d/2 each way;
// the cone r = 0.5 + z keeps (length - 0.5 - z) cos 45 from it, which is below d/2 + margin at every length.
TEST(StrutRange, ABluntConeLeavesNoRoomForShortStruts) {
  const std::vector<geometry::Shape> blunt = {
      {"nozzle", geometry::Frustum{0.5e-3, 6.5e-3, 6e-3}, Pose::Identity()}};
  const auto found = ranges(blunt);
  ASSERT_FALSE(found.empty());
  EXPECT_GT(to_mm(found[0].from), 6.5);
  const std::vector<geometry::Shape> sharp = {
      {"nozzle", geometry::Frustum{0.5e-3, 3.5e-3, 12e-3}, Pose::Identity()}};
  EXPECT_LT(to_mm(ranges(sharp)[0].from), 1.5);
}

// Ishak 2018: struts of 5 to 11 mm can be printed. A hexagon 8 mm across flats (4.62 mm at its corners) above
// a blunt cone has that range below a block 12 mm and a duct 11.5 mm above the tip: 4.62 + 0.24 + 0.1,
// and 11.5 - 0.1.
TEST(StrutRange, OfAHexagonBelowABlockHoldsWholeMillimetresFrom5To11) {
  const auto found =
      ranges({{"nozzle", geometry::Frustum{0.5e-3, 4.62e-3, 4e-3}, Pose::Identity()},
              cylinder("nozzle hexagon", 4.62, 4, 12),
              {"heater block", geometry::Box{Vec3(16e-3, 16e-3, 10e-3)},
               make_pose(Quat::Identity(), Vec3(0, 0, 17e-3))},
              geometry::capsule_between("duct", Vec3(13e-3, 0, 14e-3), Vec3(18e-3, 0, 22e-3), 2.5e-3)});
  for (int length = 1; length <= 15; ++length)
    EXPECT_EQ(in_ranges(length * 1e-3, found), length >= 5 && length <= 11) << length;
  EXPECT_NEAR(to_mm(found[0].from), 4.96, 5e-3);
  EXPECT_NEAR(to_mm(found[0].to), 11.4, 5e-3);
}

TEST(StrutRange, IsToldRoundedInwards) {
  EXPECT_EQ(to_string({{1.0612e-3, 11.409e-3}, {20e-3, 21e-3}}), "1.07..11.40 or 20.00..21.00 mm");
  EXPECT_EQ(to_string({}), "no length");
}

}  // namespace
}  // namespace understudy::toolpath
