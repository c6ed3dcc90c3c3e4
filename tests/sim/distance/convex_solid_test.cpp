#include "sim/distance/convex_solid.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random_vector.h"

namespace understudy::sim {
namespace {

ConvexSolid solid_of(const geometry::Shape& shape) { return *convex_solid(shape); }
const Pose kHere = Pose::Identity();

std::vector<ConvexSolid> solids() {
  return {solid_of({"", geometry::Sphere{2}, kHere}), solid_of({"", geometry::Capsule{1, 6}, kHere}),
          solid_of({"", geometry::Cylinder{3, 4}, kHere}),
          solid_of({"", geometry::Frustum{0.5, 3.5, 6}, kHere}),
          solid_of({"", geometry::Box{Vec3(6, 4, 3)}, kHere})};
}

Vec3 random_vector(Random& random, double size) { return size * uniform_vec3(random, 1); }

TEST(ConvexSolid, SignedDistancesAreThoseOfTheClosedForms) {
  const auto ball = solid_of({"", geometry::Sphere{2}, kHere});
  EXPECT_DOUBLE_EQ(signed_distance(ball, Vec3(3, 4, 0)), 3);
  EXPECT_DOUBLE_EQ(signed_distance(ball, Vec3(0.5, 0, 0)), -1.5);
  const auto capsule = solid_of({"", geometry::Capsule{1, 6}, kHere});
  EXPECT_DOUBLE_EQ(signed_distance(capsule, Vec3(4, 0, 2)), 3) << "beside its cylinder";
  EXPECT_DOUBLE_EQ(signed_distance(capsule, Vec3(3, 0, 7)), 4) << "3-4-5 from the centre of its cap";
  const auto cylinder = solid_of({"", geometry::Cylinder{3, 4}, kHere});
  EXPECT_DOUBLE_EQ(signed_distance(cylinder, Vec3(0, 6, 6)), 5) << "3-4-5 from its rim";
  EXPECT_DOUBLE_EQ(signed_distance(cylinder, Vec3(2.5, 0, 0)), -0.5);
  EXPECT_DOUBLE_EQ(signed_distance(cylinder, Vec3(0, 0, 1.75)), -0.25);
  const auto box = solid_of({"", geometry::Box{Vec3(6, 4, 2)}, kHere});
  EXPECT_DOUBLE_EQ(signed_distance(box, Vec3(6, 6, 13)), 13) << "3-4-12 from a corner";
  EXPECT_DOUBLE_EQ(signed_distance(box, Vec3(2.5, 1, 0)), -0.5);
  // The flank of a cone of 45 degrees.
  const auto cone = solid_of({"", geometry::Frustum{0, 5, 5}, kHere});
  EXPECT_NEAR(signed_distance(cone, Vec3(4, 0, 2)), std::sqrt(2), 1e-15);
  EXPECT_NEAR(signed_distance(cone, Vec3(1, 0, 3)), -std::sqrt(2), 1e-15);
}

TEST(ConvexSolid, AMeshIsNone) { EXPECT_FALSE(convex_solid({"", geometry::MeshShape{}, kHere})); }

TEST(ConvexSolid, FarthestPointIsInTheCoreAndNoOtherIsFarther) {
  Random random(1, "support");
  for (const ConvexSolid& solid : solids())
    for (int n = 0; n < 500; ++n) {
      const Vec3 direction = random_vector(random, 1), p = random_vector(random, 8);
      std::visit(
          [&](const auto& core) {
            const Vec3 farthest = core.farthest(direction), inside = core.nearest(p);
            EXPECT_LE((core.nearest(farthest) - farthest).norm(), 1e-14) << "in the core";
            EXPECT_LE(direction.dot(inside), direction.dot(farthest) + 1e-13);
          },
          solid.core);
    }
}

TEST(ConvexSolid, NearestPointOfAConvexCoreSeesEveryPointBehindIt) {
  Random random(2, "nearest");
  for (const ConvexSolid& solid : solids())
    for (int n = 0; n < 500; ++n) {
      const Vec3 p = random_vector(random, 8), other = random_vector(random, 8);
      std::visit(
          [&](const auto& core) {
            const Vec3 q = core.nearest(p);
            EXPECT_LE((p - q).dot(core.nearest(other) - q), 1e-12);
          },
          solid.core);
    }
}

TEST(ConvexSolid, BallsOfItsSurfaceLieInsideAndTouchIt) {
  for (const ConvexSolid& solid : solids())
    for (const Ball& ball : surface_balls(solid))
      EXPECT_NEAR(signed_distance(solid, ball.centre), -ball.radius, 1e-14);
}

TEST(ConvexSolid, ReachIsToItsFarthestPoint) {
  const Pose shifted = make_pose(Quat::Identity(), Vec3(3, 4, 0));
  EXPECT_DOUBLE_EQ(reach(solid_of({"", geometry::Sphere{2}, kHere}), shifted), 7);
  EXPECT_DOUBLE_EQ(reach(solid_of({"", geometry::Capsule{1, 24}, kHere}), shifted), 13 + 1);
  EXPECT_DOUBLE_EQ(reach(solid_of({"", geometry::Box{Vec3(2, 4, 4)}, kHere}), kHere), 3);
  // A round body's is that of its box, at least its own.
  EXPECT_GE(reach(solid_of({"", geometry::Cylinder{3, 8}, kHere}), kHere), 5);
}

}  // namespace
}  // namespace understudy::sim
