#include "geometry/normals.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/mesh.h"
#include "geometry/topology.h"
#include "tests/geometry/test_solids.h"

namespace understudy::geometry {
namespace {

TEST(Normals, OfAFacePointToTheSideFromWhichItRunsCounterClockwise) {
  EXPECT_EQ(face_normal(Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 3, 0)), Vec3::UnitZ());
  EXPECT_EQ(face_normal(Vec3(0, 0, 0), Vec3(0, 3, 0), Vec3(2, 0, 0)), -Vec3::UnitZ());
}

TEST(Normals, OfATriangleWithoutAreaAreZero) {
  EXPECT_EQ(face_normal(Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(2, 2, 2)), Vec3::Zero());
  EXPECT_EQ(face_normal(Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)), Vec3::Zero());
}

TEST(Normals, OfABoxAreSplitAtItsEdges) {
  Triangles solid = box(Vec3(0, 0, 0), Vec3(1, 2, 3));
  const Topology topology = find_topology(solid.triangles);
  const auto normals = split_creases(solid.vertices, solid.triangles, topology.neighbours, kCreaseAngle);
  EXPECT_EQ(solid.vertices.size(), 24u) << "each of 8 corners on 3 faces";
  for (const auto& t : solid.triangles)
    for (const int corner : t) {
      const auto at = [&](int k) {
        return solid.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
      };
      EXPECT_LE((normals[static_cast<std::size_t>(corner)] - face_normal(at(0), at(1), at(2))).norm(), 1e-15);
    }
}

TEST(Normals, OfASphereAreRadial) {
  Triangles solid = sphere(2, 60, 120);
  const std::size_t vertices = solid.vertices.size();
  const Topology topology = find_topology(solid.triangles);
  const auto normals = split_creases(solid.vertices, solid.triangles, topology.neighbours, kCreaseAngle);
  ASSERT_EQ(solid.vertices.size(), vertices) << "it has no crease";
  // Facets of 3 degrees; the poles' fans are uneven by as much.
  for (std::size_t i = 0; i < vertices; ++i)
    EXPECT_GT(normals[i].dot(solid.vertices[i].normalized()), std::cos(from_deg(3)));
}

TEST(Normals, PseudoNormalOfABoxsCornerIsTheSumOfItsFacesByTheirAngles) {
  const Triangles solid = box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const auto pseudo = vertex_pseudo_normals(solid.vertices, solid.triangles);
  // Three right angles, however the faces are cut into triangles.
  for (std::size_t i = 0; i < pseudo.size(); ++i)
    EXPECT_LE((pseudo[i] - std::numbers::pi / 2 * solid.vertices[i]).norm(), 1e-14);
}

}  // namespace
}  // namespace understudy::geometry
