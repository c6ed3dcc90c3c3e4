#include "geometry/inflated.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "core/error.h"
#include "tests/geometry/test_solids.h"

namespace understudy::geometry {
namespace {

using ::testing::HasSubstr;

Mesh mesh_of(const Triangles& t) { return {t.vertices, t.triangles}; }

TEST(Inflated, ABoxGrowsByTheDepthAndStandsWhereItStood) {
  const auto larger = inflated(mesh_of(box(Vec3(-5, -4, 2), Vec3(5, 4, 8))), 0.7);
  EXPECT_LE((larger->lower() - Vec3(-5.7, -4.7, 2)).norm(), 1e-12);
  EXPECT_LE((larger->upper() - Vec3(5.7, 4.7, 8.7)).norm(), 1e-12);
  EXPECT_NEAR(larger->volume(), 11.4 * 9.4 * 6.7, 1e-9);
  EXPECT_EQ(larger->open_edges(), 0);
}

// Facets move out by the depth: an n-gon stays one, whose inscribed circle is larger by it.
TEST(Inflated, ACylinderGrowsAlongItsNormalsNotByAScale) {
  constexpr int kFacets = 24;
  Triangles t = cylinder(10, 6, kFacets);
  const auto larger = inflated(mesh_of(t), 0.5);
  const double inner = 10 * std::cos(std::numbers::pi / kFacets) + 0.5;
  const double area = kFacets * inner * inner * std::tan(std::numbers::pi / kFacets);
  EXPECT_NEAR(larger->volume(), area * 6.5, 1e-9) << "its foot stays, its top rises";
}

TEST(Inflated, AHoleGetsNarrower) {
  // A box within a box, wound the other way: a cavity.
  Triangles t = box(Vec3(0, 0, 0), Vec3(10, 10, 10)), hole = box(Vec3(3, 3, 3), Vec3(7, 7, 7));
  for (const auto& [a, b, c] : hole.triangles) t.triangles.push_back({8 + a, 8 + c, 8 + b});
  t.vertices.insert(t.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  EXPECT_NEAR(inflated(mesh_of(t), 0.5)->volume(), 11 * 11 * 10.5 - 27, 1e-9);
  try {
    (void)inflated(mesh_of(t), 2.5);
    FAIL() << "the cavity would be turned inside out";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the part is hollow"));
  }
}

TEST(Inflated, RefusesDepthsAndMeshesThatHaveNoOutside) {
  Triangles t = box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  for (const double depth : {0.0, -1.0, std::nan("")})
    EXPECT_THROW(inflated(mesh_of(t), depth), InputError) << depth;
  t.triangles.pop_back();
  EXPECT_THROW(inflated(mesh_of(t), 0.1), InputError);
}

}  // namespace
}  // namespace understudy::geometry
