#include <numbers>

#include <gtest/gtest.h>

#include "report/picture/workspace_drawing.h"

namespace understudy::report {
namespace {

kinematics::Workspace ball(double radius, int cells) {
  kinematics::Workspace w;
  w.grid = {Vec3::Constant(-1), Vec3::Constant(1), 2.0 / cells};
  w.binding.resize(static_cast<std::size_t>(w.grid.size()));
  w.limits.resize(1);
  w.families.resize(1);
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) w.binding[w.index(x, y, z)] = w.grid.point(x, y, z).norm() > radius;
  return w;
}

TEST(WorkspaceSurface, OfABallIsClosedAndHoldsItsVolume) {
  const auto surface = workspace_surface(ball(0.7, 40), 96);
  ASSERT_EQ(surface.size(), 1u);
  EXPECT_EQ(surface[0].family, 0);
  EXPECT_EQ(surface[0].mesh->flipped_edges(), 0);
  const double volume = 4.0 / 3 * std::numbers::pi * 0.7 * 0.7 * 0.7;
  // Cells are a 14th of the radius: relaxing may cost half of one, 11 % of the volume.
  EXPECT_NEAR(surface[0].mesh->volume(), volume, 0.11 * volume) << "positive: it faces outwards";
}

TEST(WorkspaceSurface, EndsAtTheSidesOfTheGridAndThinsLargeGrids) {
  const auto surface = workspace_surface(ball(9, 40), 10);
  ASSERT_EQ(surface.size(), 1u);
  EXPECT_EQ(surface[0].family, -1) << "everything is reachable: only the grid ends the set";
  EXPECT_LE(surface[0].mesh->triangles().size(), 6u * 2 * 10 * 10);
  EXPECT_GT(surface[0].mesh->volume(), 0.9 * 8);
  EXPECT_LT(surface[0].mesh->volume(), 1.1 * 8);
}

}  // namespace
}  // namespace understudy::report
