#include "sim/surface/bead_sweep.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "core/random.h"
#include "geometry/mesh.h"

namespace understudy::sim {
namespace {

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

Bead bead(const Vec3& from, const Vec3& to, double width, double height, double laid_at = 0,
          const Vec3& up = Vec3::UnitZ()) {
  Bead b;
  b.from_W = floats(from);
  b.to_W = floats(to);
  b.up_W = floats(up);
  b.width = static_cast<float>(width);
  b.height = static_cast<float>(height);
  b.laid_at = static_cast<float>(laid_at);
  return b;
}

/// A wavy line over a dome, as gap control lays it: the section breathes, the tool axis leans.
BeadIndex wavy_line() {
  BeadIndex beads;
  const auto at = [](int i) {
    const double s = 0.1e-3 * i;
    return Vec3(s, 3e-3 * std::sin(400 * s), 0.2e-3 - 8 * s * s);
  };
  for (int i = 0; i < 300; ++i) {
    const Vec3 up = Vec3(16 * 0.1e-3 * i, 0, 1).normalized();
    const double width = 0.48e-3 + 0.04e-3 * std::sin(0.11 * i),
                 height = 0.16e-3 + 0.02e-3 * std::sin(0.07 * i);
    beads.add(bead(at(i), at(i + 1), width, height, 0.02 * (i + 1), up));
  }
  return beads;
}

BeadMesh mesh_of(const std::vector<BeadStretch>& stretches, double chord_error) {
  BeadMesh mesh;
  for (const BeadStretch& stretch : stretches)
    append_sweep(stretch, sides_within(stretch, chord_error), mesh);
  return mesh;
}

double volume(const BeadMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) {
    const auto& v = mesh.vertices;
    const auto at = [&](int i) { return v[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])]; };
    six += at(0).cross(at(1)).dot(at(2));
  }
  return six / 6;
}

// 10 um is the bound of a close-up: 2 um each of joints, sections between them and mitres, and 3 um of
// chords.
TEST(BeadSweep, TheDrawnSurfaceIsWhereTheIndexSaysThatRaysMeetTheBeads) {
  const BeadIndex beads = wavy_line();
  const auto stretches = sweep_beads(beads);
  EXPECT_LT(stretches.size(), 5u) << "of 300 beads that follow each other";
  BeadMesh shell = mesh_of(stretches, 3e-6);
  const geometry::Mesh drawn(std::move(shell.vertices), std::move(shell.triangles));
  Random random(11, "rays at beads");
  int met = 0;
  double worst = 0;
  for (int n = 0; n < 200'000; ++n) {
    const Vec3 target(random.uniform(0, 30e-3), random.uniform(-3.4e-3, 3.4e-3),
                      random.uniform(-7e-3, 0.3e-3));
    const Vec3 direction = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const Vec3 origin = target - 20e-3 * direction;
    const auto truth = beads.ray_hit(origin, direction, 60e-3);
    const auto seen = drawn.ray_hit(origin, direction, 60e-3);
    if (!truth || !seen) continue;       // the silhouette is the next test's
    if (truth->distance <= 0) continue;  // it begins within a bead
    ++met;
    // A ray that grazes one of the two may pass it and meet what lies behind: how far apart the surfaces are
    // is told at both places.
    const auto back = beads.nearest_surface(origin + seen->distance * direction, 1e-3);
    ASSERT_TRUE(back);
    worst = std::max(
        {worst, (drawn.nearest(truth->place_W).position - truth->place_W).norm(), std::abs(back->distance)});
  }
  EXPECT_GT(met, 2000);
  EXPECT_LT(worst, 10e-6);
}

TEST(BeadSweep, TheSilhouetteIsThatOfTheBeads) {
  const BeadIndex beads = wavy_line();
  BeadMesh shell = mesh_of(sweep_beads(beads), 3e-6);
  const geometry::Mesh drawn(std::move(shell.vertices), std::move(shell.triangles));
  int inside = 0;
  for (int x = 0; x <= 300; ++x)
    for (int y = -180; y <= 180; ++y) {
      const Vec3 origin(1e-4 * x + 3e-5, 2e-5 * y, 20e-3);
      const bool truth = beads.ray_hit(origin, -Vec3::UnitZ(), 60e-3).has_value();
      inside += truth;
      if (truth == drawn.ray_hit(origin, -Vec3::UnitZ(), 60e-3).has_value()) continue;
      // Where they disagree, the edge is near.
      bool edge = false;
      for (const Vec3& step : {Vec3(1e-5, 0, 0), Vec3(-1e-5, 0, 0), Vec3(0, 1e-5, 0), Vec3(0, -1e-5, 0)})
        edge = edge || beads.ray_hit(origin + step, -Vec3::UnitZ(), 60e-3).has_value() != truth;
      EXPECT_TRUE(edge) << x << " " << y;
    }
  EXPECT_GT(inside, 1000);
}

