#include "toolpath/finishing/surface_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "tests/geometry/test_solids.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;

// The mesh's own normals are told nothing of the sphere: the fit sees positions.
TEST(SurfaceFit, FindsTheNormalOfASphereBetweenItsVertices) {
  const auto t = geometry::sphere(from_mm(20), 90, 180);  // facets of 2 degrees
  const Mesh mesh(t.vertices, t.triangles);
  for (const double turn : {0.3, 1.13, 2.71}) {
    const Vec3 radial = Vec3(std::cos(turn), std::sin(turn), 0.4).normalized();
    const auto at = mesh.nearest(from_mm(20) * radial);
    const Vec3 n = fitted_normal(mesh, at, from_mm(1.5));
    EXPECT_LE(to_deg(std::acos(std::min(1.0, n.dot(radial)))), 0.35) << turn;
  }
}

TEST(SurfaceFit, PutsRightANormalThatIsSmearedOverAFacet) {
  const auto t = geometry::cylinder(from_mm(10), from_mm(20), 12);  // facets of 30 degrees
  const Mesh mesh(t.vertices, t.triangles);
  // In the middle of a facet the fit sees a plane; the mesh's normals lean with the vertices.
  const double middle = from_deg(15), quarter = from_deg(11);
  for (const double turn : {middle, quarter}) {
    const double across = from_mm(10) * std::cos(from_deg(15)) * std::tan(turn - middle);
    const Vec3 out(std::cos(middle), std::sin(middle), 0), along(-out.y(), out.x(), 0);
    const auto at = mesh.nearest(from_mm(10) * std::cos(from_deg(15)) * out + across * along);
    EXPECT_LE(to_deg(std::acos(std::min(1.0, fitted_normal(mesh, at, from_mm(0.5)).dot(out)))), 1e-3) << turn;
  }
}

TEST(SurfaceFit, AnUprightWallStaysUprightAcrossItsFacets) {
  const auto t = geometry::cylinder(from_mm(10), from_mm(20), 180);
  const Mesh mesh(t.vertices, t.triangles);
  for (const double turn : {0.013, 0.31, 0.785, 1.9, 3.3}) {
    const auto at = mesh.nearest(from_mm(10) * Vec3(std::cos(turn), std::sin(turn), 0.1));
    EXPECT_LE(std::abs(fitted_normal(mesh, at, from_mm(0.25)).z()), 1e-9) << turn;
  }
}

TEST(SurfaceFit, DoesNotLookRoundAnEdge) {
  const auto t = geometry::box(from_mm(1) * Vec3(-5, -5, 0), from_mm(1) * Vec3(5, 5, 10));
  const Mesh mesh(t.vertices, t.triangles);
  const auto at = mesh.nearest(from_mm(1) * Vec3(5, 4.9, 9.9));
  EXPECT_LE((fitted_normal(mesh, at, from_mm(1)) - Vec3::UnitX()).norm(), 1e-9);
}

}  // namespace
}  // namespace understudy::toolpath
