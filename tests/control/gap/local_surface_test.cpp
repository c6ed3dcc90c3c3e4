#include "control/gap/local_surface.h"

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/geometry/test_solids.h"

namespace understudy::control {
namespace {

geometry::Mesh mesh_of(const geometry::Triangles& t) { return {t.vertices, t.triangles}; }

/// Its top is z = 0.
geometry::Mesh plate() { return mesh_of(geometry::box({-30e-3, -30e-3, -10e-3}, {30e-3, 30e-3, 0})); }

/// The tip at `p`, the tool's axis turned away from z by a rotation vector [rad].
Pose tool_at(const Vec3& p, const Vec3& turn = Vec3::Zero()) { return make_pose(exp_rotation(turn), p); }

/// The tool's axis along x.
Pose sideways_at(const Vec3& p) { return tool_at(p, {0, std::numbers::pi / 2, 0}); }

std::string refusal(const geometry::Mesh& part, const Pose& X_WT) {
  EXPECT_FALSE(find_local_surface(part, X_WT));
  try {
    local_surface(part, X_WT);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LocalSurface, OfAPlaneIsTheSlopeSeenFromTheTool) {
  const geometry::Mesh part = plate();
  for (const double degrees : {0.0, 10.0, -30.0, 44.0}) {
    // z_W = 0 in T: sin(a) y + cos(a) z = 0 for a tool turned by a about x.
    const double a = from_deg(degrees);
    const LocalSurface found = local_surface(part, tool_at(Vec3::Zero(), {a, 0, 0}));
    EXPECT_NEAR(found.slope.x(), 0, 1e-12);
    EXPECT_NEAR(found.slope.y(), -std::tan(a), 1e-12) << degrees;
    EXPECT_NEAR(found.curvature.norm(), 0, 1e-6);  // [1/m]: rounding by the square of 2.5 mm
  }
}

TEST(LocalSurface, OfABallIsCurvedAlikeAllAroundAndTheSameAlongTheAxis) {
  const double radius = 40e-3;
  const geometry::Mesh part = mesh_of(geometry::sphere(radius, 300, 600));
  for (const double height : {0.0, 1e-3, -0.5e-3}) {
    const LocalSurface found = local_surface(part, sideways_at({radius + height, 0, 0}));
    EXPECT_NEAR(found.curvature(0, 0), -1 / radius, 0.01 / radius);
    EXPECT_NEAR(found.curvature(1, 1), -1 / radius, 0.01 / radius);
    EXPECT_NEAR(found.curvature(0, 1), 0, 0.01 / radius);
  }
}

TEST(LocalSurface, HeightIsAlongTheToolsAxis) {
  const geometry::Mesh part = plate();
  EXPECT_NEAR(*height_over(part, tool_at({0, 0, 3e-3})), 3e-3, 1e-12);
  EXPECT_NEAR(*height_over(part, tool_at({0, 0, -1e-3})), -1e-3, 1e-12) << "the tip is inside";
  EXPECT_NEAR(*height_over(part, tool_at({0, 0, 3e-3}, {from_deg(60), 0, 0})), 6e-3, 1e-12);
  EXPECT_TRUE(height_over(part, tool_at({0, 0, 19.9e-3})));
  EXPECT_FALSE(height_over(part, tool_at({0, 0, 20.1e-3})));
  EXPECT_FALSE(height_over(part, tool_at({31e-3, 0, 1e-3})));
}

TEST(LocalSurface, RefusesToGuessWhereThePartEndsOrHasAStep) {
  const geometry::Mesh part = plate();
  EXPECT_THAT(refusal(part, tool_at({0, 0, 25e-3})),
              testing::HasSubstr("does not meet the part within 20 mm"));
  EXPECT_THAT(refusal(part, tool_at({29.9e-3, 0, 0})), testing::HasSubstr("the part ends within 2.5 mm"));
  EXPECT_TRUE(find_local_surface(part, tool_at({28e-3, 0, 0}))) << "5 % of the disc are beyond the edge";

  const geometry::Mesh stepped = mesh_of(geometry::boxes(
      {{{-30e-3, -30e-3, -10e-3}, {0, 30e-3, 0}}, {{0, -30e-3, -10e-3}, {30e-3, 30e-3, 0.3e-3}}}));
  EXPECT_THAT(refusal(stepped, tool_at({0.1e-3, 0, 0.3e-3})),
              testing::HasSubstr("um RMS off a smooth surface"));
  EXPECT_TRUE(find_local_surface(stepped, tool_at({3e-3, 0, 0.3e-3}))) << "the step is out of the disc";
}

}  // namespace
}  // namespace understudy::control
