#include "geometry/box_mesh.h"

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::geometry {
namespace {

TEST(BoxMesh, IsClosedFacesOutwardAndHasTheBoxesVolume) {
  const auto box = box_mesh(Vec3(-1, 2, -3), Vec3(1, 5, 4));
  EXPECT_EQ(box->open_edges(), 0);
  EXPECT_EQ(box->flipped_edges(), 0);
  EXPECT_NEAR(box->volume(), 2 * 3 * 7, 1e-12);
  EXPECT_EQ(box->lower(), Vec3(-1, 2, -3));
  EXPECT_EQ(box->upper(), Vec3(1, 5, 4));
}

TEST(BoxMesh, MovesWithThePose) {
  // A quarter turn about z takes x to y.
  const auto box = box_mesh(Vec3(0, 0, 0), Vec3(2, 1, 3),
                            make_pose(exp_rotation(90 * kDegree * Vec3::UnitZ()), Vec3(0, 0, 1)));
  EXPECT_LT((box->lower() - Vec3(-1, 0, 1)).norm(), 1e-12);
  EXPECT_LT((box->upper() - Vec3(0, 2, 4)).norm(), 1e-12);
  EXPECT_NEAR(box->volume(), 6, 1e-12);
}

TEST(BoxMesh, TheFirstFourTrianglesAreBottomAndTop) {
  const std::vector<Vec3> corners = box_corners(Vec3::Zero(), Vec3::Ones());
  for (std::size_t t = 0; t < 4; ++t) {
    for (const int i : box_triangles()[t]) EXPECT_EQ(corners[static_cast<std::size_t>(i)].z(), t < 2 ? 0 : 1);
  }
}

}  // namespace
}  // namespace understudy::geometry
