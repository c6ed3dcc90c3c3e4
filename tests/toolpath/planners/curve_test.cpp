#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/units.h"
#include "tests/geometry/test_solids.h"
#include "toolpath/planners/surface_planner.h"
#include "toolpath/polyline.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;
using geometry::Triangles;
using ::testing::HasSubstr;

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

TEST(ClipByTilt, EndsExactlyWhereTheNormalTiltsToTheLimits) {
  const Mesh bottle = lying_cylinder(0.0155, 0.07, 360);
  auto curve = section_curve(bottle, Vec3::Zero(), Vec3::UnitY(), Vec3::UnitZ());
  for (const bool backwards : {false, true}) {
    if (backwards) std::reverse(curve.begin(), curve.end());
    // 20.3 and 13.7 deg fall inside facets, not on their vertices.
    const auto part = clip_by_tilt(bottle, curve, -20.3 * kDegree, 13.7 * kDegree, Vec3::UnitY());
    EXPECT_NEAR(tilt_about(bottle.nearest(part.front()).normal, Vec3::UnitY()), -20.3 * kDegree, 1e-9);
    EXPECT_NEAR(tilt_about(bottle.nearest(part.back()).normal, Vec3::UnitY()), 13.7 * kDegree, 1e-9);
    // Smooth normals follow the circle to the cube of half a facet: 2e-7 rad, 4 nm here.
    EXPECT_NEAR(std::atan2(part.front().x(), part.front().z()), -20.3 * kDegree, 1e-6);
    EXPECT_NEAR(std::atan2(part.back().x(), part.back().z()), 13.7 * kDegree, 1e-6);
    for (const Vec3& p : part) EXPECT_LE(std::abs(std::atan2(p.x(), p.z())), 20.3001 * kDegree);
  }
}

TEST(ClipByTilt, ASegmentThatPassesBothLimitsIsCutAtBoth) {
  const Mesh bottle = lying_cylinder(0.0155, 0.07, 360);
  const std::vector<Vec3> chord = {Vec3(0.02, 0, 0.012), Vec3(-0.02, 0, 0.012)};
  const auto part = clip_by_tilt(bottle, chord, -10 * kDegree, 10 * kDegree, Vec3::UnitY());
  ASSERT_EQ(part.size(), 2u);
  // Straight up from the chord to the cylinder's axis: x = z tan 10 deg, within the sag of a facet's foot.
  EXPECT_NEAR(part[0].x(), -0.012 * std::tan(10 * kDegree), 3e-5);
  EXPECT_NEAR(part[1].x(), 0.012 * std::tan(10 * kDegree), 3e-5);
}

TEST(ClipByTilt, AClosedCurveThatBeginsInsideIsNotCutInTwo) {
  const Mesh bottle = lying_cylinder(0.0155, 0.07, 360);
  std::vector<Vec3> circle;
  for (int i = 0; i <= 100; ++i) {
    const double a = 2 * std::numbers::pi * (i % 100) / 100;
    circle.push_back(0.0155 * Vec3(std::sin(a), 0, std::cos(a)));  // begins on top
  }
  const auto part = clip_by_tilt(bottle, circle, -20 * kDegree, 20 * kDegree, Vec3::UnitY());
  EXPECT_NEAR(polyline_length(part), 0.0155 * 40 * kDegree, 1e-5);  // chords of 3.6 deg
}

TEST(ClipByTilt, SaysWhenNothingIsLeft) {
  const Mesh box = mesh_of(geometry::box(Vec3(-2, -1, 0), Vec3(2, 1, 1)));
  const std::vector<Vec3> side = {Vec3(2, 0, 0.2), Vec3(2, 0, 0.8)};
  EXPECT_THROW(clip_by_tilt(box, side, -0.3, 0.3, Vec3::UnitY()), InputError);
  EXPECT_THROW(clip_by_tilt(box, side, 0.3, 0.3, Vec3::UnitY()), InputError);
  EXPECT_NEAR(tilt_about(Vec3::UnitX(), Vec3::UnitY()), 90 * kDegree, 1e-15);
  EXPECT_NEAR(tilt_about(Vec3::UnitY(), Vec3::UnitX()), -90 * kDegree, 1e-15);
}

class CurveCsv : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::vector<Vec3> read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_curve_csv(path_);
  }
  std::string rejection(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(path_.string().size());
    }
    return "accepted";
  }
  const std::filesystem::path path_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("understudy_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv");
};

TEST_F(CurveCsv, GivesMetres) {
  const auto curve = read("x_mm,y_mm,z_mm\r\n1,-2.5,+3e1\r\n\r\n 4 , 5 ,6");
  ASSERT_EQ(curve.size(), 2u);
  EXPECT_LT((curve[0] - Vec3(1e-3, -2.5e-3, 30e-3)).norm(), 1e-15);
  EXPECT_LT((curve[1] - Vec3(4e-3, 5e-3, 6e-3)).norm(), 1e-15);
}

TEST_F(CurveCsv, NamesLineAndColumnOfWhatIsWrong) {
  EXPECT_EQ(rejection(""), ": is empty; the header is 'x_mm,y_mm,z_mm'");
  EXPECT_EQ(rejection("x_mm,y_mm,z_mm\n1,2,3\n"), ": 1 points, a curve needs 2");
  EXPECT_EQ(rejection("x,y,z\n1,2,3\n"), ":1: the header is 'x,y,z', not 'x_mm,y_mm,z_mm'");
  EXPECT_EQ(rejection("x_mm,y_mm,z_mm\n1,2,3\n1,2\n"), ":3: 2 cells, not 3");
  EXPECT_EQ(rejection("x_mm,y_mm,z_mm\n1,2,3,4\n"), ":2: 4 cells, not 3");
  EXPECT_EQ(rejection("x_mm,y_mm,z_mm\n1,2,3\n\n1,two,3\n"), ":4:3: y_mm is 'two', not a finite number");
  EXPECT_THAT(rejection("x_mm,y_mm,z_mm\n1,2,nan\n"), HasSubstr("z_mm is 'nan'"));
  EXPECT_THAT(rejection("x_mm,y_mm,z_mm\n1e999,2,3\n"), HasSubstr("x_mm is '1e999'"));
  EXPECT_THAT(rejection("x_mm,y_mm,z_mm\n,2,3\n"), HasSubstr("x_mm is ''"));
}

}  // namespace
}  // namespace understudy::toolpath
