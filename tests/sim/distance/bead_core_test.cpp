#include "sim/distance/bead_core.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random_vector.h"

namespace understudy::sim {
namespace {

/// A bead along x: 4 long, 1 wide and 0.4 high, its flat core 0.6 wide.
BeadCore straight() {
  BeadCore bead;
  bead.half_along = Vec3(2, 0, 0);
  bead.half_side = Vec3(0, 0.3, 0);
  bead.radius = 0.2;
  return bead;
}

/// A drop 1 wide and 0.4 high.
BeadCore blob() {
  BeadCore bead;
  bead.disc_radius = 0.3;
  bead.radius = 0.2;
  return bead;
}

TEST(BeadCore, SignedDistancesAreThoseOfARoundedPlate) {
  EXPECT_DOUBLE_EQ(signed_distance(straight(), Vec3(1, 0.1, 0.9)), 0.7) << "over its flat";
  EXPECT_DOUBLE_EQ(signed_distance(straight(), Vec3(0, 0.9, 0.8)), 0.8) << "3-4-5 from its side";
  EXPECT_DOUBLE_EQ(signed_distance(straight(), Vec3(2.3, 0.7, 1.2)), 1.1) << "3-4-12 from a corner";
  EXPECT_DOUBLE_EQ(signed_distance(straight(), Vec3(1, 0, 0)), -0.2);
  EXPECT_DOUBLE_EQ(signed_distance(blob(), Vec3(0, 0.9, 0.8)), 0.8);
  EXPECT_DOUBLE_EQ(signed_distance(blob(), Vec3(0.1, 0.1, 0.5)), 0.3);
}

TEST(BeadCore, FarthestPointIsInTheCoreAndNoOtherIsFarther) {
  Random random(1, "bead support");
  for (const BeadCore& bead : {straight(), blob()})
    for (int n = 0; n < 500; ++n) {
      const Vec3 direction = normal_vec3(random);
      const Vec3 p = normal_vec3(random);
      const Vec3 farthest = bead.farthest(direction);
      EXPECT_LE((bead.nearest(farthest) - farthest).norm(), 1e-15);
      EXPECT_LE(direction.dot(bead.nearest(p)), direction.dot(farthest) + 1e-14);
      EXPECT_LE((farthest - bead.middle).norm() + bead.radius, bead.reach() + 1e-15);
    }
}

TEST(BeadCore, NormalsPointAwayFromTheCore) {
  EXPECT_EQ(normal_at(straight(), Vec3(1, 0, 0.2), Vec3::UnitX()), Vec3::UnitZ());
  EXPECT_LE((normal_at(straight(), Vec3(0, 0.42, 0.16), Vec3::UnitX()) - Vec3(0, 0.6, 0.8)).norm(), 1e-14);
  EXPECT_EQ(normal_at(straight(), Vec3(1, 0, 0), Vec3::UnitX()), Vec3::UnitX()) << "in the core itself";
}

TEST(BeadCore, ARayGoesInAndOutThroughTheSurface) {
  const auto in = entry(straight(), Vec3(0.5, 0, 3), -Vec3::UnitZ(), 10);
  const auto out = leaving(straight(), Vec3(0.5, 0, 3), -Vec3::UnitZ());
  ASSERT_TRUE(in && out);
  EXPECT_NEAR(*in, 2.8, 1e-12);
  EXPECT_NEAR(*out, 3.2, 1e-12);
  EXPECT_EQ(entry(straight(), Vec3(0.5, 0, 0.1), -Vec3::UnitZ(), 10), 0) << "from inside";
  EXPECT_FALSE(entry(straight(), Vec3(0.5, 0, 3), -Vec3::UnitZ(), 2)) << "beyond its reach";
  EXPECT_FALSE(entry(straight(), Vec3(0.5, 0, 3), Vec3::UnitZ(), 10)) << "away from it";
  EXPECT_FALSE(leaving(straight(), Vec3(0.5, 2, 3), -Vec3::UnitZ())) << "beside it";
}

TEST(BeadCore, RandomRaysStayOutsideUntilTheyGoIn) {
  Random random(2, "rays on beads");
  for (const BeadCore& bead : {straight(), blob()})
    for (int n = 0; n < 300; ++n) {
      const Vec3 origin = 4 * normal_vec3(random);
      const Vec3 target(random.uniform(-0.3, 0.3), random.uniform(-0.2, 0.2), random.uniform(-0.1, 0.1));
      if (signed_distance(bead, origin) <= 0) continue;
      const Vec3 direction = (target - origin).normalized();
      const auto in = entry(bead, origin, direction, 100);
      ASSERT_TRUE(in) << "it aims at the inside";
      EXPECT_NEAR(signed_distance(bead, origin + *in * direction), 0, 1e-12);
      for (const double share : {0.2, 0.6, 0.95})
        EXPECT_GT(signed_distance(bead, origin + share * *in * direction), 0);
      EXPECT_GE(*leaving(bead, origin, direction), *in);
    }
}

TEST(BeadCore, MovesRigidlyFromFrameToFrame) {
  const Pose X_FW = make_pose(exp_rotation(Vec3(0.3, -0.8, 0.5)), Vec3(1, 2, 3));
  const BeadCore moved = in_frame(straight(), X_FW);
  for (const Vec3& p : {Vec3(1, 0.1, 0.9), Vec3(0, 0.9, 0.8), Vec3(3, 3, 3)})
    EXPECT_NEAR(signed_distance(moved, X_FW * p), signed_distance(straight(), p), 1e-13);
}

}  // namespace
}  // namespace understudy::sim
