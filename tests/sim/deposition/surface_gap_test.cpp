#include "sim/deposition/surface_gap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/geometry/test_solids.h"

namespace understudy::sim {
namespace {

// Closed boxes, each from `lower` to `upper`, in one mesh.
geometry::Mesh boxes(const std::vector<std::pair<Vec3, Vec3>>& corners) {
  const geometry::Triangles t = geometry::boxes(corners);
  return {t.vertices, t.triangles};
}

Pose over(double x, double height, double tilt = 0) {
  return make_pose(exp_rotation(Vec3(0, tilt, 0)), Vec3(x, 0.3e-3, height));
}

// To the nearer of part and table.
double gap_below(const geometry::Mesh* part, const Pose& X_WT) {
  const Vec3 tip = X_WT.translation(), axis = tool_axis(X_WT);
  const double table = table_gap({}, tip, axis).gap;
  return part ? std::min(table, part_gap(*part, tip, axis).gap) : table;
}

// Rounding of coordinates below 0.1 m, twice.
constexpr double kRounding = 1e-15;

TEST(SurfaceGap, IsAlongTheToolAxis) {
  const auto plate = boxes({{Vec3(-0.05, -0.05, 0), Vec3(0.05, 0.05, 0.02)}});
  for (const double tilt_deg : {0.0, 10.0, 20.0, 30.0}) {
    const double tilt = from_deg(tilt_deg);
    for (const double height : {0.15e-3, 2e-3, 1e-6, -0.05e-3, -1e-3}) {
      EXPECT_NEAR(gap_below(&plate, over(1e-3, 0.02 + height, tilt)), height / std::cos(tilt), kRounding);
      EXPECT_NEAR(gap_below(nullptr, over(1e-3, height, tilt)), height / std::cos(tilt), kRounding)
          << "the table";
    }
  }
}

TEST(SurfaceGap, TouchingIsZero) {
  const auto plate = boxes({{Vec3(-0.05, -0.05, 0), Vec3(0.05, 0.05, 0.02)}});
  EXPECT_NEAR(gap_below(&plate, over(1e-3, 0.02)), 0, kRounding);
}

TEST(SurfaceGap, DeepInsideIsTheWayOut) {
  const auto block = boxes({{Vec3(-0.05, -0.05, 0), Vec3(0.05, 0.05, 0.04)}});
  EXPECT_NEAR(gap_below(&block, over(1e-3, 0.01)), -0.03, kRounding);
}

TEST(SurfaceGap, ARoofAboveTheTipDoesNotCount) {
  // A shelf 1 mm above the floor's tip, and one in which the ray starts.
  const auto shelf = boxes({{Vec3(-0.05, -0.05, 0), Vec3(0.05, 0.05, 0.01)},
                            {Vec3(-0.05, -0.05, 0.012), Vec3(0.05, 0.05, 0.013)}});
  EXPECT_NEAR(gap_below(&shelf, over(1e-3, 0.0101)), 0.1e-3, kRounding);
  EXPECT_NEAR(gap_below(&shelf, over(1e-3, 0.0099)), -0.1e-3, kRounding);
  const auto roof = boxes(
      {{Vec3(-0.05, -0.05, 0), Vec3(0.05, 0.05, 0.01)}, {Vec3(-0.05, -0.05, 0.012), Vec3(0.05, 0.05, 0.03)}});
  EXPECT_NEAR(gap_below(&roof, over(1e-3, 0.0101)), 0.1e-3, kRounding);
  EXPECT_NEAR(gap_below(&roof, over(1e-3, 0.0125)), -17.5e-3, kRounding) << "inside the roof";
}

TEST(SurfaceGap, UnderARoofWithNothingBelowItIsInfinite) {
  const auto roof = boxes({{Vec3(-0.05, -0.05, 0.081), Vec3(0.05, 0.05, 0.082)}});
  EXPECT_TRUE(std::isinf(gap_below(&roof, over(1e-3, 0.08))));
}

TEST(SurfaceGap, TheTableIsMetWhereThePartIsNot) {
  const auto plate = boxes({{Vec3(-0.01, -0.01, 0.001), Vec3(0.01, 0.01, 0.02)}});
  EXPECT_NEAR(gap_below(&plate, over(0.02, 0.003)), 0.003, kRounding);
  EXPECT_NEAR(gap_below(&plate, over(0.0, 0.003)), -0.017, kRounding);
}

TEST(SurfaceGap, NothingWithinFiftyMillimetresIsInfinite) {
  EXPECT_TRUE(std::isinf(gap_below(nullptr, over(0, 0.0501))));
  EXPECT_NEAR(gap_below(nullptr, over(0, 0.0499)), 0.0499, kRounding);
  EXPECT_TRUE(std::isinf(gap_below(nullptr, over(0, 0.01, std::numbers::pi)))) << "the tool looks up";
  const auto plate = boxes({{Vec3(-0.05, -0.05, 0.1), Vec3(0.05, 0.05, 0.12)}});
  EXPECT_NEAR(gap_below(&plate, over(0, 0.1699)), 0.0499, kRounding);
  EXPECT_TRUE(std::isinf(gap_below(&plate, over(0, 0.1701))));
}

}  // namespace
}  // namespace understudy::sim
