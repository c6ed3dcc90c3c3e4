#include "geometry/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "geometry/shape.h"
#include "tests/geometry/test_solids.h"

namespace understudy::geometry {
namespace {

using ::testing::HasSubstr;

std::string rejection(const Triangles& t) {
  try {
    const Mesh mesh(t.vertices, t.triangles);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Mesh, RejectsWhatIsNoSurfaceAndSaysWhy) {
  EXPECT_THAT(rejection({}), HasSubstr("no triangle"));
  Triangles t = box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  t.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(rejection(t), HasSubstr("vertex 3 is (1, nan, 0), not finite"));
  t = box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  t.triangles[5][2] = 8;
  EXPECT_THAT(rejection(t), HasSubstr("triangle 5 uses vertex 8, and there are 8"));
  t.triangles[5] = {1, 2, 1};
  EXPECT_THAT(rejection(t), HasSubstr("triangle 5 uses a vertex twice"));
  const Triangles line{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, {{0, 1, 2}}};
  EXPECT_THAT(rejection(line), HasSubstr("no triangle with an area"));
}

TEST(Mesh, CountsOpenAndFlippedEdges) {
  Triangles t = box(Vec3(0, 0, 0), Vec3(1, 2, 3));
  EXPECT_EQ(Mesh(t.vertices, t.triangles).open_edges(), 0);
  EXPECT_EQ(Mesh(t.vertices, t.triangles).flipped_edges(), 0);
  std::swap(t.triangles[4][0], t.triangles[4][1]);
  EXPECT_EQ(Mesh(t.vertices, t.triangles).flipped_edges(), 3);
  t.triangles.erase(t.triangles.begin() + 4);
  EXPECT_EQ(Mesh(t.vertices, t.triangles).open_edges(), 3);
  // A fin: its edge on the box has three triangles, its two others one each.
  t = box(Vec3(0, 0, 0), Vec3(1, 2, 3));
  t.vertices.push_back(Vec3(5, 5, 5));
  t.triangles.push_back({0, 1, 8});
  EXPECT_EQ(Mesh(t.vertices, t.triangles).open_edges(), 3);
}

TEST(Mesh, NeighboursLieAcrossEachEdge) {
  const Triangles t = sphere(1, 6, 9);
  const Mesh mesh(t.vertices, t.triangles);
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto other = static_cast<std::size_t>(mesh.neighbours()[i][k]);
      const Vec3 a = t.vertices[static_cast<std::size_t>(t.triangles[i][k])];
      const Vec3 b = t.vertices[static_cast<std::size_t>(t.triangles[i][(k + 1) % 3])];
      int shared = 0;
      for (const int v : mesh.triangles()[other]) {
        const Vec3& p = mesh.vertices()[static_cast<std::size_t>(v)];
        shared += p == a || p == b;
      }
      EXPECT_EQ(shared, 2);
    }
  }
}

TEST(Mesh, VolumeAndBoundsAreThoseOfTheSolid) {
  const Vec3 lower(10, -4, 2), upper(11, -2, 5);
  Triangles t = box(lower, upper);
  const Mesh solid(t.vertices, t.triangles);
  EXPECT_NEAR(solid.volume(), 6, 1e-14);
  EXPECT_EQ(solid.lower(), lower);
  EXPECT_EQ(solid.upper(), upper);
  for (auto& triangle : t.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_NEAR(Mesh(t.vertices, t.triangles).volume(), -6, 1e-14);
}

TEST(Mesh, CreasesKeepSeparateNormalsAndSmoothEdgesShareThem) {
  const Triangles cube = box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const Mesh sharp(cube.vertices, cube.triangles);
  EXPECT_EQ(sharp.vertices().size(), 24u);  // three faces at each of eight corners
  for (const Vec3& n : sharp.vertex_normals()) EXPECT_EQ(n.cwiseAbs().maxCoeff(), 1);
  const Triangles ball = sphere(1, 12, 24);  // 15 deg a facet
  const Mesh smooth(ball.vertices, ball.triangles);
  ASSERT_EQ(smooth.vertices().size(), ball.vertices.size());
  for (std::size_t v = 0; v < ball.vertices.size(); ++v) EXPECT_EQ(smooth.vertices()[v], ball.vertices[v]);
}

TEST(Mesh, NormalsDoNotDependOnHowAFlatFaceIsCut) {
  // A low pyramid over a square, its base corners seen by one triangle or by two.
  for (const bool other_diagonal : {false, true}) {
    Triangles t = box(Vec3(-1, -1, 0), Vec3(1, 1, 0.1));
    for (int i = 4; i < 8; ++i) t.vertices[static_cast<std::size_t>(i)].head<2>() *= 0.5;  // sloping sides
    if (other_diagonal) {
      t.triangles[2] = {4, 5, 6};
      t.triangles[3] = {5, 7, 6};
    }
    const Mesh mesh(t.vertices, t.triangles);
    const Vec3 corner = mesh.nearest(Vec3(0.5, 0.5, 0.2)).normal;
    EXPECT_NEAR(corner.x(), corner.y(), 1e-12) << other_diagonal;  // the solid is symmetric in x and y
  }
}

TEST(Mesh, ATriangleWithoutAreaDoesNotDisturbItsNeighbours) {
  Triangles t = box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  // Split edge 0-1 on one side only: the sliver (0, 8, 1) closes the surface.
  t.vertices.push_back(Vec3(0.5, 0, 0));
  t.triangles[1] = {0, 3, 8};
  t.triangles.push_back({8, 3, 1});
  t.triangles.push_back({0, 8, 1});
  const Mesh mesh(t.vertices, t.triangles);
  EXPECT_EQ(mesh.open_edges(), 0);
  EXPECT_EQ(mesh.flipped_edges(), 0);
  EXPECT_EQ(mesh.nearest(Vec3(0.5, 0.1, -1)).normal, Vec3(0, 0, -1));
  EXPECT_EQ(mesh.nearest(Vec3(0.5, -1, 0.1)).normal, Vec3(0, -1, 0));
  EXPECT_NEAR(mesh.signed_distance(Vec3(0.5, -1, -1)), std::sqrt(2.0), 1e-15);
}

TEST(Shape, CapsuleSpansItsTwoPoints) {
  const Vec3 a(0.1, -0.2, 0.3), b(-0.4, 0.1, -0.5);
  const Shape shape = capsule_between("strut", a, b, 0.004);
  const auto& capsule = std::get<Capsule>(shape.form);
  EXPECT_NEAR(capsule.length, (b - a).norm(), 1e-15);
  EXPECT_LT((shape.X_FS * Vec3(0, 0, -capsule.length / 2) - a).norm(), 1e-15);
  EXPECT_LT((shape.X_FS * Vec3(0, 0, capsule.length / 2) - b).norm(), 1e-15);
  EXPECT_EQ(capsule_between("dot", a, a, 0.004).X_FS.translation(), a);
}

}  // namespace
}  // namespace understudy::geometry
