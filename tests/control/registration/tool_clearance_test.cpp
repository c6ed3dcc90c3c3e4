#include "control/registration/tool_clearance.h"

#include <limits>

#include <gtest/gtest.h>

#include "tests/control/gap/bead_program.h"
#include "tests/geometry/test_solids.h"

namespace understudy::control {
namespace {

using geometry::Shape;

double distance(const Shape& body, const Vec3& p) { return distance_to(body, p); }

TEST(ToolClearance, DistancesOfBodiesAreThoseOfTheirGeometry) {
  const Shape cylinder{"", geometry::Cylinder{3, 4}};
  EXPECT_DOUBLE_EQ(distance(cylinder, {5, 0, 0}), 2);
  EXPECT_DOUBLE_EQ(distance(cylinder, {0, 0, 7}), 5);
  EXPECT_DOUBLE_EQ(distance(cylinder, {6, 0, 6}), 5);  // 3 beside and 4 above the rim
  EXPECT_DOUBLE_EQ(distance(cylinder, {1, 0, 0}), -2);
  const Shape box{"", geometry::Box{{2, 4, 6}}};
  EXPECT_DOUBLE_EQ(distance(box, {4, 6, 0}), 5);
  EXPECT_DOUBLE_EQ(distance(box, {0, 0, 0}), -1);
  // A cone of 45 degrees from the tip: the point at (2, 0) is sqrt(2) from it.
  const Shape cone{"", geometry::Frustum{0, 10, 10}};
  EXPECT_NEAR(distance(cone, {3, 0, 1}), std::sqrt(2), 1e-12);
  EXPECT_NEAR(distance(cone, {0, 0, -2}), 2, 1e-12);
  EXPECT_DOUBLE_EQ(distance({"", geometry::Capsule{1, 4}}, {3, 0, 5}), std::hypot(3, 3) - 1);
  EXPECT_DOUBLE_EQ(distance({"", geometry::Sphere{2}, make_pose(Quat::Identity(), Vec3(1, 0, 0))}, {4, 4, 0}),
                   3);
}

TEST(ToolClearance, CoversABoxEverywhere) {
  const auto box = geometry::box(Vec3::Zero(), Vec3(10e-3, 20e-3, 5e-3));
  const geometry::Mesh mesh(box.vertices, box.triangles);
  const auto points = cover(mesh, 1e-3);
  for (double x = 0; x <= 10e-3; x += 0.7e-3)
    for (double y = 0; y <= 20e-3; y += 0.9e-3) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Vec3& p : points) nearest = std::min(nearest, (p - Vec3(x, y, 5e-3)).norm());
      ASSERT_LT(nearest, 2e-3) << x << " " << y;
    }
}

// The hexapod's nozzle is a cone from 0.5 mm at the tip to 3.5 mm at 12 mm; its platform is a disc of 33 mm
// radius 25 mm above the tip.
TEST(ToolClearance, IsThatOfTheNearestBodyToPartAndTable) {
  const auto& machine = hexapod();
  const Pose X_WT = make_pose(Quat::Identity(), Vec3(0, 0, 40e-3));
  EXPECT_NEAR(tool_clearance(machine, {}, X_WT, 0), 40e-3, 1e-9) << "to the table";
  EXPECT_NEAR(tool_clearance(machine, {Vec3(30e-3, 0, 60e-3)}, X_WT, 0), 5e-3, 1e-9) << "below the platform";
  EXPECT_NEAR(tool_clearance(machine, {Vec3(0, 0, 39e-3)}, X_WT, 0), 1e-3, 1e-9) << "below the tip";
  EXPECT_NEAR(tool_clearance(machine, {Vec3(0, 0, 39e-3)}, X_WT, 3e-3), 40e-3, 1e-9) << "at the tip";
  // Leaning by 30 degrees lowers the platform's rim by 33 mm sin(30) to 40 + 25 cos(30) - 16.5 mm.
  const Pose leaning = make_pose(exp_rotation(Vec3(std::numbers::pi / 6, 0, 0)), Vec3(0, 0, 20e-3));
  EXPECT_LT(tool_clearance(machine, {}, leaning, 0), 20e-3);
}

}  // namespace
}  // namespace understudy::control
