#include "calibration/machine/axis_signs.h"

#include <gtest/gtest.h>

#include "tests/calibration/rows/drawn_rows.h"

namespace understudy::calibration {
namespace {

DrawnRows measured() {
  DrawnRows lab(DrawnRows({}, 1).nominal.free_parameters(true, true), 3);
  lab.add_three_targets(0, 40);
  return lab;
}

TEST(AxisSigns, AnAxisThatCountsTheOtherWayIsNamed) {
  RowProblem problem = measured().problem;
  for (MeasurementRow& row : problem.rows) row.axes[5] *= -1;
  const auto turned = turned_axis(problem, calibrate_rows(problem));
  ASSERT_TRUE(turned);
  EXPECT_EQ(turned->name, "j6");
  EXPECT_LT(turned->after, 3 * kDrawnSigma);
  EXPECT_GT(turned->before, 2e-3);
}

TEST(AxisSigns, ASoundCalibrationIsNotLookedAt) {
  const RowProblem problem = measured().problem;
  EXPECT_FALSE(turned_axis(problem, calibrate_rows(problem)));
}

}  // namespace
}  // namespace understudy::calibration
