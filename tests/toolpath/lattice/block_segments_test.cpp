#include "toolpath/lattice/block_segments.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "models/parts/block_part.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

constexpr double kStrut = 5e-3;

SegmentedPart segmented(const Cubes& cubes, double side_mm = 5) {
  return segment_part(*block_part(cubes, side_mm), kStrut);
}
std::string refusal(const Cubes& cubes, double side_mm = 5) {
  try {
    segmented(cubes, side_mm);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// A base of 2 x 2 x 8 cubes.
Cubes base() {
  Cubes cubes;
  add_block(cubes, {0, 0, 0}, {2, 2, 8});
  return cubes;
}
Cubes with(Cubes cubes, const std::array<int, 3>& lower, const std::array<int, 3>& upper) {
  add_block(cubes, lower, upper);
  return cubes;
}

TEST(BlockSegments, ABlockIsItsBase) {
  const SegmentedPart part = segmented(base());
  ASSERT_EQ(part.segments.size(), 1u);
  EXPECT_EQ(part.segments[0].direction, BuildDirection::z_up);
  EXPECT_EQ(part.segments[0].cubes.size(), 32u);
  EXPECT_NEAR(part.share, 1, 1e-6);
}

// Ishak 2018, figures 5 and 6: the base in Z+, then Y-, Y+, X- and X+.
TEST(BlockSegments, FourArmsProtrudeEachInItsOwnDirection) {
  const SegmentedPart part = segmented(column_with_arms());
  std::vector<std::string> names;
  for (const Segment& segment : part.segments) {
    names.emplace_back(name_of(segment.direction));
    EXPECT_EQ(segment.cubes.size(), segment.direction == BuildDirection::z_up ? 8u : 2u);
    const Vec3 axis = axis_of(segment.direction);
    for (const auto& c : segment.cubes) {  // the column's cube is 2 steps from the corner
      const Vec3 from_column(c[0] - 2, c[1] - 2, 0);
      if (segment.direction != BuildDirection::z_up) {
        EXPECT_GT(axis.dot(from_column), 0.9);
        EXPECT_EQ(axis.cross(from_column).norm(), 0);
      }
    }
  }
  EXPECT_THAT(names, ::testing::ElementsAre("Z+", "Y-", "Y+", "X-", "X+"));
}

// What is printed along Y is part of what X stands on: an arm in X+ as wide as the base and both arms.
TEST(BlockSegments, ASegmentAlongXStandsOnThoseAlongYToo) {
  Cubes cubes = with(base(), {0, -1, 6}, {2, 3, 8});
  add_block(cubes, {2, -1, 6}, {4, 3, 8});
  const SegmentedPart part = segmented(cubes);
  ASSERT_EQ(part.segments.size(), 4u);
  EXPECT_EQ(part.segments[3].direction, BuildDirection::x_plus);
  EXPECT_EQ(part.segments[3].cubes.size(), 16u);
}

TEST(BlockSegments, CubesAreCentredOnTheFoot) {
  // 3 x 3 cubes of 7 mm stand on the ground, 21 mm: four of 5 mm, half a millimetre left on each side.
  Cubes cubes;
  add_block(cubes, {0, 0, 0}, {3, 3, 2});
  const SegmentedPart part = segmented(cubes, 7);
  EXPECT_EQ(part.segments[0].cubes.size(), 4u * 4u * 2u);
  EXPECT_NEAR(part.origin.x(), 0.5e-3, 1e-9);
  EXPECT_NEAR(part.origin.z(), 0, 1e-12);
  EXPECT_NEAR(part.share, 32 * 125.0 / (21 * 21 * 14), 1e-6);
}

TEST(BlockSegments, WhatTheRulesDoNotAllowIsRefusedWithItsPlace) {
  // Two arms on one side: the base's corner is at the origin, cubes of 5 mm.
  EXPECT_THAT(refusal(with(with(base(), {2, 0, 7}, {3, 1, 8}), {2, 0, 5}, {3, 1, 6})),
              HasSubstr("2 segments protrude in X+, one at (12.500, 2.500, 27.500) mm and one at (12.500, "
                        "2.500, 37.500) mm"));
  // An arm in Y+ whose end is wider than the base: the rest of it hangs beside the base in X+.
  EXPECT_THAT(refusal(with(with(base(), {0, 2, 7}, {2, 4, 8}), {2, 3, 7}, {3, 5, 8})),
              HasSubstr("hangs over at"));
  // An arm in X+ that grows wider on its way.
  EXPECT_THAT(refusal(with(with(base(), {2, 0, 7}, {3, 1, 8}), {3, 0, 7}, {4, 2, 8})),
              HasSubstr("what protrudes in X+ hangs over at (17.500, 7.500, 37.500) mm"));
  // Two columns; a bridge between two that stand on one plate.
  EXPECT_THAT(
      refusal(with(base(), {4, 0, 0}, {5, 2, 8})),
      HasSubstr("the part stands on the ground in 2 pieces, the other one at (22.500, 2.500, 2.500) mm"));
  Cubes bridge = with(with(Cubes{}, {0, 0, 0}, {1, 3, 8}), {2, 0, 0}, {3, 3, 8});
  add_block(bridge, {0, 0, 0}, {3, 1, 1});
  add_block(bridge, {1, 1, 6}, {2, 2, 8});
  EXPECT_THAT(refusal(bridge),
              HasSubstr("the part overhangs at (7.500, 7.500, 32.500) mm, within the limits"));
}

TEST(BlockSegments, WhatHasNoRoomForACubeIsRefused) {
  EXPECT_THAT(refusal(with(Cubes{}, {0, 0, 0}, {1, 1, 8}), 4), HasSubstr("no cube of 5 mm has room"));
  // An arm 4 mm thick and 12 mm long is not left out in silence.
  Cubes thin;
  add_block(thin, {0, 0, 0}, {3, 3, 10});
  add_block(thin, {3, 0, 9}, {6, 1, 10});
  EXPECT_THAT(refusal(thin, 4), HasSubstr("farther in X+ than the cubes of 5 mm"));
}

}  // namespace
}  // namespace understudy::toolpath
