#include "geometry/table_surface.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random_vector.h"

namespace understudy::geometry {
namespace {

TEST(TableSurface, ByDefaultIsThePlaneToTheLastBit) {
  const TableSurface plane;
  Random random(1, "planes");
  for (int i = 0; i < 100; ++i) {
    const Vec3 origin = uniform_vec3(random, 0.1);
    Vec3 direction = normal_vec3(random).normalized();
    direction.z() = -std::abs(direction.z());
    ASSERT_EQ(plane.ray_hit(origin, direction).value(), -origin.z() / direction.z());
  }
  EXPECT_EQ(plane.normal({0.05, 0.02}), Vec3(0, 0, 1));
  EXPECT_FALSE(plane.ray_hit({0, 0, 0.01}, {0, 0, 1}));
  EXPECT_FALSE(plane.ray_hit({0, 0, 0.01}, {1, 0, 0}));
}

TEST(TableSurface, ItsNumbersAreHeightSlopeAndTheRimBelowTheMiddle) {
  const TableSurface table{0.3e-3, {2e-3, -1e-3}, 0.1e-3, 0.1};
  EXPECT_DOUBLE_EQ(table.z({0, 0}), 0.3e-3);
  EXPECT_NEAR(table.z({0.1, 0}), 0.3e-3 + 0.2e-3 - 0.1e-3, 1e-12);
  EXPECT_NEAR(table.z({0, -0.1}), 0.3e-3 + 0.1e-3 - 0.1e-3, 1e-12);
}

// Whatever it is bowed, the place that is hit lies on it, in front of the origin where that is above.
TEST(TableSurface, ARayEndsOnIt) {
  Random random(2, "tables");
  for (int i = 0; i < 1000; ++i) {
    TableSurface table{1e-3 * random.normal(), 3e-3 * normal_vec2(random), 0.5e-3 * random.normal(), 0.1};
    Vec3 origin = uniform_vec3(random, 0.05);
    Vec3 direction = normal_vec3(random);
    direction.z() = -std::abs(direction.z()) - 0.3 * direction.head<2>().norm();
    direction.normalize();
    const double t = table.ray_hit(origin, direction).value();
    const Vec3 hit = origin + t * direction;
    ASSERT_NEAR(hit.z(), table.z(hit.head<2>()), 1e-12);
    EXPECT_EQ(t > 0, origin.z() > table.z(origin.head<2>()));
  }
}

TEST(TableSurface, ItsNormalIsThatOfItsHeights) {
  const TableSurface table{0, {2e-3, -1e-3}, 0.4e-3, 0.1};
  const Vec2 p(0.03, -0.06);
  constexpr double h = 1e-6;
  const Vec3 along_x(h, 0, table.z(p + Vec2(h, 0)) - table.z(p)),
      along_y(0, h, table.z(p + Vec2(0, h)) - table.z(p));
  EXPECT_LT((table.normal(p) - along_x.cross(along_y).normalized()).norm(), 1e-6);
  EXPECT_NEAR(table.normal(p).norm(), 1, 1e-15);
}

TEST(TableSurface, BesideItThereIsNothing) {
  TableSurface table{0, {2e-3, 0}, 0, 0.1};
  table.half_sides = {0.1, 0.05};
  EXPECT_TRUE(table.ray_hit({0.1, 0.05, 0.01}, {0, 0, -1}));
  EXPECT_FALSE(table.ray_hit({0.1001, 0, 0.01}, {0, 0, -1}));
  EXPECT_FALSE(table.ray_hit({0, -0.0501, 0.01}, {0, 0, -1}));
  EXPECT_FALSE(table.ray_hit({0.095, 0, 0.01}, Vec3(1, 0, -1).normalized())) << "it passes the edge";
  EXPECT_TRUE(table.ray_hit({0.105, 0, 0.01}, Vec3(-1, 0, -1).normalized()));
}

}  // namespace
}  // namespace understudy::geometry
