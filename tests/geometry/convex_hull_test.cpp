#include "geometry/convex_hull.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "core/random.h"
#include "geometry/mesh.h"
#include "tests/complaint.h"
#include "tests/geometry/test_solids.h"
#include "tests/temporary_folder.h"

namespace understudy::geometry {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string complaint(const std::vector<Vec3>& points) {
  try {
    convex_hull(points, "mesh a.stl");
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(ConvexHull, OfAnLShapeFillsItsCorner) {
  // 2 x 2 x 1 without a quarter: 3. The hull cuts the missing quarter's outer half off: 3 + 0.5.
  const Triangles l = boxes({{Vec3(0, 0, 0), Vec3(2, 1, 1)}, {Vec3(0, 1, 0), Vec3(1, 2, 1)}});
  const auto hull = convex_hull(l.vertices, "l");
  EXPECT_NEAR(hull->volume(), 3.5, 1e-12);
  EXPECT_EQ(hull->open_edges(), 0);
  EXPECT_EQ(hull->flipped_edges(), 0);
}

TEST(ConvexHull, HoldsAllItsPointsAndHasNoOthers) {
  Random random(7, "points of a ball");
  std::vector<Vec3> points;
  for (int i = 0; i < 400; ++i)
    points.push_back(0.1 * Vec3(random.normal(), random.normal(), random.normal()).normalized() *
                     std::cbrt(random.uniform()));
  const auto hull = convex_hull(points, "ball");
  for (const Vec3& p : points) EXPECT_LE(hull->signed_distance(p), 1e-9);
  for (const Vec3& v : hull->vertices())
    EXPECT_TRUE(std::any_of(points.begin(), points.end(), [&](const Vec3& p) { return p == v; }));
}

TEST(ConvexHull, OfNoBodyIsRefused) {
  const Triangles plate = box(Vec3(0, 0, 0), Vec3(0.1, 0.05, 0));
  EXPECT_THAT(complaint(plate.vertices), HasSubstr("mesh a.stl is flat: 100 x 50 x 0 mm, no body"));
  EXPECT_THAT(complaint({}), HasSubstr("has no points"));
  EXPECT_THAT(complaint({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, std::nan(""))}),
              HasSubstr("not finite"));
}

TEST(MeshPoints, OfTextFilesAreInTheFilesUnit) {
  const TemporaryFolder folder;
  write_file(folder / "a.obj", "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 0 0 4\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  const auto hull = convex_hull(read_mesh_points(folder / "a.obj"), "a.obj");
  EXPECT_NEAR(hull->volume(), 2.0 * 3 * 4 / 6, 1e-12);
  EXPECT_LT((hull->upper() - Vec3(2, 3, 4)).norm(), 1e-12);
}

/// A tetrahedron of 0.2 x 0.3 x 0.4 m, in millimetres, with `nodes` under its scene.
std::string collada(const std::string& nodes) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 200 0 0 0 300 0 0 0 400</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 1 3 0 2 3 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">)" +
         nodes + R"(</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";
}

// Collada states its unit and places its parts; robots' files are often in inches or millimetres.
TEST(MeshPoints, OfColladaAreInMetres) {
  const TemporaryFolder folder;
  write_file(folder / "a.dae",
             collada(R"(<node id="n"><translate>1000 0 0</translate><instance_geometry url="#g"/></node>)"));
  const auto hull = convex_hull(read_mesh_points(folder / "a.dae"), "a.dae");
  EXPECT_LT((hull->lower() - Vec3(1, 0, 0)).norm(), 1e-6);
  EXPECT_LT((hull->upper() - Vec3(1.2, 0.3, 0.4)).norm(), 1e-6);
}

// assimp follows nodes in a ring until its stack ends, and gives memory to every vertex that a file promises.
TEST(MeshPoints, OfFilesOnWhichTheImporterFailsAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& content) {
    write_file(folder / name, content);
    return understudy::complaint([&] { read_mesh_points(folder / name); });
  };
  EXPECT_THAT(
      refused("ring.dae",
              collada(R"(<node id="n"><instance_geometry url="#g"/><instance_node url="#n"/></node>)")),
      AllOf(HasSubstr("ring.dae: "), Not(HasSubstr("accepted"))));
  EXPECT_THAT(refused("large.ply",
                      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
                      "property float y\nproperty float z\nend_header\n0000"),
              AllOf(HasSubstr("large.ply: "), Not(HasSubstr("accepted"))));
  EXPECT_THAT(refused("cut.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty flo"),
              HasSubstr("cut.ply: is no PLY, or was cut off"));
  std::string nodes;
  for (int i = 0; i < 10'001; ++i) nodes += R"(<node><instance_geometry url="#g"/></node>)";
  EXPECT_THAT(refused("nodes.dae", collada(nodes)), HasSubstr("nodes.dae: has more than 10000 nodes"));
}

TEST(MeshPoints, OfWhatIsNoMeshAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name) {
    return understudy::complaint([&] { read_mesh_points(folder / name); });
  };
  write_file(folder / "a.step", "ISO-10303-21;");
  write_file(folder / "a.obj", "nothing\n");
  EXPECT_THAT(refused("a.step"), HasSubstr("STL, COLLADA (.dae), OBJ and PLY are"));
  EXPECT_THAT(refused("a.obj"), HasSubstr("a.obj"));
  EXPECT_THAT(refused("missing.stl"), HasSubstr("missing.stl"));
}

}  // namespace
}  // namespace understudy::geometry
