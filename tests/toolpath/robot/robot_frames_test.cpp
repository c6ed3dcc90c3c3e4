#include "toolpath/robot/robot_frames.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::toolpath {
namespace {

constexpr double kPi = std::numbers::pi;

Mat3 abc(double a, double b, double c) { return rotation_abc(from_deg(a), from_deg(b), from_deg(c)); }

// KUKA's convention (KSS programming manual, "FRAME"): A about z, B about the new y, C about the new x.
TEST(RobotFrames, AnglesTurnAboutZThenTheNewYThenTheNewX) {
  EXPECT_TRUE((abc(90, 0, 0) * Vec3::UnitX()).isApprox(Vec3::UnitY(), 1e-12));
  EXPECT_TRUE((abc(0, 90, 0) * Vec3::UnitX()).isApprox(-Vec3::UnitZ(), 1e-12));
  EXPECT_TRUE((abc(0, 0, 90) * Vec3::UnitY()).isApprox(Vec3::UnitZ(), 1e-12));
  // The product of the three matrices, multiplied out elsewhere.
  Mat3 R;
  R << 0.663413948169, 0.105040461133, 0.740843056861,  //
      0.383022221559, 0.802872337479, -0.456825992586,  //
      -0.642787609687, 0.586824088833, 0.492403876506;
  EXPECT_TRUE(abc(30, 40, 50).isApprox(R, 1e-11)) << abc(30, 40, 50);
}

TEST(RobotFrames, AnglesOfARotationMakeItAgain) {
  for (const double a : {-170., -20., 0., 135.})
    for (const double b : {-90., -60., 0., 45., 90.})
      for (const double c : {-120., 0., 80.}) {
        const Mat3 R = abc(a, b, c);
        const Vec3 back = abc_of(R);
        EXPECT_TRUE(rotation_abc(back[0], back[1], back[2]).isApprox(R, 1e-9)) << a << " " << b << " " << c;
      }
}

double length_of(const Vec3& start, const std::vector<Vec3>& points) {
  double length = 0;
  Vec3 from = start;
  for (const Vec3& p : points) length += (p - from).norm(), from = p;
  return length;
}

TEST(RobotFrames, AnArcThroughThreePointsIsAsLongAsItIs) {
  // A circle of 10 mm about (5, 0, 2) in a plane that leans by 45 degrees.
  const Vec3 u(1, 0, 0), v(0, std::sqrt(0.5), std::sqrt(0.5)), centre(5e-3, 0, 2e-3);
  const auto at = [&](double angle) {
    return Vec3(centre + 10e-3 * (std::cos(angle) * u + std::sin(angle) * v));
  };
  const auto quarter = arc_through({at(0), at(kPi / 4), at(kPi / 2)}, std::nullopt, 2e-6);
  ASSERT_TRUE(quarter);
  // Chords 2 um inside are shorter by a third of 0.04 %.
  EXPECT_NEAR(length_of(at(0), quarter->ends), 5e-3 * kPi, 5e-3 * kPi * 2e-4);
  EXPECT_TRUE(quarter->ends.back().isApprox(at(kPi / 2), 1e-12));
  for (const Vec3& p : quarter->ends) EXPECT_NEAR((p - centre).norm(), 10e-3, 1e-12);
  const auto three_quarters = arc_through({at(0), at(kPi), at(1.5 * kPi)}, std::nullopt, 2e-6);
  ASSERT_TRUE(three_quarters);
  EXPECT_NEAR(length_of(at(0), three_quarters->ends), 15e-3 * kPi, 15e-3 * kPi * 2e-4);
}

TEST(RobotFrames, AnAngleTellsHowFarAnArcGoes) {
  const std::array<Vec3, 3> points{Vec3(10e-3, 0, 0), Vec3(0, 10e-3, 0), Vec3(-10e-3, 0, 0)};
  const auto whole = arc_through(points, 2 * kPi, 2e-6);
  ASSERT_TRUE(whole);
  EXPECT_NEAR(length_of(points[0], whole->ends), 20e-3 * kPi, 20e-3 * kPi * 2e-4);
  EXPECT_TRUE(whole->ends.back().isApprox(points[0], 1e-9));
  const auto back = arc_through(points, -kPi / 2, 2e-6);
  ASSERT_TRUE(back);
  EXPECT_NEAR(back->ends.back().y(), -10e-3, 1e-12) << "away from the point on the way";
}

// A hundred turns of a circle of 1e6 m, through points that nearly lie on a line, would take hundreds of
// millions of points.
TEST(RobotFrames, EndlessChordsAreCountedAndNotMade) {
  const auto endless = arc_through({Vec3(0, 0, 0), Vec3(50, 1e-3, 0), Vec3(100, 0, 0)}, 200 * kPi, 2e-6);
  ASSERT_TRUE(endless);
  EXPECT_TRUE(endless->too_many());
  EXPECT_GT(endless->count, 1e8);
  EXPECT_TRUE(endless->ends.empty());
}

TEST(RobotFrames, PointsOnALineMakeNoArc) {
  EXPECT_FALSE(arc_through({Vec3(0, 0, 0), Vec3(1e-3, 0, 0), Vec3(2e-3, 0, 0)}, std::nullopt, 2e-6));
  EXPECT_FALSE(arc_through({Vec3(0, 0, 0), Vec3(1e-3, 1e-3, 0), Vec3(0, 0, 0)}, std::nullopt, 2e-6));
}

}  // namespace
}  // namespace understudy::toolpath
