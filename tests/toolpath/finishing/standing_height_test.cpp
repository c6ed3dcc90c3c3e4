#include "toolpath/finishing/standing_height.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "tests/geometry/test_solids.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;
using geometry::Triangles;

// The slow way: points of the mesh by the ten thousand.
double highest_of_points(const Mesh& mesh, const Vec3& p, const Vec3& axis, double radius) {
  double highest = -1e9;
  constexpr int kParts = 120;
  for (const auto& t : mesh.triangles())
    for (int i = 0; i <= kParts; ++i)
      for (int j = 0; i + j <= kParts; ++j) {
        const double u = double(i) / kParts, v = double(j) / kParts;
        const auto at = [&](std::size_t k) { return mesh.vertices()[static_cast<std::size_t>(t[k])]; };
        const Vec3 way = (1 - u - v) * at(0) + u * at(1) + v * at(2) - p;
        const double along = way.dot(axis);
        if ((way - along * axis).norm() <= radius) highest = std::max(highest, along);
      }
  return highest;
}

TEST(StandingHeight, AgreesWithPointsOnRandomTriangles) {
  Random random(61, "standing height");
  const auto vector = [&] {
    return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  for (int n = 0; n < 60; ++n) {
    const Mesh mesh({vector(), vector(), vector()}, {{0, 1, 2}});
    const Vec3 p = 0.5 * vector(), axis = vector().normalized();
    const double radius = random.uniform(0.2, 1.5);
    const double points = highest_of_points(mesh, p, axis, radius);
    const double exact = StandingHeight(mesh).of(p, axis, radius, -1e9);
    if (points < -1e8) continue;  // between the points
    EXPECT_GE(exact, points - 1e-12) << n;
    EXPECT_LE(exact, points + 0.1) << n << ": one part in 120 of a triangle, along a slope";
  }
}

// r - sqrt(r^2 - R^2): a flat face over a hollow of radius r rests on its rim.
TEST(StandingHeight, AFaceRestsOnItsRimInAHollow) {
  Triangles tube = geometry::cylinder(10, 40, 720);
  for (auto& t : tube.triangles) std::swap(t[0], t[1]);
  const Mesh mesh(tube.vertices, tube.triangles);
  const double height = StandingHeight(mesh).of(Vec3(10, 0, 0), -Vec3::UnitX(), 1.5, 0);
  EXPECT_NEAR(height, 20, 1e-2) << "the other wall is in the way of an endless tool";
  // Of the near wall only: cut off the far half.
  std::vector<std::array<int, 3>> near;
  for (const auto& t : tube.triangles)
    if (tube.vertices[static_cast<std::size_t>(t[0])].x() > 5 &&
        tube.vertices[static_cast<std::size_t>(t[1])].x() > 5 &&
        tube.vertices[static_cast<std::size_t>(t[2])].x() > 5)
      near.push_back(t);
  const Mesh half(tube.vertices, near);
  EXPECT_NEAR(StandingHeight(half).of(Vec3(10, 0, 0), -Vec3::UnitX(), 1.5, 0), 10 - std::sqrt(100 - 2.25),
              2e-4);
}

TEST(StandingHeight, NothingAboveIsTheLeast) {
  const Triangles t = geometry::box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const Mesh mesh(t.vertices, t.triangles);
  const StandingHeight height(mesh);
  EXPECT_NEAR(height.of(Vec3(1, 0, 0), Vec3::UnitX(), 0.3, 0), 0, 1e-15) << "a flat side touches";
  EXPECT_EQ(height.of(Vec3(3, 0, 0), Vec3::UnitX(), 0.3, 0.25), 0.25) << "behind";
  EXPECT_NEAR(height.of(Vec3(-3, 0, 0), Vec3::UnitX(), 0.3, 0), 4, 1e-12) << "its far side";
  // Beside by less than the radius: the corner.
  EXPECT_NEAR(height.of(Vec3(0, 1.2, -2), Vec3::UnitZ(), 0.3, 0), 3, 1e-12);
  EXPECT_EQ(height.of(Vec3(0, 1.4, -2), Vec3::UnitZ(), 0.3, 0), 0);
}

}  // namespace
}  // namespace understudy::toolpath
