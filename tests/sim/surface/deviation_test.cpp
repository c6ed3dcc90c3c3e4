#include "sim/surface/deviation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/geometry/test_solids.h"

namespace understudy::sim {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kFloat = 2e-9;  // [m], of a bead's coordinates up to 20 mm

geometry::Mesh boxes(const std::vector<std::pair<Vec3, Vec3>>& corners) {
  const geometry::Triangles t = geometry::boxes(corners);
  return {t.vertices, t.triangles};
}

// Along x, its top at z = 1 mm.
Bead bead(double from_x, double to_x, double y, double width, double height) {
  Bead result;
  const auto z = static_cast<float>(1e-3 - height / 2);
  result.from_W = {static_cast<float>(from_x), static_cast<float>(y), z};
  result.to_W = {static_cast<float>(to_x), static_cast<float>(y), z};
  result.width = static_cast<float>(width);
  result.height = static_cast<float>(height);
  return result;
}

// The top, 10 mm x 10 mm of it.
DeviationSettings on_top(double z) {
  DeviationSettings settings;
  settings.region_W = Eigen::AlignedBox3d(Vec3(-5e-3, -5e-3, z - 1e-6), Vec3(5e-3, 5e-3, z + 1e-6));
  return settings;
}

TEST(Deviation, OfAFlatTopIsItsOffset) {
  for (const double offset : {-60e-6, 0.0, 40e-6}) {
    const double top = 1e-3 - offset;  // intended
    const auto intended = boxes({{Vec3(-8e-3, -8e-3, 0), Vec3(8e-3, 8e-3, top)}});
    BeadIndex beads;
    beads.add(bead(-8e-3, 8e-3, 0, 18e-3, 0.2e-3));
    const auto samples = sample_deviation(beads, intended, on_top(top));
    const SurfaceDeviation d = summarise(samples);
    EXPECT_EQ(d.samples, 20000u);
    EXPECT_EQ(d.covered, d.samples);
    EXPECT_EQ(d.coverage, 1);
    EXPECT_NEAR(d.mean, offset, kFloat);
    for (const double magnitude : {d.p50, d.p95, d.largest, d.nearest_p95})
      EXPECT_NEAR(magnitude, std::abs(offset), kFloat);
    for (const DeviationSample& sample : samples) ASSERT_NEAR(*sample.nearest, -offset, kFloat);
  }
}

TEST(Deviation, OfRoundRowsIsDistributedAsACircle) {
  const double r = 0.2e-3, pitch = 0.3e-3;
  const auto intended = boxes({{Vec3(-8e-3, -8e-3, 0), Vec3(8e-3, 8e-3, 1e-3)}});
  BeadIndex beads;
  for (int k = -20; k <= 20; ++k) beads.add(bead(-8e-3, 8e-3, k * pitch, 2 * r, 2 * r));
  DeviationSettings settings = on_top(1e-3);
  settings.region_W = Eigen::AlignedBox3d(Vec3(-5e-3, -4.5e-3, 0.5e-3), Vec3(5e-3, 4.5e-3, 2e-3));
  const SurfaceDeviation d = summarise(sample_deviation(beads, intended, settings));
  const auto depth = [&](double share) { return r - std::sqrt(r * r - std::pow(share * pitch / 2, 2)); };
  // A quantile of 20000 samples is off by sqrt(q (1 - q) / 20000) of share: three of these.
  EXPECT_NEAR(d.p50, depth(0.5), depth(0.5106) - depth(0.5));
  EXPECT_NEAR(d.p95, depth(0.95), depth(0.9546) - depth(0.95));
  EXPECT_LE(d.largest, depth(1) + kFloat);
  EXPECT_GT(d.largest, depth(0.999));
  EXPECT_EQ(d.coverage, 1);
  EXPECT_LT(d.mean, 0);
}

TEST(Deviation, CoverageIsTheShareWithMaterialInReach) {
  const auto intended = boxes({{Vec3(-8e-3, -8e-3, 0), Vec3(8e-3, 8e-3, 1e-3)}});
  BeadIndex beads;
  beads.add(bead(-7e-3, 0, 0, 14e-3, 0.2e-3));  // and its round end, 0.1 mm
  const SurfaceDeviation d = summarise(sample_deviation(beads, intended, on_top(1e-3)));
  EXPECT_NEAR(d.coverage, 0.51, 3 * std::sqrt(0.25 / 20000));  // three standard deviations
  EXPECT_EQ(static_cast<double>(d.covered), d.coverage * static_cast<double>(d.samples));
}

TEST(Deviation, MaterialBeyondTheLimitDoesNotCount) {
  const auto intended = boxes({{Vec3(-8e-3, -8e-3, 0), Vec3(8e-3, 8e-3, 3.001e-3)}});
  BeadIndex beads;
  beads.add(bead(-8e-3, 8e-3, 0, 18e-3, 0.2e-3));  // 2.001 mm below
  DeviationSettings settings = on_top(3.001e-3);
  settings.limit = 2e-3;
  const SurfaceDeviation none = summarise(sample_deviation(beads, intended, settings));
  EXPECT_EQ(none.coverage, 0);
  EXPECT_EQ(none.largest, 0);
  settings.limit = 2.002e-3;
  EXPECT_EQ(summarise(sample_deviation(beads, intended, settings)).coverage, 1);
}

TEST(Deviation, TheWallOppositeIsNotThisWall) {
  // Two blocks face each other across 0.4 mm; only the right one is printed.
  const auto intended = boxes(
      {{Vec3(-6e-3, -3e-3, 0), Vec3(-0.2e-3, 3e-3, 4e-3)}, {Vec3(0.2e-3, -3e-3, 0), Vec3(6e-3, 3e-3, 4e-3)}});
  BeadIndex beads;
  Bead right = bead(0.3e-3, 0.3e-3, 0, 0.2e-3, 0.2e-3);
  right.from_W = {0.3e-3f, -4e-3f, 2e-3f};
  right.to_W = {0.3e-3f, 4e-3f, 2e-3f};
  right.up_W = {1, 0, 0};
  right.width = 6e-3f;
  beads.add(right);
  DeviationSettings settings;
  settings.limit = 1.5e-3;
  settings.region_W = Eigen::AlignedBox3d(Vec3(-0.21e-3, -2e-3, 1e-3), Vec3(-0.19e-3, 2e-3, 3e-3));
  EXPECT_EQ(summarise(sample_deviation(beads, intended, settings)).coverage, 0);
  settings.region_W = Eigen::AlignedBox3d(Vec3(0.19e-3, -2e-3, 1e-3), Vec3(0.21e-3, 2e-3, 3e-3));
  const SurfaceDeviation there = summarise(sample_deviation(beads, intended, settings));
  EXPECT_EQ(there.coverage, 1);
  EXPECT_NEAR(there.mean, 0, kFloat);
}

TEST(Deviation, SamplesAreEvenByArea) {
  const auto intended = boxes({{Vec3(0, 0, 0), Vec3(1e-3, 2e-3, 3e-3)}});
  BeadIndex beads;
  const auto samples = sample_deviation(beads, intended);
  std::array<double, 3> share{};
  double far_third = 0;
  for (const DeviationSample& sample : samples) {
    Eigen::Index axis = 0;
    sample.normal_W.cwiseAbs().maxCoeff(&axis);
    share[static_cast<std::size_t>(axis)] += 1.0 / static_cast<double>(samples.size());
    if (axis == 0 && sample.place_W.z() > 2e-3) far_third += 1.0 / static_cast<double>(samples.size());
  }
  // Areas 6, 3 and 2 of 11; strata straddle the borders of 12 triangles.
  EXPECT_NEAR(share[0], 6.0 / 11, 12.0 / 20000);
  EXPECT_NEAR(share[1], 3.0 / 11, 12.0 / 20000);
  EXPECT_NEAR(share[2], 2.0 / 11, 12.0 / 20000);
  EXPECT_NEAR(far_third, 2.0 / 11, 3 * std::sqrt(0.15 / 20000));  // three standard deviations
}

TEST(Deviation, IsTheSameForTheSameSeed) {
  const auto intended = boxes({{Vec3(-8e-3, -8e-3, 0), Vec3(8e-3, 8e-3, 1e-3)}});
  BeadIndex beads;
  for (int k = -20; k <= 20; ++k) beads.add(bead(-8e-3, 8e-3, k * 0.3e-3, 0.4e-3, 0.4e-3));
  DeviationSettings settings;
  settings.samples = 500;
  const auto one = sample_deviation(beads, intended, settings),
             other = sample_deviation(beads, intended, settings);
  settings.seed = 2;
  const auto third = sample_deviation(beads, intended, settings);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].place_W, other[i].place_W);
    EXPECT_EQ(one[i].along, other[i].along);
    EXPECT_NE(one[i].place_W, third[i].place_W);
  }
}

TEST(Deviation, RefusesWhatMakesNoSense) {
  const auto intended = boxes({{Vec3(-8e-3, -8e-3, 0), Vec3(8e-3, 8e-3, 1e-3)}});
  BeadIndex beads;
  DeviationSettings settings;
  const auto run = [&] { sample_deviation(beads, intended, settings); };
  settings.samples = 0;
  EXPECT_THAT(run, ThrowsMessage<InputError>(HasSubstr("has 0 samples, not from 1")));
  settings.samples = 10;
  settings.limit = 0;
  EXPECT_THAT(run, ThrowsMessage<InputError>(HasSubstr("limit is 0 mm")));
  settings.limit = 1e-3;
  settings.region_W = Eigen::AlignedBox3d(Vec3(1, 1, 1), Vec3(2, 2, 2));
  EXPECT_THAT(run, ThrowsMessage<InputError>(HasSubstr("holds nothing of the intended surface")));
  settings.region_W = Eigen::AlignedBox3d(Vec3(1, 1, 1), Vec3(0, 2, 2));
  EXPECT_THAT(run, ThrowsMessage<InputError>(HasSubstr("region is empty")));
}

}  // namespace
}  // namespace understudy::sim
