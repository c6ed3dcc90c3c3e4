#include "toolpath/finishing/outline_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/units.h"
#include "tests/geometry/test_solids.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;

TEST(OutlinePlaces, GoRoundABoxAndTurnInItsCorners) {
  const auto t = geometry::box(from_mm(1) * Vec3(-10, -6, 0), from_mm(1) * Vec3(10, 6, 10));
  const Mesh mesh(t.vertices, t.triangles);
  const auto outlines = outlines_at(mesh, from_mm(5), from_mm(0.5), from_mm(0.25));
  ASSERT_EQ(outlines.size(), 1u);
  const auto& places = outlines[0].places;
  double length = 0, turn = 0, largest = 0;
  int corners = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto &a = places[i], &b = places[(i + 1) % places.size()];
    const double way = (b.position - a.position).norm();
    length += way;
    largest = std::max(largest, way);
    const double angle = std::acos(std::clamp(a.normal.dot(b.normal), -1.0, 1.0));
    turn += angle;
    EXPECT_LE(angle, kCornerTurn + 1e-6);
    EXPECT_TRUE(angle < 1e-3 || way < 1e-12) << "it turns in place";
    corners += std::abs(std::abs(a.position.x()) - from_mm(10)) < 1e-9 &&
               std::abs(std::abs(a.position.y()) - from_mm(6)) < 1e-9;
    EXPECT_NEAR(mesh.signed_distance(a.position), 0, 1e-12);
  }
  EXPECT_NEAR(to_mm(length), 64, 1e-9);
  EXPECT_NEAR(turn, 2 * std::numbers::pi, 1e-6);
  EXPECT_LE(to_mm(largest), 0.5 + 1e-9);
  EXPECT_EQ(corners, 4 * (90 / 5 + 1));
}

TEST(OutlinePlaces, OfATubeAreOutlineAndHole) {
  auto outer = geometry::box(from_mm(1) * Vec3(-10, -10, 0), from_mm(1) * Vec3(10, 10, 10));
  const auto inner = geometry::box(from_mm(1) * Vec3(-5, -5, 2), from_mm(1) * Vec3(5, 5, 8));
  for (const auto& [a, b, c] : inner.triangles) outer.triangles.push_back({8 + a, 8 + c, 8 + b});
  outer.vertices.insert(outer.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  const Mesh mesh(outer.vertices, outer.triangles);
  EXPECT_EQ(outlines_at(mesh, from_mm(5), from_mm(1), from_mm(0.25)).size(), 2u);
  EXPECT_EQ(outlines_at(mesh, from_mm(9), from_mm(1), from_mm(0.25)).size(), 1u);
  EXPECT_TRUE(outlines_at(mesh, from_mm(11), from_mm(1), from_mm(0.25)).empty());
}

}  // namespace
}  // namespace understudy::toolpath
