#include "toolpath/support_free/zigzag.h"

#include <gtest/gtest.h>

#include "models/parts/swept_part.h"

namespace understudy::toolpath {
namespace {

double length(const FlatPath& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

TEST(BoundingRectangle, IsTheSmallestAlongItsLongerSide) {
  Contour turned;
  const Eigen::Rotation2Dd by(30 * kDegree);
  for (const Vec2& p : rectangle_mm(16, 10)) turned.emplace_back(by * p + Vec2(5e-3, 1e-3));
  const BoundingRectangle box = bounding_rectangle(turned, {1, 0});
  EXPECT_NEAR(box.length, 16e-3, 1e-9);
  EXPECT_NEAR(box.width, 10e-3, 1e-9);
  EXPECT_NEAR((box.centre - Vec2(5e-3, 1e-3)).norm(), 0, 1e-9);
  EXPECT_NEAR((box.along - by * Vec2(1, 0)).norm(), 0, 1e-9);
}

TEST(BoundingRectangle, OfACircleStaysAsItWas) {
  const Vec2 along = Vec2(0.8, 0.6);
  EXPECT_NEAR((bounding_rectangle(circle_mm(6), along).along - along).norm(), 0, 1e-12);
}

/// 16 by 10 mm at 0.5 mm: 33 lines of 10 mm and 32 steps of 0.5 mm.
TEST(Zigzag, FillsARectangleByOnePath) {
  double spacing = 0;
  const auto paths = zigzag({rectangle_mm(16, 10)}, {1, 0}, 0.5e-3, {-0.02, 0.02}, spacing);
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_NEAR(spacing, 0.5e-3, 1e-6);
  EXPECT_NEAR(length(paths[0]), 33 * 10e-3 + 16e-3, 0.1e-3);
  EXPECT_NEAR(paths[0].front().x(), -8e-3, 2e-6);
  EXPECT_NEAR(paths[0].front().y(), 5e-3, 2e-6);
  EXPECT_NEAR(paths[0].back().x(), 8e-3, 2e-6);
}

TEST(Zigzag, BeginsAtTheEndNearTheTool) {
  double spacing = 0;
  const auto paths = zigzag({rectangle_mm(16, 10)}, {1, 0}, 0.5e-3, {0.02, -0.02}, spacing);
  EXPECT_NEAR(paths.at(0).front().x(), 8e-3, 2e-6);
  EXPECT_NEAR(paths.at(0).front().y(), -5e-3, 2e-6);
}

TEST(Zigzag, LinesAreNoFartherApartThanAskedFor) {
  double spacing = 0;
  zigzag({rectangle_mm(16, 10)}, {1, 0}, 0.53e-3, {0, 0}, spacing);
  EXPECT_NEAR(spacing, 16e-3 / 31, 1e-6);
}

/// A hole parts the lines; both sides are filled, nothing in the hole.
TEST(Zigzag, GoesRoundAHole) {
  Contour hole = rectangle_mm(4, 4);
  std::reverse(hole.begin(), hole.end());
  double spacing = 0;
  const auto paths = zigzag({rectangle_mm(16, 10), hole}, {1, 0}, 0.5e-3, {-0.02, 0.02}, spacing);
  EXPECT_GE(paths.size(), 2u);
  double sum = 0;
  for (const FlatPath& path : paths) {
    sum += length(path);
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Vec2 middle = 0.5 * (path[i] + path[i - 1]);
      EXPECT_FALSE(std::abs(middle.x()) < 1.9e-3 && std::abs(middle.y()) < 1.9e-3);
    }
  }
  // 33 lines of 10 mm, of which 9 miss 4 mm; a step of 0.5 mm to almost every one.
  EXPECT_NEAR(sum, 33 * 10e-3 - 9 * 4e-3 + 20e-3, 4e-3);
}

/// From the top of the upright of an L to its foot no line is laid through what is not there.
TEST(Zigzag, LeavesOutWhatIsNoPartOfTheRegion) {
  Contour l{{0, 0}, {4, 0}, {4, 4}, {1.6, 4}, {1.6, 10}, {0, 10}};
  for (Vec2& p : l) p *= 1e-3;
  double spacing = 0;
  const auto paths = zigzag({l}, {1, 0}, 0.5e-3, {-1e-3, 11e-3}, spacing);
  EXPECT_EQ(paths.size(), 2u);
  for (const FlatPath& path : paths)
    for (std::size_t i = 1; i < path.size(); ++i) {
      const Vec2 middle = 0.5 * (path[i] + path[i - 1]);
      EXPECT_FALSE(middle.x() > 1.61e-3 && middle.y() > 4.01e-3) << middle.transpose();
    }
}

}  // namespace
}  // namespace understudy::toolpath
