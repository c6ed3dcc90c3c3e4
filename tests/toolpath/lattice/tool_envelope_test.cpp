#include "toolpath/lattice/tool_envelope.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "core/units.h"
#include "tests/toolpath/lattice/arm_tool.h"

namespace understudy::toolpath {
namespace {

using test::tool_bodies;

TEST(ToolEnvelope, DistancesAreThoseOfTheConeAndTheHeater) {
  const ToolEnvelope tool(tool_bodies());
  EXPECT_NEAR(tool.distance(Vec3(0, 0, -2e-3)), 2e-3, 1e-15);       // below the flat
  EXPECT_NEAR(tool.distance(Vec3(3.5e-3, 0, -4e-3)), 5e-3, 1e-15);  // 3-4-5 from the flat's rim
  const double slope = std::atan2(3.0, 12.0);                       // of the cone's side
  EXPECT_NEAR(tool.distance(Vec3(3e-3, 0, 4e-3)), 1.5e-3 * std::cos(slope), 1e-12);  // cone 1.5 mm there
  EXPECT_NEAR(tool.distance(Vec3(0, 20e-3, 13e-3)), 20e-3 - 8e-3 * std::numbers::sqrt2,
              1e-12);  // circumscribed
  EXPECT_LT(tool.distance(Vec3(0, 0, 5e-3)), 0);
  EXPECT_NEAR(tool.radius(), 22e-3 * std::numbers::sqrt2, 1e-12);
  EXPECT_NEAR(tool.lowest(Vec3::UnitZ()), 0, 1e-15);
  // Leaning by 60 degrees the extruder's lower rim is lowest: 24 cos 60 - 31.1 sin 60.
  EXPECT_NEAR(tool.lowest(Vec3(std::sin(from_deg(60)), 0, 0.5)), 12e-3 - 22e-3 * std::sqrt(6.0) / 2, 1e-12);
}

TEST(ToolEnvelope, SweepsAgreeWithSampling) {
  Random random(7, "struts and motions");
  const ToolEnvelope tool(tool_bodies());
  const auto point = [&](double size) { return Vec3(size * uniform_vec3(random, 1)); };
  for (int trial = 0; trial < 60; ++trial) {
    const StrutBody strut{point(0.03), point(0.03), 0.24e-3};
    const ToolMotion motion{point(0.02), point(0.02), point(1).normalized()};
    const Mat3 R_TW = shortest_arc_from_z(motion.axis).toRotationMatrix().transpose();
    double sampled = 1;
    for (int i = 0; i <= 100; ++i)
      for (int j = 0; j <= 100; ++j) {
        const Vec3 p = strut.from + (strut.to - strut.from) * i / 100;
        const Vec3 tip = motion.from + (motion.to - motion.from) * j / 100;
        sampled = std::min(sampled, tool.distance(R_TW * (p - tip)) - strut.radius);
      }
    // Half a grid step of both: 0.01 of at most 104 mm and 70 mm, halved.
    const double grid = 0.005 * ((strut.to - strut.from).norm() + (motion.to - motion.from).norm());
    const double distance = tool.distance(strut, motion, 20e-6);
    EXPECT_LE(distance, sampled + 1e-12) << trial;
    EXPECT_GE(distance, sampled - grid - 40e-6) << trial;
    EXPECT_TRUE(tool.clears(strut, motion, distance - 21e-6)) << trial;
    EXPECT_FALSE(tool.clears(strut, motion, sampled + 1e-9)) << trial;
  }
}

TEST(ToolEnvelope, LiftedItHoldsWhatItSweepsOnItsWayOut) {
  Random random(11, "lifted");
  const ToolEnvelope tool(tool_bodies()), lifted = tool.lifted();
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 p = 0.05 * uniform_vec3(random, 1) + Vec3(0, 0, 0.02);
    double least = tool.distance(p);
    for (int k = 1; k <= 2000; ++k) least = std::min(least, tool.distance(p - Vec3(0, 0, k * 0.1e-3)));
    if (least > 0)
      EXPECT_NEAR(lifted.distance(p), least, 0.05e-3) << trial;
    else
      EXPECT_LE(lifted.distance(p), 0) << trial;
  }
}

TEST(ToolEnvelope, PressCountsToTheNozzleAlone) {
  const ToolEnvelope plain(tool_bodies()), pressing(tool_bodies(), 0.1e-3);
  EXPECT_NEAR(pressing.distance(Vec3(0, 0, -2e-3)), 2.1e-3, 1e-12);
  EXPECT_NEAR(pressing.distance(Vec3(0, 20e-3, 17e-3)), plain.distance(Vec3(0, 20e-3, 17e-3)), 1e-15);
}

TEST(ToolEnvelope, TurnsAgreeWithSampling) {
  Random random(13, "turns");
  const ToolEnvelope tool(tool_bodies());
  int clear = 0, near = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 from = uniform_vec3(random, 1).normalized(), to = uniform_vec3(random, 1).normalized();
    const StrutBody strut{0.08 * uniform_vec3(random, 1), 0.08 * uniform_vec3(random, 1), 0.24e-3};
    double sampled = 1;
    for (int k = 0; k <= 200; ++k) {
      const Quat turned = Quat::Identity().slerp(k / 200.0, Quat::FromTwoVectors(from, to));
      const Mat3 R_TW = shortest_arc_from_z(turned * from).toRotationMatrix().transpose();
      for (int i = 0; i <= 100; ++i)
        sampled = std::min(
            sampled, tool.distance(R_TW * (strut.from + (strut.to - strut.from) * i / 100)) - strut.radius);
    }
    const bool clears = tool.clears_turn(strut, Vec3::Zero(), from, to, 0.1e-3);
    EXPECT_TRUE(!clears || sampled > 0.1e-3) << trial << ": " << sampled;
    // A degree of the far end, 99 mm from the tip, is 1.7 mm; 0.8 mm of the strut between two samples.
    EXPECT_TRUE(clears || sampled < 0.1e-3 + 2 * 1.75e-3 + 0.8e-3) << trial << ": " << sampled;
    (clears ? clear : near)++;
  }
  EXPECT_GT(clear, 20);
  EXPECT_GT(near, 20);
}

}  // namespace
}  // namespace understudy::toolpath
