#include "sim/surface/beads_near.h"

#include <gtest/gtest.h>

#include "sim/surface/bead_mesh.h"

namespace understudy::sim {
namespace {

/// 10 mm along x at this y.
Bead bead_at(float y) {
  Bead bead;
  bead.from_W = {0, y, 0};
  bead.to_W = {10e-3f, y, 0};
  bead.width = 0.4e-3f;
  bead.height = 0.2e-3f;
  return bead;
}

std::size_t beads_in(const std::shared_ptr<const geometry::Mesh>& mesh) {
  return mesh ? mesh->triangles().size() / shell_size(bead_at(0), kBeadSides).triangles : 0;
}

TEST(BeadsNear, AreThoseWhoseMiddleLineIsWithinReach) {
  BeadIndex beads;
  for (const float y : {0.f, 1e-3f, 2e-3f}) beads.add(bead_at(y));
  const Vec3 middle(5e-3, 0, 0);
  EXPECT_EQ(beads_in(beads_near(beads, middle, 0.9e-3)), 1u);
  EXPECT_EQ(beads_in(beads_near(beads, middle, 1.1e-3)), 2u);
  EXPECT_EQ(beads_in(beads_near(beads, middle, 2.1e-3)), 3u);
  // Beyond an end the distance is that of the end: 3 mm and 4 mm make 5.
  EXPECT_EQ(beads_in(beads_near(beads, {13e-3, -4e-3, 0}, 5.1e-3)), 1u);
  EXPECT_EQ(beads_near(beads, {13e-3, -4e-3, 0}, 4.9e-3), nullptr);
}

TEST(BeadsNear, ABlobIsAPoint) {
  BeadIndex beads;
  Bead blob = bead_at(0);
  blob.to_W = blob.from_W;
  beads.add(blob);
  EXPECT_NE(beads_near(beads, {0, 0, 1e-3}, 1.1e-3), nullptr);
  EXPECT_EQ(beads_near(beads, {0, 0, 1e-3}, 0.9e-3), nullptr);
}

TEST(BeadsNear, TheirMeshIsClosedAndHasTheirHeight) {
  BeadIndex beads;
  beads.add(bead_at(0));
  const auto mesh = beads_near(beads, Vec3::Zero(), 1e-3);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->open_edges(), 0);
  EXPECT_NEAR(mesh->upper().z(), 0.1e-3, 1e-9);
  EXPECT_NEAR(mesh->lower().z(), -0.1e-3, 1e-9);
}

TEST(BeadsNear, NothingPrintedIsNoMesh) { EXPECT_EQ(beads_near(BeadIndex(), Vec3::Zero(), 1), nullptr); }

}  // namespace
}  // namespace understudy::sim