TEST(BeadSweep, AStraightLineIsTwoSectionsAndHasTheVolumeOfAStadium) {
  BeadIndex beads;
  for (int i = 0; i < 50; ++i)
    beads.add(bead(Vec3(1e-3 * i, 0, 0), Vec3(1e-3 * (i + 1), 0, 0), 0.5e-3, 0.2e-3, 0.1 * (i + 1)));
  const auto stretches = sweep_beads(beads);
  ASSERT_EQ(stretches.size(), 1u);
  ASSERT_EQ(stretches[0].size(), 2u);
  EXPECT_NEAR(stretches[0][1].middle_W.x(), 50e-3, 1e-8);
  BeadMesh mesh;
  append_sweep(stretches[0], 32, mesh);
  const double r = 0.1e-3, flat = 0.3e-3, section = std::numbers::pi * r * r + 2 * r * flat;
  const double ends = 4.0 / 3 * std::numbers::pi * r * r * r + std::numbers::pi * r * r * flat;
  // 32 sides lose 1 - sin(x)/x of a circle, x = 2 pi / 32: 0.6 %.
  EXPECT_NEAR(volume(mesh), section * 50e-3 + ends, 0.007 * section * 50e-3);
  EXPECT_LT(volume(mesh), section * 50e-3 + ends);
}

TEST(BeadSweep, ShellsAreClosedAndOfTheSizeThatIsStated) {
  const auto stretches = sweep_beads(wavy_line());
  for (const BeadStretch& stretch : stretches) {
    BeadMesh mesh;
    append_sweep(stretch, 8, mesh);
    const ShellSize size = sweep_size(stretch, 8);
    EXPECT_EQ(mesh.vertices.size(), size.vertices);
    EXPECT_EQ(mesh.triangles.size(), size.triangles);
    std::map<std::pair<int, int>, int> edges;
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        const int a = t[static_cast<std::size_t>(k)], b = t[static_cast<std::size_t>((k + 1) % 3)];
        ++edges[{a, b}];
        --edges[{b, a}];
      }
    for (const auto& [edge, balance] : edges) ASSERT_EQ(balance, 0);
  }
}

TEST(BeadSweep, AStepOfWidthACornerAndABlobBeginAnew) {
  BeadIndex beads;
  beads.add(bead({0, 0, 0}, {1e-3, 0, 0}, 0.5e-3, 0.2e-3, 1));
  beads.add(bead({1e-3, 0, 0}, {2e-3, 0, 0}, 0.6e-3, 0.2e-3, 2));
  beads.add(bead({2e-3, 0, 0}, {2e-3, 1e-3, 0}, 0.6e-3, 0.2e-3, 3));
  beads.add(bead({2e-3, 1e-3, 0}, {2e-3, 1e-3, 0}, 0.6e-3, 0.2e-3, 4));
  EXPECT_EQ(sweep_beads(beads).size(), 4u);
  SweepSettings half;
  half.by = 2.5;
  EXPECT_EQ(sweep_beads(beads, half).size(), 2u);
}

// 10 mm/s, then 5 s of travel: what is laid behind it does not grow while the tool travels there.
TEST(BeadSweep, ABeadBehindATravelBeginsWhenTheTravelEnds) {
  BeadIndex beads;
  beads.add(bead({0, 0, 0}, {10e-3, 0, 0}, 0.5e-3, 0.2e-3, 21));
  beads.add(bead({10e-3, 0, 0}, {20e-3, 0, 0}, 0.5e-3, 0.2e-3, 22));
  beads.add(bead({0, 50e-3, 0}, {10e-3, 50e-3, 0}, 0.5e-3, 0.2e-3, 28));
  const auto stretches = sweep_beads(beads);
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_NEAR(stretches[0].front().laid_at, 20, 1e-6) << "the first is as fast as the second";
  EXPECT_NEAR(stretches[1].front().laid_at, 27, 1e-6);
}

// Of the 60 mm of an arc, chords within 2 um of a radius of 10 mm span 0.40 mm: 150 of them, and one section
// more.
TEST(BeadSweep, AFineArcBecomesChordsWithinTheTolerance) {
  BeadIndex beads;
  const auto at = [](int i) { return Vec3(10e-3 * std::cos(0.002 * i), 10e-3 * std::sin(0.002 * i), 0); };
  for (int i = 0; i < 3000; ++i) beads.add(bead(at(i), at(i + 1), 0.5e-3, 0.2e-3, 0.004 * (i + 1)));
  const auto stretches = sweep_beads(beads);
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_GT(stretches[0].size(), 150u);
  EXPECT_LT(stretches[0].size(), 220u);
  for (std::size_t i = 1; i < stretches[0].size(); ++i) {
    const Vec3 middle = 0.5 * (stretches[0][i - 1].middle_W + stretches[0][i].middle_W);
    EXPECT_LT(10e-3 - middle.norm(), 2.1e-6);
  }
}

}  // namespace
}  // namespace understudy::sim
