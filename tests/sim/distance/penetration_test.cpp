#include "sim/distance/penetration.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "geometry/mesh.h"
#include "sim/distance/convex_solid.h"
#include "tests/geometry/test_solids.h"
#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::sim {
namespace {

using geometry::Shape;

const Pose kHere = Pose::Identity();
Pose at(double x, double y, double z) { return make_pose(Quat::Identity(), Vec3(x, y, z)); }
Shape ball(double radius) { return {"ball", geometry::Sphere{radius}, kHere}; }
Shape cube(double side) { return {"cube", geometry::Box{Vec3(side, side, side)}, kHere}; }

Shape mesh_cube(double half, bool open = false) {
  auto t = geometry::box(Vec3(-half, -half, -half), Vec3(half, half, half));
  if (open) t.triangles.pop_back();
  return {"mesh", geometry::MeshShape{std::make_shared<geometry::Mesh>(t.vertices, t.triangles)}, kHere};
}

TEST(Penetration, OfTwoBallsIsTheSumOfTheirRadiiLessTheDistanceOfTheirCentres) {
  EXPECT_NEAR(penetration(ball(2), at(1, 0, 0), ball(1), at(3.5, 0, 0)).depth, 0.5, 1e-15);
  EXPECT_EQ(penetration(ball(2), at(1, 0, 0), ball(1), at(4.5, 0, 0)).depth, 0) << "apart";
}

TEST(Penetration, OfACubeOnACubeIsTheHeightThatTheyShare) {
  // Corners of the one in the face of the other.
  const Penetration p = penetration(cube(2), kHere, cube(4), at(0, 0, -2.75));
  EXPECT_NEAR(p.depth, 0.25, 1e-15);
  EXPECT_NEAR(p.place_W.z(), -1, 1e-15) << "on the upper cube's lower face";
}

TEST(Penetration, IsTheSameWhicheverBodyComesFirst) {
  const Pose X = make_pose(exp_rotation(Vec3(0.3, 0.2, 0.1)), Vec3(0.4, 0.3, 1.2));
  EXPECT_EQ(penetration(cube(2), kHere, ball(0.7), X).depth, penetration(ball(0.7), X, cube(2), kHere).depth);
}

TEST(Penetration, OfAMeshIsThatOfTheSolidThatItBounds) {
  EXPECT_NEAR(penetration(ball(0.5), at(0, 0, 1.25), mesh_cube(1), kHere).depth, 0.25, 1e-12);
  EXPECT_EQ(penetration(ball(0.5), at(0, 0, 1.25), mesh_cube(1, true), kHere).depth, 0)
      << "an open mesh has no inside";
}

/// Over all points that the header names, one by one.
double deepest_of_all(const Shape& solid, const Pose& X_WS, const geometry::Mesh& mesh) {
  const ConvexSolid body = *convex_solid(solid);
  double depth = 0;
  for (const Ball& ball : surface_balls(body))
    depth = std::max(depth, ball.radius - mesh.signed_distance(X_WS * ball.centre));
  for (const Vec3& v : mesh.vertices())
    depth = std::max(depth, -signed_distance(body, X_WS.inverse(Eigen::Isometry) * v));
  return depth;
}

TEST(Penetration, IsThatOfTheDeepestOfAllPoints) {
  const auto part = test::bottle_mesh(Vec3::Zero(), 15.5e-3, 0.08, 96, 12);
  const Shape bottle{"part", geometry::MeshShape{part}, kHere};
  Random random(5, "penetration");
  int deep = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose X = make_pose(exp_rotation(0.5 * uniform_vec3(random, 1)),
                             Vec3(15.5e-3, 0, 0) + 4e-3 * uniform_vec3(random, 1));
    for (const Shape& solid : {Shape{"nozzle", geometry::Frustum{0.5e-3, 3.5e-3, 6e-3}, kHere},
                               Shape{"strut", geometry::Capsule{1e-3, 6e-3}, kHere},
                               Shape{"block", geometry::Box{Vec3(6e-3, 4e-3, 3e-3)}, kHere}}) {
      const double depth = penetration(solid, X, bottle, kHere).depth;
      EXPECT_NEAR(depth, deepest_of_all(solid, X, *part), 1e-15) << solid.name << " " << i;
      deep += depth > 0.1e-3;
    }
  }
  EXPECT_GT(deep, 100);
}

TEST(Penetration, APointIsInsideABodyOrNot) {
  EXPECT_TRUE(contains(cube(2), Vec3(0.9, 0.9, 0.9)));
  EXPECT_FALSE(contains(cube(2), Vec3(0.9, 0.9, 1.1)));
  EXPECT_TRUE(contains(mesh_cube(1), Vec3(0.9, 0.9, 0.9)));
  EXPECT_FALSE(contains(mesh_cube(1, true), Vec3(0.9, 0.9, 0.9)));
  for (const Shape& shape : {ball(1), cube(2)}) EXPECT_TRUE(contains(shape, point_of(shape)));
}

}  // namespace
}  // namespace understudy::sim
