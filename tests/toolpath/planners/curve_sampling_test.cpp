#include "toolpath/planners/curve_sampling.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/geometry/test_solids.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;
using testing::HasSubstr;

const SamplingLimits kLimits{0.1e-3, 0.5e-3, 2e-6};

Mesh plate() {
  const auto t = geometry::box(Vec3(-0.02, -0.02, -0.01), Vec3(0.02, 0.02, 0));
  return {t.vertices, t.triangles};
}

/// About y, which the path crosses.
Mesh lying_cylinder(double radius) {
  geometry::Triangles t = geometry::cylinder(radius, 0.04, 720);
  for (Vec3& v : t.vertices) v = Vec3(v.x(), -v.z(), v.y());
  return {t.vertices, t.triangles};
}

std::string complaint(const Mesh& mesh, const std::vector<Vec3>& curve) {
  try {
    sample_curve(mesh, curve, kLimits);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(CurveSampling, OnAPlaneEqualStepsNoLongerThanAsked) {
  const auto samples = sample_curve(plate(), {Vec3(-5e-3, 1e-3, 1e-3), Vec3(5.2e-3, 1e-3, 1e-3)}, kLimits);
  ASSERT_EQ(samples.size(), 22u) << "10.2 mm in 21 steps";
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Vec3 expected(-5e-3 + 10.2e-3 * static_cast<double>(i) / 21, 1e-3, 0);
    EXPECT_LE((samples[i].position - expected).norm(), 1e-12);
    EXPECT_LE((samples[i].normal - Vec3::UnitZ()).norm(), 1e-12);
  }
}

TEST(CurveSampling, KeepsTheCornersOfThePolyline) {
  const std::vector<Vec3> corners = {Vec3(-5.1e-3, 0, 0), Vec3(0, 0, 0), Vec3(0, 3.3e-3, 0)};
  const auto samples = sample_curve(plate(), corners, kLimits);
  for (const Vec3& corner : corners) {
    double nearest = 1;
    for (const auto& s : samples) nearest = std::min(nearest, (s.position - corner).norm());
    EXPECT_LE(nearest, 1e-12) << corner.transpose();
  }
}

TEST(CurveSampling, ChordsOverACylinderStayWithinTheTolerance) {
  const double radius = 3e-3;
  std::vector<Vec3> curve;
  for (int i = -40; i <= 40; ++i)
    curve.push_back(radius * Vec3(std::sin(from_deg(i)), 0, std::cos(from_deg(i))));
  const auto samples = sample_curve(lying_cylinder(radius), curve, kLimits);
  const double tip_radius = radius + kLimits.gap;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    // Sagitta of a chord; facets of half a degree add 0.03 um.
    const double chord = (samples[i].position - samples[i - 1].position).norm() * tip_radius / radius;
    EXPECT_LE(chord * chord / (8 * tip_radius), kLimits.chord_tolerance + 0.1e-6);
  }
  EXPECT_GT(samples.size(), 20u);
}

TEST(CurveSampling, CurvesThatCannotBeFollowedAreRefused) {
  EXPECT_THAT(complaint(plate(), {Vec3(0, 0, 0), Vec3(1e-3, 0, 6e-3)}),
              HasSubstr("is 6.000 mm from the part, more than 5 mm"));
  EXPECT_THAT(complaint(plate(), {Vec3(0, 0, 0), Vec3(0.1e-6, 0, 0)}), HasSubstr("it needs 2"));
  EXPECT_THAT(complaint(plate(), {Vec3(0, 0, 0), Vec3(std::nan(""), 0, 0)}),
              HasSubstr("point 2 of the curve"));
  EXPECT_THAT(complaint(plate(), {Vec3(0.018, 0, 2e-3), Vec3(0.022, 0, -2e-3)}), HasSubstr("sharp edge"));
}

}  // namespace
}  // namespace understudy::toolpath
