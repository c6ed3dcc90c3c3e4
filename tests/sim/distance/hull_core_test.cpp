#include "sim/distance/hull_core.h"

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "geometry/convex_hull.h"
#include "sim/distance/convex_solid.h"

namespace understudy::sim {
namespace {

std::vector<Vec3> corners(const Vec3& half) {
  std::vector<Vec3> all;
  for (int i = 0; i < 8; ++i)
    all.push_back(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return all;
}

// The box has closed forms of its own.
TEST(HullCore, OfABoxAnswersAsTheBox) {
  const BoxCore box{Vec3(0.3, 0.2, 0.1)};
  const HullCore hull{geometry::convex_hull(corners(box.half), "box")};
  Random random(3, "points around a box");
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = uniform_vec3(random, 0.5);
    EXPECT_LT((hull.nearest(p) - box.nearest(p)).norm(), 1e-12);
    EXPECT_NEAR(hull.depth(p), box.depth(p), 1e-12);
    EXPECT_NEAR(hull.farthest(p).dot(p), box.farthest(p).dot(p), 1e-12);
  }
}

TEST(HullCore, ReachesAsFarAsItsFarthestCorner) {
  const HullCore hull{geometry::convex_hull(corners(Vec3(3, 4, 12)), "box")};
  EXPECT_NEAR(reach(hull, Pose::Identity()), 13, 1e-12);
  EXPECT_NEAR(reach(hull, make_pose(Quat::Identity(), Vec3(0, 0, 4))), std::sqrt(9 + 16 + 256), 1e-12);
}

}  // namespace
}  // namespace understudy::sim
