#include "sim/distance/supporting_plane.h"

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "sim/distance/convex_solid.h"
#include "sim/distance/gjk.h"

namespace understudy::sim {
namespace {

const FrustumCore kNozzle{0.5e-3, 3.5e-3, 0, 12e-3};

Pose random_pose(Random& random) {
  const Mat3 R = exp_rotation(uniform_vec3(random, 2));
  return make_pose(R, uniform_vec3(random, 20e-3));
}

// GJK knows nothing of the plane.
TEST(SupportingPlane, BoundsTheDistanceOfTrianglesFromBelow) {
  Random random(1, "planes");
  int useful = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Pose X_WS = random_pose(random), X_SW = X_WS.inverse(Eigen::Isometry);
    const SupportingPlane plane = supporting_plane(kNozzle, X_WS, uniform_vec3(random, 30e-3));
    const Vec3 middle = uniform_vec3(random, 30e-3);
    Triangle corners_W, corners_S;
    for (std::size_t i = 0; i < 3; ++i) {
      corners_W[i] = middle + uniform_vec3(random, 5e-3);
      corners_S[i] = X_SW * corners_W[i];
    }
    const double distance =
        distance_to_triangle(kNozzle, corners_S, std::numeric_limits<double>::infinity()).distance;
    EXPECT_LE(plane.bound(corners_W), distance + 1e-12) << trial;
    useful += plane.bound(corners_W) > 0 ? 1 : 0;

    Vec3 lower = corners_W[0], upper = lower;
    for (const Vec3& corner : corners_W) lower = lower.cwiseMin(corner), upper = upper.cwiseMax(corner);
    EXPECT_LE(plane.bound(0.5 * (lower + upper), 0.5 * (upper - lower)), plane.bound(corners_W) + 1e-12);
  }
  EXPECT_GT(useful, 500);
}

TEST(SupportingPlane, IsTheDistanceOfThePointThatItIsMadeFor) {
  Random random(2, "planes");
  for (int trial = 0; trial < 500; ++trial) {
    const Pose X_WS = random_pose(random);
    const Vec3 p = Vec3(25e-3, 0, 6e-3) + uniform_vec3(random, 5e-3);
    const double distance = (p - kNozzle.nearest(p)).norm();
    const Vec3 p_W = X_WS * p;
    EXPECT_NEAR(supporting_plane(kNozzle, X_WS, p).bound(p_W, Vec3::Zero()), distance, 1e-12);
  }
}

TEST(SupportingPlane, IsNoneTowardsAPointInside) {
  const SupportingPlane plane = supporting_plane(kNozzle, Pose::Identity(), Vec3(0, 0, 3e-3));
  EXPECT_LT(plane.bound(Vec3(1, 1, 1), Vec3::Zero()), -1e9);
}

}  // namespace
}  // namespace understudy::sim
