#include "toolpath/gcode/curves/gcode_spline.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::toolpath {
namespace {

using ::testing::HasSubstr;

constexpr double kTolerance = 2e-6;  // [m], of chords

/// By repeated halves (de Casteljau), another way than by powers.
Vec3 on_curve(std::array<Vec3, 4> p, double t) {
  for (std::size_t n = 3; n > 0; --n)
    for (std::size_t i = 0; i < n; ++i) p[i] += t * (p[i + 1] - p[i]);
  return p[0];
}

double distance_to_chords(const Vec3& p, Vec3 from, const std::vector<Vec3>& ends) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3& to : ends) {
    const Vec3 along = to - from;
    const double share =
        along.norm() > 0 ? std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
    nearest = std::min(nearest, (p - from - share * along).norm());
    from = to;
  }
  return nearest;
}

std::vector<Step> parse(const std::string& text) { return parse_gcode(text, "p.gcode", {}).steps; }

std::string rejection(const std::string& text) {
  try {
    parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(GcodeSpline, ChordsStayWithinTheToleranceOfTheCurve) {
  const std::array<Vec3, 4> control{Vec3(0, 0, 0), Vec3(0, 0.03, 0), Vec3(0.01, -0.02, 0),
                                    Vec3(0.01, 0.01, 0)};
  const auto ends = spline_points(control, kTolerance);
  EXPECT_EQ(ends.back(), control[3]);
  double farthest = 0;
  for (int i = 0; i <= 5000; ++i)
    farthest = std::max(farthest, distance_to_chords(on_curve(control, i / 5000.0), control[0], ends));
  EXPECT_LE(farthest, kTolerance);
  EXPECT_GT(farthest, kTolerance / 10) << "not many times too fine";
  EXPECT_EQ(spline_points({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)}, kTolerance).size(),
            1u)
      << "straight";
}

// Marlin, "G5 - Bezier cubic spline", example: a curvy N. Its y is 9t - 24t^2 + 16t^3: 1 at t = 1/4, 0 at
// 3/4.
TEST(GcodeSpline, ReadsTheCurvyNOfMarlin) {
  const auto steps = parse("G0 X0 Y0\nG5 I0 J3 P0 Q-3 X1 Y1 E1 F600\n");
  double highest = 0, lowest_after = 1, filament = 0;
  for (const Step& step : steps) {
    const Vec3 p = step.X_WT.translation() * 1e3;
    highest = std::max(highest, p.y());
    if (p.x() > 0.5) lowest_after = std::min(lowest_after, p.y());
    filament += step.filament;
  }
  EXPECT_NEAR(highest, 1, 2e-3);
  EXPECT_NEAR(lowest_after, 0, 2e-3);
  EXPECT_NEAR(filament, 1e-3, 1e-15);
  EXPECT_LT((steps.back().X_WT.translation() - Vec3(1e-3, 1e-3, 0)).norm(), 1e-15);
  EXPECT_EQ(steps.back().kind, StepKind::print);
}

// "A second curvy N that attaches smoothly to this one can now be made without specifying I and J."
TEST(GcodeSpline, GoesOnSmoothlyWithoutIJ) {
  const std::string first = "G0 X0 Y0\nG5 I0 J3 P0 Q-3 X1 Y1 F600\n";
  const auto joined = parse(first + "G5 P0 Q-3 X2 Y2\n"), whole = parse(first + "G5 I0 J3 P0 Q-3 X2 Y2\n");
  ASSERT_EQ(joined.size(), whole.size());
  for (std::size_t i = 0; i < joined.size(); ++i)
    EXPECT_EQ(joined[i].X_WT.translation(), whole[i].X_WT.translation()) << i;
  EXPECT_THAT(rejection("G5 P0 Q-3 X2 Y2 F600"), HasSubstr("unless it follows another"));
  EXPECT_THAT(rejection(first + "G1 X5\nG5 P0 Q-3 X2 Y2"), HasSubstr("unless it follows another"));
  EXPECT_THAT(rejection("G5 I0 P0 Q-3 X2 Y2 F600"), HasSubstr("unless it follows another"));
  EXPECT_THAT(rejection("G5 I0 J0 P0 X2 Y2 F600"), HasSubstr("needs P Q"));
  EXPECT_THAT(rejection("G5 I0 J0 P0 Q0 X2 Z2 F600"), HasSubstr("'Z2': a spline (G5) lies in the plane XY"));
  EXPECT_THAT(rejection("G5 I0 J0 P0 Q0 X2"), HasSubstr("without a feed"));
  EXPECT_THAT(rejection("G5 I200000 J0 P0 Q0 X2 F600"), HasSubstr("'I200000' is beyond 100000 mm"));
}

}  // namespace
}  // namespace understudy::toolpath
