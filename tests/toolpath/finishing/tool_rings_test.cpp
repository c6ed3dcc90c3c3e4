#include "toolpath/finishing/tool_rings.h"

#include <gtest/gtest.h>

namespace understudy::toolpath {
namespace {

TEST(ToolRings, HoldEveryBodyButTheMill) {
  const auto at = [](double x, double z) { return make_pose(Quat::Identity(), Vec3(x, 0, z)); };
  const auto rings = tool_rings({{"mill", geometry::Cylinder{0.0015, 0.03}, at(0, 0.015)},
                                 {"nut", geometry::Frustum{0.008, 0.01, 0.02}, at(0, 0.03)},
                                 {"motor", geometry::Box{Vec3(0.06, 0.08, 0.1)}, at(0, 0.1)},
                                 {"hose", geometry::Cylinder{0.004, 0.05}, at(0.02, 0.075)}},
                                0.0015);
  ASSERT_EQ(rings.size(), 3u);
  EXPECT_EQ(rings[0].name, "nut");
  EXPECT_NEAR(rings[0].radius, 0.01, 1e-12);
  EXPECT_NEAR(rings[0].from, 0.03, 1e-12);
  EXPECT_NEAR(rings[0].to, 0.05, 1e-12);
  EXPECT_NEAR(rings[1].radius, 0.05, 1e-12) << "half the diagonal of 60 by 80 mm";
  EXPECT_NEAR(rings[1].from, 0.05, 1e-12);
  EXPECT_NEAR(rings[2].radius, 0.024, 1e-12) << "beside the axis";
}

}  // namespace
}  // namespace understudy::toolpath
