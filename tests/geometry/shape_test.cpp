#include "geometry/shape.h"

#include <gtest/gtest.h>

namespace understudy::geometry {
namespace {

TEST(Shape, ACapsuleHasItsCapsAtTheGivenPoints) {
  const Vec3 a(0.01, 0.02, 0.03), b(-0.02, 0.05, 0.01);
  const Shape shape = capsule_between("rod", a, b, 2e-3);
  const auto& capsule = std::get<Capsule>(shape.form);
  EXPECT_EQ(shape.name, "rod");
  EXPECT_EQ(capsule.radius, 2e-3);
  EXPECT_NEAR(capsule.length, (b - a).norm(), 1e-17);
  EXPECT_LE((shape.X_FS * Vec3(0, 0, -capsule.length / 2) - a).norm(), 1e-16);
  EXPECT_LE((shape.X_FS * Vec3(0, 0, capsule.length / 2) - b).norm(), 1e-16);
}

TEST(Shape, ACapsuleBetweenEqualPointsIsABall) {
  const Shape shape = capsule_between("ball", Vec3(1, 2, 3), Vec3(1, 2, 3), 2e-3);
  EXPECT_EQ(std::get<Capsule>(shape.form).length, 0);
  EXPECT_EQ(shape.X_FS.translation(), Vec3(1, 2, 3));
  EXPECT_TRUE(shape.X_FS.matrix().allFinite());
}

}  // namespace
}  // namespace understudy::geometry
