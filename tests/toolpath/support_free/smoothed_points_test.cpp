#include "toolpath/support_free/smoothed_points.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr double kRadius = 30e-3;

std::vector<Vec3> arc(int count, double ripple = 0) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double a = i / kRadius * 1e-3, r = kRadius + (i % 2 == 0 ? ripple : -ripple);
    points.emplace_back(r * std::cos(a), 0, r * std::sin(a));
  }
  return points;
}

double roughest_turn(const std::vector<Vec3>& points) {
  double least = 1, most = 0;
  for (std::size_t i = 6; i + 6 < points.size(); ++i) {
    const Vec3 a = points[i] - points[i - 1], b = points[i + 1] - points[i];
    const double turn = std::atan2(a.cross(b).norm(), a.dot(b));
    least = std::min(least, turn);
    most = std::max(most, turn);
  }
  return most - least;
}

// 8 um to and fro, as a mesh whose rings are 2 mm apart has them on an arc of 30 mm: turns of 1 mm / 30 mm
// are 1.9 degrees +- 1.8; smoothed they are within a twentieth of
// it. The ends of the row stay where the ripple has them, 8 um off, which bends the rest by some 2 um.
TEST(SmoothedPoints, TakeOutWhatFacetsMakeOfAnArc) {
  const auto points = arc(60, 8e-6);
  EXPECT_GT(roughest_turn(points), 0.03);
  const auto smooth = smoothed_points(points, 20e-6);
  EXPECT_LT(roughest_turn(smooth), 0.05 * 1e-3 / kRadius);
  for (std::size_t i = 5; i + 5 < smooth.size(); ++i) EXPECT_NEAR(smooth[i].norm(), kRadius, 3e-6) << i;
}

TEST(SmoothedPoints, StayWithinTheToleranceAndKeepTheEnds) {
  std::vector<Vec3> bend;  // a corner, which no smooth line follows
  for (int i = 0; i <= 20; ++i) bend.emplace_back(std::max(0, i - 10) * 1e-3, 0, std::min(i, 10) * 1e-3);
  for (const double tolerance : {0.0, 5e-6, 50e-6}) {
    const auto smooth = smoothed_points(bend, tolerance);
    double farthest = 0;
    for (std::size_t i = 0; i < bend.size(); ++i) farthest = std::max(farthest, (smooth[i] - bend[i]).norm());
    EXPECT_LE(farthest, tolerance + 1e-12);
    EXPECT_GE(farthest, 0.9 * tolerance);  // the smoothest within it touches it
    EXPECT_EQ(smooth.front(), bend.front());
    EXPECT_EQ(smooth.back(), bend.back());
  }
}

// The third differences of an arc in steps of h are h^3 / r^2 long: that alone may move it.
TEST(SmoothedPoints, LeaveAnEvenArcAsItIs) {
  const auto points = arc(60);
  const auto smooth = smoothed_points(points, 20e-6);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_LT((smooth[i] - points[i]).norm(), 20e-6) << i;
  EXPECT_EQ(smoothed_points({Vec3(0, 0, 0), Vec3(0, 0, 1)}, 1).size(), 2u);
}

}  // namespace
}  // namespace understudy::toolpath
