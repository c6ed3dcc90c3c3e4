// Changes of speed that drives take at once at corners, and what they make of a print's time.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "control/motion/constraint_check.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/control/five_axis_for_test.h"

namespace understudy::control {
namespace {

/// [s] of two legs of `leg` with a right angle between them, from rest to rest: ramps at the tip's
/// acceleration, the corner at `corner`.
double two_legs(double leg, double feed, double corner, double acceleration) {
  const double ramps = feed / acceleration + (feed - corner) / acceleration;
  const double way = (2 * feed * feed - corner * corner) / (2 * acceleration);
  return 2 * (ramps + (leg - way) / feed);
}

TEST(VelocityJump, ARightAngleIsPassedAtTheJumpAndTakesTheTimeOfItsRamps) {
  FiveAxisForTest printer;
  const double feed = 0.050, a = printer.limits.tip_acceleration, dt = printer.limits.cycle_time;
  ASSERT_EQ(printer.limits.velocity_jump[0], 0.008);
  const std::string text = "G1 X40 F3000\nG1 Y40\n";
  // Half of what the axis' acceleration gives in a cycle comes on top.
  const double jump = 0.008 + 0.5 * printer.limits.axis_acceleration[0] * dt;
  EXPECT_NEAR(printer.plan(text).back().setpoint.time, two_legs(0.040, feed, jump, a), 3e-3);
  // Without jumps the tip crawls round at half of a dt over sqrt 2, 0.35 mm/s: two ramps lose 9 ms each.
  const double crawl = 0.5 * a * dt / std::numbers::sqrt2;
  printer.limits.velocity_jump.fill(0);
  EXPECT_GT(printer.plan(text).back().setpoint.time, two_legs(0.040, feed, crawl, a) - 3e-3);
  EXPECT_GT(two_legs(0.040, feed, crawl, a) - two_legs(0.040, feed, jump, a), 0.015);  // told apart
}

TEST(VelocityJump, AnAxisWithoutAJumpStillHoldsTheCornerDown) {
  FiveAxisForTest printer;
  printer.limits.velocity_jump[1] = 0;
  const double corner = 0.5 * printer.limits.axis_acceleration[1] * printer.limits.cycle_time;
  EXPECT_NEAR(printer.plan("G1 X40 F3000\nG1 Y40\n").back().setpoint.time,
              two_legs(0.040, 0.050, corner, printer.limits.tip_acceleration), 3e-3);
}

// Filament that is drawn back and fed again with the tool at rest; 2 mm at 40 mm/s take 50 ms.
TEST(VelocityJump, ARestIsReachedAndLeftAtTheJump) {
  FiveAxisForTest printer;
  const double feed = 0.050, a = printer.limits.tip_acceleration, jump = printer.limits.velocity_jump[0];
  const std::string leg = "G1 X20 F3000\n", back = "G1 X40 F3000\n";
  const auto legs = [&](double speed) { return two_legs(0.020, feed, speed, a); };
  EXPECT_NEAR(printer.plan(leg + "G1 E-2 F2400\n" + back).back().setpoint.time, legs(jump) + 0.050, 3e-3);
  EXPECT_GT(legs(0) - legs(jump), 0.01);  // told apart
  // Shorter than a cycle, it could have both jumps in one.
  EXPECT_NEAR(printer.plan(leg + "G1 E-0.02 F2400\n" + back).back().setpoint.time, legs(0) + 0.5e-3, 3e-3);
  printer.limits.velocity_jump.fill(0);
  EXPECT_NEAR(printer.plan(leg + "G1 E-2 F2400\n" + back).back().setpoint.time, legs(0) + 0.050, 3e-3);
}

TEST(VelocityJump, NoCycleChangesAnAxisByMoreThanItsJumpAndItsAccelerationHoweverDenseTheCorners) {
  const FiveAxisForTest printer;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    Random random(seed, "corners");
    std::string text = "G1 F9000\n";
    double x = 0, y = 0, b = 0, c = 0;
    for (int k = 0; k < 400; ++k) {
      const double way = random.uniform(0.01, k % 20 == 0 ? 5 : 0.3), angle = random.uniform(0, 6.28);
      x += way * std::cos(angle), y += way * std::sin(angle);
      if (k % 3 == 0) b = random.uniform(-2, 2), c += random.uniform(-2, 2);
      text += fmt::format("G1 X{:.4f} Y{:.4f} B{:.3f} C{:.3f}\n", x, y, b, c);
    }
    const auto points = printer.plan(text);
    std::array<double, 5> most{};
    for (std::size_t k = 1; k < points.size(); ++k)
      for (std::size_t i = 0; i < 5; ++i) {
        const double change = std::abs(points[k].setpoint.velocity[i] - points[k - 1].setpoint.velocity[i]);
        const double may =
            printer.limits.axis_acceleration[i] * printer.limits.cycle_time + printer.limits.velocity_jump[i];
        // Slopes are linear over a piece to 1e-4 of their change.
        ASSERT_LE(change, 1.001 * may)
            << "seed " << seed << " axis " << i << " at " << points[k].setpoint.time;
        most[i] = std::max(most[i], change / may);
      }
    EXPECT_GT(std::max(most[0], most[1]), 0.5) << seed;  // the jumps are used
  }
}

TEST(VelocityJump, NegativeOnesAreRefused) {
  FiveAxisForTest printer;
  printer.limits.velocity_jump[2] = -1;
  EXPECT_THAT([&] { printer.plan("G1 X1 F60\n"); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("velocity jump is -1")));
}

/// [s] of a slicer's comment "; estimated printing time (normal mode) = 1h 16m 11s".
double slicers_estimate(const std::string& text) {
  const std::string key = "; estimated printing time (normal mode) = ";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) return 0;
  double seconds = 0, number = 0;
  for (const char ch : text.substr(at + key.size(), text.find('\n', at) - at - key.size())) {
    if (ch >= '0' && ch <= '9') number = 10 * number + (ch - '0');
    const double unit = ch == 'd' ? 86400 : ch == 'h' ? 3600 : ch == 'm' ? 60 : ch == 's' ? 1 : 0;
    if (unit > 0) seconds += unit * std::exchange(number, 0);
  }
  return seconds;
}

TEST(VelocityJump, ASlicedProgramTakesTheSlicersTimeWithinThreePercent) {
  const std::string path = UNDERSTUDY_SOURCE_DIR "/scenarios/planar/box.gcode";
  const double estimate = slicers_estimate(read_file(path));
  ASSERT_GT(estimate, 600);
  const FiveAxisForTest printer;
  const auto program = toolpath::read_gcode(path, printer.gcode());
  const auto report = check_constraints(program, printer.machine);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_NEAR(report.duration, estimate, 0.03 * estimate);
  RecordProperty("planned_s", fmt::format("{:.1f}", report.duration));
}

}  // namespace
}  // namespace understudy::control
