// The planner on long programs: windows, memory, work.
#include <gtest/gtest.h>

#include <ctime>

#include "control/motion/speed_profile.h"
#include "core/random_vector.h"
#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

using toolpath::Step;

constexpr double kRadius = 0.015;  // [m]

// Tiny steps round and round a circle, tool leaning a little with the way.
Step step_on_circle(const HexapodForTest& hexapod, int n, double chord, double feed) {
  const double angle = n * chord / kRadius;
  const Vec3 p = kRadius * Vec3(std::sin(angle), 1 - std::cos(angle), 0);
  return hexapod.print_to(hexapod.at(p, 0.1 * Vec3(std::sin(angle), std::sin(2 * angle), 0)), feed, n,
                          1e-6 * (1 + n % 7));
}

struct Streamed {
  std::size_t points = 0;
  std::size_t ready_before_finish = 0;
  std::size_t lag_max = 0;  // steps pushed beyond the one that points serve
  double cpu = 0;           // [s]
  PlannedPoint last;
};

Streamed stream_circle(const HexapodForTest& hexapod, int steps, double chord, double feed) {
  Streamed s;
  MotionPlanner planner = hexapod.planner(1.0);
  const std::clock_t begin = std::clock();
  for (int n = 1; n <= steps; ++n) {
    planner.push(step_on_circle(hexapod, n, chord, feed));
    while (planner.next(s.last)) {
      ++s.points;
      EXPECT_EQ(s.last.setpoint.time, 1.0 + static_cast<double>(s.points) * hexapod.limits.cycle_time);
    }
    s.lag_max = std::max(s.lag_max, static_cast<std::size_t>(n) - s.last.step);
  }
  s.ready_before_finish = s.points;
  planner.finish();
  while (planner.next(s.last)) ++s.points;
  s.cpu = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return s;
}

TEST(MotionPlannerStream, HundredThousandTinyStepsRunAtTheFeedToTheEnd) {
  const HexapodForTest hexapod;
  constexpr int kSteps = 100'000;
  const double chord = 5e-6, feed = 0.010;  // two steps a cycle
  const Streamed s = stream_circle(hexapod, kSteps, chord, feed);
  // The chord of an arc is short of it by 1e-8; leaning costs no tip speed.
  const double duration = kSteps * chord / feed + feed / hexapod.limits.tip_acceleration;
  EXPECT_NEAR(s.last.setpoint.time - 1.0, duration, 0.01 * duration);
  double filament = 0;
  for (int n = 1; n <= kSteps; ++n) filament += 1e-6 * (1 + n % 7);
  EXPECT_EQ(s.last.setpoint.filament, filament);  // exactly: every step's filament once, in order
  EXPECT_TRUE(s.last.X_WT.matrix() == step_on_circle(hexapod, kSteps, chord, feed).X_WT.matrix());
  for (const double v : s.last.setpoint.velocity) EXPECT_EQ(v, 0);
  // Points come while steps go in, and what waits is bounded by the window: 8192 pieces, two to a step.
  EXPECT_GT(s.ready_before_finish, s.points * 9 / 10);
  EXPECT_LE(s.lag_max, 8192u);
}

TEST(MotionPlannerStream, WorkGrowsLinearly) {
  const HexapodForTest hexapod;
  stream_circle(hexapod, 5'000, 5e-6, 0.010);  // warm
  const double one = stream_circle(hexapod, 20'000, 5e-6, 0.010).cpu;
  const double four = stream_circle(hexapod, 80'000, 5e-6, 0.010).cpu;
  EXPECT_LT(four, 8 * one);  // quadratic work would be 16; the rest is for a busy machine
}

// The planned stop at the window's end must never be felt: 2 m of straight moves there and back at travel
// speed take as long as their lengths say.
TEST(MotionPlannerStream, WindowsDoNotSlowALongPath) {
  const HexapodForTest hexapod;
  const double feed = 0.030;
  const Streamed s = stream_circle(hexapod, 10'000, 1e-4, feed);  // 1 m of path, five windows
  const double duration = 1.0 / feed + feed / hexapod.limits.tip_acceleration;
  EXPECT_NEAR(s.last.setpoint.time - 1.0, duration, 0.005);  // chords of 0.1 mm on 15 mm are short by 2e-6
}

TEST(MotionPlannerStream, TakingLateOrEarlyGivesTheSameMotion) {
  const HexapodForTest hexapod;
  Random random(31, "zigzag");
  std::vector<Step> steps;
  for (int n = 1; n <= 400; ++n) {
    const Vec3 p = uniform_vec3(random, 0.01);
    steps.push_back(hexapod.print_to(hexapod.at(p), 0.05, n, 1e-4));
  }
  MotionPlanner early = hexapod.planner(), late = hexapod.planner();
  const auto points = stream(early, steps);
  for (const auto& step : steps) late.push(step);
  late.finish();
  std::vector<PlannedPoint> all;
  take_all(late, all);
  ASSERT_EQ(points.size(), all.size());
  // Windows end elsewhere, but far ahead of what is handed out: the plans agree to rounding summed over the
  // path.
  for (std::size_t n = 0; n < all.size(); ++n)
    ASSERT_LE((points[n].X_WT.translation() - all[n].X_WT.translation()).norm(), 1e-9) << n;
}

}  // namespace
}  // namespace understudy::control
