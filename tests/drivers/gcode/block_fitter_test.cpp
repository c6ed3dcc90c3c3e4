#include "drivers/gcode/block_fitter.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/drivers/gcode/path_distance.h"

namespace understudy::drivers {
namespace {

BlockGrid fine_grid() {
  BlockGrid grid;
  grid.axes.fill(1e-9);
  grid.filament = 1e-9;
  return grid;
}

std::vector<Block> fit(const std::vector<PathSample>& path, const FitTolerance& tolerance, std::size_t axes) {
  BlockFitter fitter(tolerance, fine_grid(), std::vector<bool>(axes, false));
  fitter.begin(path.front());
  std::vector<Block> blocks;
  const auto take = [&] {
    while (const auto block = fitter.take()) blocks.push_back(*block);
  };
  for (std::size_t i = 1; i < path.size(); ++i) {
    fitter.add(path[i]);
    take();
  }
  fitter.finish();
  take();
  return blocks;
}

/// Points of blocks, or of samples, in units of the position's tolerance.
TimedPoint point(double time, const machine::AxisVector& position, const FitTolerance& tolerance) {
  TimedPoint timed{time, {}};
  for (std::size_t i = 0; i < 6; ++i) timed.at.push_back(position[i] / tolerance.length);
  return timed;
}

/// A circle of 5 mm at 20 mm/s on two axes.
std::vector<PathSample> circle() {
  std::vector<PathSample> path;
  const double radius = 5e-3, rate = 4;  // [m], [rad/s]
  for (int n = 0; n <= 1570; ++n) {
    PathSample s;
    s.time = n * 1e-3;
    s.position[0] = radius * std::cos(rate * s.time);
    s.position[1] = radius * std::sin(rate * s.time);
    s.executed = static_cast<std::uint64_t>(n);
    path.push_back(s);
  }
  return path;
}

TEST(BlockFitter, AStraightLineAtConstantSpeedIsOneBlock) {
  std::vector<PathSample> path(501);
  for (std::size_t n = 0; n < path.size(); ++n) {
    path[n].time = 1e-3 * static_cast<double>(n);
    path[n].position[0] = 0.02 * path[n].time;
    path[n].filament = 1e-3 * path[n].time;
  }
  const auto blocks = fit(path, {}, 1);
  ASSERT_EQ(blocks.size(), 1U);
  EXPECT_NEAR(blocks[0].duration, 0.5, 1e-12);
  EXPECT_NEAR(blocks[0].position[0], 0.01, 1e-9);
  EXPECT_NEAR(blocks[0].filament, 0.5e-3, 1e-9);
}

TEST(BlockFitter, ACircleIsCutIntoTheLongestChordsOfItsTolerance) {
  // A chord whose sagitta is the tolerance: 2 r acos(1 - h / r), 0.283 mm, 111 chords of a circle. Both ends
  // lie on the path; they lie on samples, 0.02 mm apart.
  const double radius = 5e-3, height = 2e-6;
  const double chord = 2 * radius * std::acos(1 - height / radius);
  FitTolerance tolerance;
  tolerance.length = height;
  const auto blocks = fit(circle(), tolerance, 2);
  const double fewest = 1.57 * 4 * radius / chord, most = 1.57 * 4 * radius / (chord - 0.02e-3);
  EXPECT_GE(static_cast<double>(blocks.size()), std::floor(fewest));
  EXPECT_LE(static_cast<double>(blocks.size()), std::ceil(most) + 1);
}

TEST(BlockFitter, KeepsToThePathInPositionAndTime) {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 30; ++trial) {
    // Random frequencies on six axes, from rest to rest.
    std::uniform_real_distribution<> amount(-4e-3, 4e-3), rate(0.5, 6);
    std::array<double, 6> span{}, w{};
    for (std::size_t i = 0; i < 6; ++i) {
      span[i] = amount(random);
      w[i] = rate(random);
    }
    std::vector<PathSample> path;
    for (int n = 0; n <= 800; ++n) {
      PathSample s;
      s.time = n * 1e-3;
      const double share = n / 800.0, u = share * share * (3 - 2 * share);
      for (std::size_t i = 0; i < 6; ++i) s.position[i] = span[i] * std::sin(w[i] * u);
      path.push_back(s);
    }
    FitTolerance tolerance;
    const auto blocks = fit(path, tolerance, 6);
    double time = 0;
    std::vector<TimedPoint> points{point(0, path.front().position, tolerance)};
    for (const Block& block : blocks)
      points.push_back(point(time += block.duration, block.position, tolerance));
    EXPECT_NEAR(time, 0.8, 1e-9);
    for (const PathSample& s : path)
      ASSERT_LT(path_distance(point(s.time, s.position, tolerance), points, tolerance.time), 1 + 1e-3)
          << "trial " << trial << " at " << s.time;  // a thousandth: the grid of 1 nm
  }
}

TEST(BlockFitter, ACornerAndARestAreEndsOfBlocks) {
  std::vector<PathSample> path;
  for (int n = 0; n <= 300; ++n) {
    PathSample s;
    s.time = n * 1e-3;
    s.position[0] = 0.02 * 1e-3 * std::min(n, 100);
    s.position[1] = 0.02 * 1e-3 * std::clamp(n - 200, 0, 100);
    path.push_back(s);
  }
  FitTolerance exact;
  exact.length = 1e-8;
  exact.time = 0;
  const auto blocks = fit(path, exact, 2);
  ASSERT_EQ(blocks.size(), 3U);
  EXPECT_NEAR(blocks[0].duration, 0.1, 1e-9);
  EXPECT_TRUE(blocks[1].rests);
  EXPECT_NEAR(blocks[1].duration, 0.1, 1e-9);
  EXPECT_FALSE(blocks[2].rests);
}

TEST(BlockFitter, ABlockCarriesWhatIsExecutedAtItsEndAndIsNoLongerThanAllowed) {
  FitTolerance tolerance;
  tolerance.block_time_max = 0.01;
  std::uint64_t before = 0;
  for (const Block& block : fit(circle(), tolerance, 2)) {
    EXPECT_LE(block.duration, 0.01 + 1e-9);
    EXPECT_EQ(static_cast<double>(block.executed - before), std::round(block.duration * 1e3));
    before = block.executed;
  }
  EXPECT_EQ(before, 1570U);
}

}  // namespace
}  // namespace understudy::drivers
