#include "sim/removal/material_rays.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/units.h"
#include "geometry/inflated.h"
#include "tests/geometry/test_solids.h"

namespace understudy::sim {
namespace {

using geometry::Mesh;

constexpr EndMill kMill{1.5e-3, 30e-3};

std::shared_ptr<const Mesh> box_mm(const Vec3& lower, const Vec3& upper) {
  const auto t = geometry::box(from_mm(1) * lower, from_mm(1) * upper);
  return std::make_shared<Mesh>(t.vertices, t.triangles);
}

Pose mill_at(const Vec3& p, const Vec3& axis) { return make_pose(shortest_arc_from_z(axis.normalized()), p); }

SurfaceSample on_top(double x_mm, double y_mm) {
  SurfaceSample s;
  s.position = from_mm(1) * Vec3(x_mm, y_mm, 10);
  s.normal = Vec3::UnitZ();
  s.area = 1e-6;
  return s;
}

TEST(MaterialRays, AFlatFaceLeavesItsHeightWithinItsRadius) {
  const auto stock = box_mm(Vec3(-20, -20, 0), Vec3(20, 20, 10.7));
  const std::vector<SurfaceSample> samples{on_top(0, 0), on_top(1.4, 0), on_top(1.6, 0), on_top(0, -1.49)};
  MaterialRays rays(samples, *stock);
  rays.cut(mill_at(from_mm(1) * Vec3(0, 0, 10.1), Vec3::UnitZ()), kMill, 7);
  for (const std::size_t i : {0u, 1u, 3u}) {
    EXPECT_NEAR(to_mm(rays.left(i).before), 0.7, 1e-6);
    EXPECT_NEAR(to_mm(rays.left(i).top), 0.1, 1e-6) << i;
    EXPECT_NEAR(to_mm(rays.left(i).removed), 0.6, 1e-6);
    EXPECT_EQ(rays.left(i).deepest, 0) << "above the surface nothing is gouged";
    EXPECT_EQ(rays.left(i).line, 0);
  }
  EXPECT_NEAR(to_mm(rays.left(2).top), 0.7, 1e-6) << "beside the mill";
  rays.cut(mill_at(from_mm(1) * Vec3(0, 0, 9.95), Vec3::UnitZ()), kMill, 8);
  EXPECT_NEAR(to_mm(rays.left(0).deepest), -0.05, 1e-6);
  EXPECT_EQ(rays.left(0).line, 8);
  EXPECT_NEAR(to_mm(rays.left(0).top), -0.05, 1e-6);
}

// The lower rim of a mill that leans by a: R sin a below its tip.
TEST(MaterialRays, ALeaningMillGougesByTheSineOfItsLean) {
  const auto stock = box_mm(Vec3(-20, -20, 0), Vec3(20, 20, 10.7));
  std::vector<SurfaceSample> samples;
  for (int i = -200; i <= 200; ++i) samples.push_back(on_top(0.01 * i, 0));
  MaterialRays rays(samples, *stock);
  const double lean = from_deg(5);
  rays.cut(mill_at(from_mm(1) * Vec3(0, 0, 10), Vec3(std::sin(lean), 0, std::cos(lean))), kMill, 1);
  double deepest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) deepest = std::max(deepest, -rays.left(i).deepest);
  EXPECT_NEAR(to_mm(deepest), 1.5 * std::sin(lean), 1e-3) << "samples are 0.01 mm apart on a slope of 0.09";
}

// Every ray against points along it, one by one, over random cuts: also where a cut leaves an island.
TEST(MaterialRays, AgreeWithPointsOnRandomCuts) {
  Random random(71, "rays");
  const auto stock = box_mm(Vec3(-6, -6, 0), Vec3(6, 6, 10.7));
  std::vector<SurfaceSample> samples;
  for (int n = 0; n < 30; ++n) {
    samples.push_back(on_top(random.uniform(-2, 2), random.uniform(-2, 2)));
    samples.back().normal = Vec3(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 1).normalized();
  }
  MaterialRays rays(samples, *stock);
  std::vector<Pose> poses;
  for (int n = 0; n < 25; ++n) {
    const Vec3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.2, 1));
    poses.push_back(mill_at(
        from_mm(1) * Vec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(9, 12)), axis));
    rays.cut(poses.back(), {0.4e-3, 3e-3}, n);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    constexpr int kPoints = 18'000;
    double top = -kBelow, deepest = 0, removed = 0;
    for (int k = 0; k < kPoints; ++k) {
      const double t = -kBelow + (k + 0.5) * (kBelow + kAbove) / kPoints;
      const Vec3 p = samples[i].position + t * samples[i].normal;
      if (stock->signed_distance(p) > 0) continue;
      bool cut = false;
      for (const Pose& X : poses) {
        const Vec3 q = X.inverse(Eigen::Isometry) * p;
        cut = cut || (q.head<2>().norm() < 0.4e-3 && q.z() > 0 && q.z() < 3e-3);
      }
      if (cut) deepest = std::min(deepest, t), removed += (kBelow + kAbove) / kPoints;
      if (!cut) top = t;
    }
    constexpr double kPoint = 1e-6;  // half a micrometre each way
    EXPECT_NEAR(rays.left(i).top, top, kPoint) << i;
    EXPECT_NEAR(rays.left(i).deepest, deepest, kPoint) << i;
    EXPECT_NEAR(rays.left(i).removed, removed, 5 * kPoint) << i;
  }
}

// Beads of a print are shells that run through each other.
TEST(MaterialRays, OverlappingShellsAreOneMaterial) {
  const auto shells = geometry::boxes({{from_mm(1) * Vec3(-5, -5, 0), from_mm(1) * Vec3(5, 5, 9.8)},
                                       {from_mm(1) * Vec3(-5, -5, 9.7), from_mm(1) * Vec3(5, 5, 10.1)},
                                       {from_mm(1) * Vec3(-5, -5, 10.0), from_mm(1) * Vec3(5, 5, 10.6)},
                                       {from_mm(1) * Vec3(-5, -5, 11), from_mm(1) * Vec3(5, 5, 11.5)}});
  const Mesh stock(shells.vertices, shells.triangles);
  const std::vector<SurfaceSample> samples{on_top(0.7, 0.9)};
  MaterialRays rays(samples, stock);
  EXPECT_NEAR(to_mm(rays.left(0).before), 1.5, 1e-6);
  rays.cut(mill_at(from_mm(1) * Vec3(0, 0, 10), Vec3::UnitZ()), kMill, 1);
  EXPECT_NEAR(to_mm(rays.left(0).top), 0, 1e-6);
  EXPECT_NEAR(to_mm(rays.left(0).removed), 0.6 + 0.5, 1e-6) << "the gap between them is no material";
}

TEST(MaterialRays, BeginWithTheStockAsItIs) {
  const auto part = box_mm(Vec3(-10, -10, 0), Vec3(10, 10, 10));
  // A print with a step: on one half it is 0.4 mm too low.
  auto low = geometry::box(from_mm(1) * Vec3(-11, -11, 0), from_mm(1) * Vec3(0, 11, 9.6));
  const Mesh stock(low.vertices, low.triangles);
  const std::vector<SurfaceSample> samples{on_top(-5, 0), on_top(5, 0)};
  const MaterialRays rays(samples, stock);
  EXPECT_NEAR(to_mm(rays.left(0).before), -0.4, 1e-6);
  EXPECT_NEAR(rays.left(1).before, -kBelow, 1e-9) << "nothing is there";
}

}  // namespace
}  // namespace understudy::sim
