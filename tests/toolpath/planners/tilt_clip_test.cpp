#include "toolpath/planners/tilt_clip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/geometry/test_solids.h"
#include "toolpath/planners/section_curve.h"
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

}  // namespace
}  // namespace understudy::toolpath
