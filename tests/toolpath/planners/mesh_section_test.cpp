#include "toolpath/planners/mesh_section.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "tests/geometry/test_solids.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;

Mesh mesh_of(const geometry::Triangles& t) { return {t.vertices, t.triangles}; }

/// Seen from the tip of `normal`: positive where it runs counter-clockwise.
double enclosed_area(const SectionLine& line, const Vec3& normal) {
  Vec3 twice = Vec3::Zero();
  for (std::size_t i = 1; i < line.points.size(); ++i) twice += line.points[i - 1].cross(line.points[i]);
  return twice.dot(normal) / 2;
}

TEST(MeshSection, OfABoxIsARectangleWithTheMaterialOnItsLeft) {
  const Mesh box = mesh_of(geometry::box(Vec3(0, 0, 0), Vec3(4, 3, 2)));
  const auto lines = section_lines(box, Vec3(0, 0, 0.7), Vec3::UnitZ());
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].closed());
  EXPECT_NEAR(enclosed_area(lines[0], Vec3::UnitZ()), 12, 1e-12);
  for (const Vec3& p : lines[0].points) EXPECT_NEAR(p.z(), 0.7, 1e-15);
}

TEST(MeshSection, EachPairOfPointsLiesOnItsTriangle) {
  const Mesh ball = mesh_of(geometry::sphere(1, 20, 40));
  for (const SectionLine& line : section_lines(ball, Vec3(0.1, 0.2, 0.3), Vec3(1, 2, 2).normalized())) {
    ASSERT_EQ(line.triangles.size() + 1, line.points.size());
    for (std::size_t i = 0; i < line.triangles.size(); ++i) {
      const auto& t = ball.triangles()[static_cast<std::size_t>(line.triangles[i])];
      const auto at = [&](std::size_t k) { return ball.vertices()[static_cast<std::size_t>(t[k])]; };
      const Vec3 n = (at(1) - at(0)).cross(at(2) - at(0)).normalized();
      EXPECT_NEAR(n.dot(line.points[i] - at(0)), 0, 1e-14);
      EXPECT_NEAR(n.dot(line.points[i + 1] - at(0)), 0, 1e-14);
    }
  }
}

TEST(MeshSection, OfASphereHasTheAreaOfItsCircle) {
  const Mesh ball = mesh_of(geometry::sphere(1, 90, 180));
  Random random(5, "sections");
  for (int n = 0; n < 50; ++n) {
    const Vec3 normal = normal_vec3(random).normalized();
    const double height = random.uniform(-0.9, 0.9);
    const auto lines = section_lines(ball, height * normal, normal);
    ASSERT_EQ(lines.size(), 1u);
    // Facets of 2 degrees lie up to 1.5e-4 and, across their diagonals, 3e-4 inside.
    EXPECT_NEAR(enclosed_area(lines[0], normal), std::numbers::pi * (1 - height * height), 3e-3);
  }
}

TEST(MeshSection, ABoxWithinABoxHasOneLineEach) {
  geometry::Triangles both = geometry::box(Vec3(-2, -2, -2), Vec3(2, 2, 2));
  const geometry::Triangles hole = geometry::box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  for (const auto& t : hole.triangles) both.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  both.vertices.insert(both.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  const auto lines = section_lines(mesh_of(both), Vec3::Zero(), Vec3::UnitZ());
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_NEAR(enclosed_area(lines[0], Vec3::UnitZ()) + enclosed_area(lines[1], Vec3::UnitZ()), 16 - 4, 1e-12)
      << "the hole runs clockwise";
}

TEST(MeshSection, APlaneThroughVerticesCutsOnceAndOneThatMissesNotAtAll) {
  const Mesh box = mesh_of(geometry::box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  EXPECT_EQ(section_lines(box, Vec3(0, 0, 1), Vec3::UnitZ()).size(), 1u)
      << "vertices on the plane are above it";
  EXPECT_TRUE(section_lines(box, Vec3(0, 0, 0), Vec3::UnitZ()).empty());
  EXPECT_TRUE(section_lines(box, Vec3(0, 0, 2), Vec3::UnitZ()).empty());
}

}  // namespace
}  // namespace understudy::toolpath
