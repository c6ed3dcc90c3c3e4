#include "sim/beads/hull_beads.h"

#include <gtest/gtest.h>

#include "geometry/convex_hull.h"
#include "sim/distance/convex_solid.h"
#include "tests/sim/beads/beads_for_tests.h"

namespace understudy::sim {
namespace {

HullCore box_hull(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return {geometry::convex_hull(corners, "box")};
}

// The same box as a solid of the index' own search.
TEST(HullBeads, NearestToABoxIsThatOfTheBox) {
  Random random(5, "beads around hulls");
  BeadIndex beads;
  for (const Bead& bead : test::random_beads(random, 300, 0.02)) beads.add(bead);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 half(random.uniform(1e-3, 5e-3), random.uniform(1e-3, 5e-3), random.uniform(1e-3, 5e-3));
    const Pose X =
        make_pose(Quat(exp_rotation(test::random_vector(random, 1.5))), test::random_vector(random, 0.03));
    const std::size_t before = i % 2 ? beads.size() : beads.size() / 2;
    const auto expected = beads.nearest({BoxCore{half}, 0}, X, 5e-3, before);
    const auto here = nearest_bead(beads, box_hull(half), X, 5e-3, before);
    ASSERT_EQ(here.has_value(), expected.has_value());
    if (!here) continue;
    ++found;
    EXPECT_NEAR(here->separation.distance, expected->separation.distance, 2e-6);
  }
  EXPECT_GT(found, 50);
}

TEST(HullBeads, ACornerOfItsBoxThatItDoesNotFillIsAir) {
  BeadIndex beads;
  beads.add(test::flat_bead(Vec3(0.9e-2, 0.9e-2, 0), Vec3(0.9e-2, 0.9e-2, 1e-3)));
  const HullCore wedge{geometry::convex_hull({Vec3(0, 0, -0.01), Vec3(0.01, 0, -0.01), Vec3(0, 0.01, -0.01),
                                              Vec3(0, 0, 0.01), Vec3(0.01, 0, 0.01), Vec3(0, 0.01, 0.01)},
                                             "wedge")};
  EXPECT_FALSE(nearest_bead(beads, wedge, Pose::Identity(), 1e-3, 1));
  const auto near = nearest_bead(beads, wedge, Pose::Identity(), 1e-2, 1);
  ASSERT_TRUE(near);
  // The bead's middle is (0.018 - 0.01) / sqrt 2 off the slanted side, 5.66 mm.
  EXPECT_NEAR(near->separation.distance, 5.66e-3, 0.25e-3);
}

}  // namespace
}  // namespace understudy::sim
