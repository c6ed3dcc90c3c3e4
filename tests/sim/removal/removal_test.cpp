#include "sim/removal/removal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/units.h"
#include "geometry/inflated.h"
#include "tests/geometry/test_solids.h"

namespace understudy::sim {
namespace {

using geometry::Mesh;
using ::testing::StartsWith;

constexpr EndMill kMill{1.5e-3, 30e-3};

/// A bar of 40 by 10 mm, 20 mm high, and stock 0.7 mm larger.
Workblank bar() {
  const auto t = geometry::box(from_mm(1) * Vec3(-20, -5, 0), from_mm(1) * Vec3(20, 5, 20));
  const auto part = std::make_shared<Mesh>(t.vertices, t.triangles);
  return {part, geometry::inflated(*part, from_mm(0.7)), kMill, 0.5e-3};
}

Snapshot at(const Vec3& p_mm, const Vec3& axis, int line, double off_mm = 0) {
  Snapshot s;
  s.X_WT_commanded = make_pose(shortest_arc_from_z(axis), from_mm(1) * p_mm);
  s.X_WT = s.X_WT_commanded;
  s.X_WT.translation() += from_mm(off_mm) * axis;
  s.line = line;
  return s;
}

/// One pass along the side y = 5 at z = 10, `off_mm` farther out than commanded.
RemovalSummary pass(double off_mm, const Vec3& axis = Vec3::UnitY()) {
  RemovalObserver observer(bar());
  for (int i = 0; i <= 600; ++i) observer.observe(at(Vec3(-30 + 0.1 * i, 5, 10), axis, i, off_mm));
  return observer.summary();
}

TEST(Removal, AFaceAlongAFlatSideLeavesNothingAndTakesItsBand) {
  const RemovalSummary s = pass(0);
  EXPECT_LE(s.gouge, 1e-9);
  EXPECT_LE(s.left_over_max, 1e-9);
  // 3 mm wide, 40 mm long, 0.7 mm deep; the band ends within a sample.
  EXPECT_NEAR(1e9 * s.volume, 3 * 40 * 0.7, 0.1 * 3 * 40 * 0.7);
  EXPECT_NEAR(s.finished_fraction, 120 / (2 * 50 * 20 + 400.0), 0.01);
}

TEST(Removal, AnErrorOutwardsIsLeftOverAndInwardsAGouge) {
  const RemovalSummary out = pass(0.03), in = pass(-0.02);
  EXPECT_NEAR(to_um(out.left_over_mean), 30, 0.1);
  EXPECT_NEAR(to_um(out.left_over_p95), 30, 0.1);
  EXPECT_NEAR(to_um(out.planned_left_over_max), 0, 0.1);
  EXPECT_LE(out.gouge, 1e-9);
  EXPECT_NEAR(to_um(in.gouge), 20, 0.1);
  EXPECT_LE(in.planned_gouge, 1e-9);
  EXPECT_NEAR(in.gouge_place_W.y(), from_mm(5), 1e-9);
  // The line on which the mill stands over that place.
  EXPECT_NEAR(in.gouge_place_W.x(), from_mm(-30 + 0.1 * in.gouge_line), from_mm(1.6));
}

TEST(Removal, AWrongNormalGouges) {
  const double lean = from_deg(4);
  const RemovalSummary s = pass(0, Vec3(0, std::cos(lean), std::sin(lean)));
  EXPECT_NEAR(to_mm(s.gouge), 1.5 * std::sin(lean), 0.02) << "by the rim, and samples 0.5 mm apart";
}

TEST(Removal, WithoutStockNothingCounts) {
  Workblank blank = bar();
  blank.stock = blank.part;
  RemovalObserver observer(blank);
  for (int i = 0; i <= 600; ++i) observer.observe(at(Vec3(-30 + 0.1 * i, 5, 10), Vec3::UnitY(), i));
  EXPECT_LT(1e9 * observer.summary().volume, 0.01);
  EXPECT_EQ(observer.summary().finished_fraction, 0);
}

// Yu's corners: a face that follows a hollow of radius r on its normal, unlifted, cuts r - sqrt(r^2 - R^2)
// deep.
TEST(Removal, AFaceInAHollowGougesByItsRim) {
  auto t = geometry::cylinder(from_mm(10), from_mm(30), 360);
  auto outer = geometry::cylinder(from_mm(40), from_mm(30), 90);
  const int n = static_cast<int>(outer.vertices.size());
  for (const auto& [a, b, c] : t.triangles) outer.triangles.push_back({n + a, n + c, n + b});
  outer.vertices.insert(outer.vertices.end(), t.vertices.begin(), t.vertices.end());
  const auto part = std::make_shared<Mesh>(outer.vertices, outer.triangles);
  // Stock: a hole of 9.3 mm.
  auto narrow = geometry::cylinder(from_mm(9.3), from_mm(30), 360);
  auto stock = geometry::cylinder(from_mm(40), from_mm(30), 90);
  for (const auto& [a, b, c] : narrow.triangles) stock.triangles.push_back({n + a, n + c, n + b});
  stock.vertices.insert(stock.vertices.end(), narrow.vertices.begin(), narrow.vertices.end());
  RemovalObserver observer(
      {part, std::make_shared<Mesh>(stock.vertices, stock.triangles), {1.5e-3, 8e-3}, 0.5e-3});
  for (int i = 0; i <= 400; ++i) {
    const double turn = from_deg(0.1 * i);
    const Vec3 radial(std::cos(turn), std::sin(turn), 0);
    observer.observe(at(10 * radial, -radial, i));
  }
  EXPECT_NEAR(to_um(observer.summary().gouge), 1e3 * (10 - std::sqrt(100 - 2.25)), 6)
      << "facets of 1 degree, and samples 0.5 mm apart";
  EXPECT_LE(to_um(observer.summary().left_over_p95), 1);
}

TEST(Removal, TellsTheMillOfATool) {
  machine::Tool tool;
  tool.flat_diameter = 3e-3;
  tool.bodies = {
      {"spindle", geometry::Cylinder{0.02, 0.06}, make_pose(Quat::Identity(), Vec3(0, 0, 0.06))},
      {"end mill", geometry::Cylinder{0.0015, 0.03}, make_pose(Quat::Identity(), Vec3(0, 0, 0.015))}};
  EXPECT_EQ(cutter_of(tool), "end mill");
  EXPECT_EQ(end_mill_of(tool).length, 0.03);
  EXPECT_EQ(end_mill_of(tool).radius, 1.5e-3);
  tool.nozzle_diameter = 0.4e-3;
  EXPECT_THROW(end_mill_of(tool), InputError);
}

TEST(Removal, WritesTheSurfaceAsTriangles) {
  RemovalObserver observer(bar());
  const auto surface = observer.surface();
  const std::string ply = surface_ply(surface.samples, surface.before, "before");
  EXPECT_THAT(ply, StartsWith("ply\nformat binary_little_endian 1.0\ncomment before, millimetres"));
  const std::size_t header = ply.find("end_header\n") + 11;
  EXPECT_EQ(ply.size() - header, surface.samples.size() * (4 * 16 + 17));
  EXPECT_EQ(surface.before, surface.after) << "nothing has moved";
}

}  // namespace
}  // namespace understudy::sim
