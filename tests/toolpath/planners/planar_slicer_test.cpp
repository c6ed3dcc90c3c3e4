#include "toolpath/planners/planar_slicer.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/geometry/test_solids.h"
#include "tests/told_progress.h"

namespace understudy::toolpath {
namespace {

using geometry::Mesh;
using ::testing::HasSubstr;
constexpr double kPi = std::numbers::pi;

PlanarPlan plan() {
  PlanarPlan p;
  p.layer_height = 0.2e-3;
  p.bead_width = 0.5e-3;
  p.feed = 10e-3;
  p.approach_feed = 2e-3;
  p.clearance = 2e-3;
  p.nozzle_flat = 1e-3;
  p.filament_diameter = 1.75e-3;
  p.temperature = 483.15;
  return p;
}

Mesh box(double x, double y, double z0, double z1) {
  const auto t = geometry::box(Vec3(-x / 2, -y / 2, z0), Vec3(x / 2, y / 2, z1));
  return {t.vertices, t.triangles};
}

double fed_volume(const Program& program) {
  double fed = 0;
  for (const Step& s : program.steps) fed += s.filament;
  return fed * kPi / 4 * 1.75e-3 * 1.75e-3;
}

TEST(PlanarSlicer, OneWallRunsHalfABeadInsideTheOutlineAtTheTopOfEachLayer) {
  PlanarPlan p = plan();
  p.walls = 1;
  const Mesh part = box(10e-3, 6e-3, 0, 1e-3);
  const PlanarProgram result = plan_planar(part, nullptr, p);
  EXPECT_EQ(result.layers, 5);
  EXPECT_EQ(result.strokes, 5);
  const double area = 0.3e-3 * 0.2e-3 + kPi / 4 * 0.04e-6, half = 0.5 * area / 0.2e-3;
  // Corners round to the offset's grid of 1 nm: 8 sides' ends of half a nanometre in each of 5 layers.
  EXPECT_NEAR(result.printed, 5 * 2 * (16e-3 - 4 * half), 20e-9);
  EXPECT_NEAR(fed_volume(result.program), area * result.printed, 1e-15);
  for (const Step& s : result.program.steps) {
    if (s.kind != StepKind::print) continue;
    const Vec3 t = s.X_WT.translation();
    EXPECT_NEAR(std::min(5e-3 - std::abs(t.x()), 3e-3 - std::abs(t.y())), half, 1e-9);
    EXPECT_NEAR(std::remainder(t.z(), 0.2e-3), 0, 1e-12);
    EXPECT_NEAR(tool_axis(s.X_WT).z(), 1, 1e-15);
  }
}

TEST(PlanarSlicer, AFullLayerHasTheVolumeOfItsSection) {
  // 16 x 10 pitches: five loops of beads side by side fill it without rest, but for the corners: a loop's
  // length is that of its middle line, so its area is exact.
  const double area = 0.3e-3 * 0.2e-3 + kPi / 4 * 0.04e-6, pitch = area / 0.2e-3;
  const Mesh part = box(16 * pitch, 10 * pitch, 0, 0.2e-3);
  const PlanarProgram result = plan_planar(part, nullptr, plan());
  EXPECT_EQ(result.strokes, 5);
  EXPECT_NEAR(fed_volume(result.program) / part.volume(), 1, 1e-6);
}

TEST(PlanarSlicer, NothingIsPrintedInsideTheCore) {
  const Mesh part = box(10e-3, 10e-3, 0, 2e-3), core = box(10e-3, 10e-3, 0, 1e-3);
  const PlanarProgram result = plan_planar(part, &core, plan());
  EXPECT_EQ(result.layers, 5);
  for (const Step& s : result.program.steps)
    if (s.kind == StepKind::print) {
      EXPECT_GT(s.X_WT.translation().z(), 1e-3 + 0.19e-3);
    }
  const PlanarProgram whole = plan_planar(part, nullptr, plan());
  EXPECT_NEAR(result.printed, 0.5 * whole.printed, 1e-9);
}

TEST(PlanarSlicer, ADomeIsAStaircaseOfCircles) {
  const auto t = geometry::sphere(10e-3, 90, 180);
  std::vector<Vec3> up = t.vertices;
  for (Vec3& v : up) v.z() += 10e-3;
  PlanarPlan p = plan();
  p.walls = 1;
  p.layer_height = 0.4e-3;
  const PlanarProgram result = plan_planar(Mesh(up, t.triangles), nullptr, p);
  const double half = 0.5 * (0.1e-3 * 0.4e-3 + kPi / 4 * 0.16e-6) / 0.4e-3;
  EXPECT_EQ(result.layers, 50);
  for (const Step& s : result.program.steps) {
    if (s.kind != StepKind::print) continue;
    const double z = s.X_WT.translation().z() - 0.2e-3 - 10e-3;  // plane through the middle of the layer
    const double radius = std::sqrt(100e-6 - z * z) - half;
    // Facets of 2 degrees sag by 1.5 um along a circle and by as much along a meridian, more where it is
    // flat.
    EXPECT_NEAR(s.X_WT.translation().head<2>().norm(), radius, 3e-6 + 1.6e-6 / std::sqrt(1 - z * z / 100e-6));
  }
}

TEST(PlanarSlicer, WhatCannotBeSlicedIsRefused) {
  const Mesh part = box(10e-3, 6e-3, 0, 1e-3);
  const auto rejection = [](const Mesh& mesh, const PlanarPlan& p) -> std::string {
    try {
      plan_planar(mesh, nullptr, p);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  ASSERT_EQ(rejection(part, plan()), "accepted");
  for (double PlanarPlan::*field :
       {&PlanarPlan::layer_height, &PlanarPlan::bead_width, &PlanarPlan::feed, &PlanarPlan::approach_feed,
        &PlanarPlan::clearance, &PlanarPlan::nozzle_flat, &PlanarPlan::filament_diameter})
    for (const double bad : {0.0, -1.0, std::nan("")}) {
      PlanarPlan p = plan();
      p.*field = bad;
      EXPECT_THAT(rejection(part, p), HasSubstr("must be above 0"));
    }
  PlanarPlan p = plan();
  p.layer_height = 0.6e-3;
  EXPECT_THAT(rejection(part, p), HasSubstr("bead width is 0.5 mm, less than its height of 0.6 mm"));
  EXPECT_THAT(rejection(box(1e-2, 1e-2, 0, 0.05e-3), plan()),
              HasSubstr("the part is 0.05 mm high, less than half a layer"));
  EXPECT_THAT(rejection(box(1e-2, 1e-2, -1e-3, 1e-3), plan()),
              HasSubstr("the part reaches 1.000 mm under the table"));
  EXPECT_THAT(rejection(box(0.2e-3, 1e-2, 0, 1e-3), plan()), HasSubstr("has room for a bead of 0.5 mm"));
  auto t = geometry::box(Vec3(0, 0, 0), Vec3(0.01, 0.01, 0.01));
  t.triangles.pop_back();
  EXPECT_THAT(rejection(Mesh(t.vertices, t.triangles), plan()), HasSubstr("the part has 3 open edges"));
}

TEST(PlanarSlicer, TellsEachLayer) {
  understudy::test::ToldProgress told;
  PlanarPlan p = plan();
  p.progress = told.teller();
  plan_planar(box(10e-3, 6e-3, 0, 1e-3), nullptr, p);
  EXPECT_EQ(told.times(), 5u);
  told.expect_even(0.2001);
}

}  // namespace
}  // namespace understudy::toolpath
