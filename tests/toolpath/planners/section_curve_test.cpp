#include "toolpath/planners/section_curve.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/geometry/test_solids.h"
#include "toolpath/polyline.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;
using geometry::Triangles;

Mesh mesh_of(const Triangles& t) { return {t.vertices, t.triangles}; }

// A cylinder lying along y, as the axis of test_solids is z.
Mesh lying_cylinder(double radius, double length, int facets) {
  Triangles t = geometry::cylinder(radius, length, facets);
  for (Vec3& v : t.vertices) v = Vec3(v.x(), -v.z(), v.y());
  return mesh_of(t);
}

TEST(SectionCurve, OfACylinderIsTheUpperHalfOfItsPolygonFromMinusXToPlusX) {
  const double radius = 0.0155;
  const int facets = 360;
  const auto curve =
      section_curve(lying_cylinder(radius, 0.07, facets), Vec3(0, 0.003, 0), Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_NEAR(curve.front().x(), -radius, 1e-12);
  EXPECT_NEAR(curve.back().x(), radius, 1e-12);
  for (const Vec3& p : curve) {
    EXPECT_NEAR(p.y(), 0.003, 1e-15);
    EXPECT_GE(p.z(), -1e-15);
    EXPECT_LE(p.norm(), std::hypot(radius, 0.003) + 1e-15);
  }
  // Perimeter of half the regular polygon.
  EXPECT_NEAR(polyline_length(curve), facets * radius * std::sin(std::numbers::pi / facets), 1e-12);
}

TEST(SectionCurve, ThroughVerticesHasNoGapAndNoRepeat) {
  // The plane y = 0 runs along a ring of vertices.
  Triangles t = geometry::revolve({{-1, 0}, {-1, 1}, {0, 1}, {1, 1}, {1, 0}}, 24);
  for (Vec3& v : t.vertices) v = Vec3(v.x(), -v.z(), v.y());
  const auto curve = section_curve(mesh_of(t), Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_NEAR(polyline_length(curve), 24 * std::sin(std::numbers::pi / 24), 1e-12);
  for (std::size_t i = 1; i < curve.size(); ++i) EXPECT_GT((curve[i] - curve[i - 1]).norm(), 0);
}

TEST(SectionCurve, OfABoxIsTheEdgeOfTheSideThatFacesUp) {
  const Mesh box = mesh_of(geometry::box(Vec3(-2, -1, 0), Vec3(2, 1, 1)));
  const auto top = section_curve(box, Vec3(0, 0.3, 0), Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_NEAR(polyline_length(top), 4, 1e-14);
  for (const Vec3& p : top) EXPECT_EQ(p.z(), 1);
  const auto side = section_curve(box, Vec3(0, 0.3, 0), Vec3::UnitY(), Vec3::UnitX());
  EXPECT_NEAR(polyline_length(side), 1, 1e-14);
}

TEST(SectionCurve, OfAnOpenSheetRunsFromBorderToBorder) {
  const Mesh sheet({Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)}, {{0, 1, 2}, {0, 2, 3}});
  const auto curve = section_curve(sheet, Vec3(0, 0.25, 0), Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_NEAR((curve.front() - Vec3(-1, 0.25, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((curve.back() - Vec3(1, 0.25, 0)).norm(), 0, 1e-15);
}

TEST(SectionCurve, SaysWhenThePlaneMissesOrNothingFacesUp) {
  const Mesh box = mesh_of(geometry::box(Vec3(-2, -1, 0), Vec3(2, 1, 1)));
  EXPECT_THROW(section_curve(box, Vec3(0, 5, 0), Vec3::UnitY(), Vec3::UnitZ()), InputError);
  EXPECT_THROW(section_curve(box, Vec3(0, 0.3, 0), Vec3::UnitY(), Vec3::UnitY()), InputError);
}

}  // namespace
}  // namespace understudy::toolpath
