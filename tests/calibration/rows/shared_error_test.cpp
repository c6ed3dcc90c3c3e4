#include "calibration/rows/shared_error.h"

#include <gtest/gtest.h>

#include "tests/calibration/rows/drawn_rows.h"

namespace understudy::calibration {
namespace {

constexpr int kSets = 8;
constexpr double kShared = 3 * kDrawnSigma;  // so errors of one pose are correlated by 9 / 10

TEST(SharedError, WhatTargetsOfOnePoseHaveInCommonIsInTheUncertainty) {
  const auto columns = DrawnRows({}, 1).nominal.free_parameters(true, true);
  double error = 0, share = 0;
  for (int set = 1; set <= kSets; ++set) {
    DrawnRows lab(columns, static_cast<std::uint64_t>(set));
    lab.add_three_targets(kShared, 60);
    for (MeasurementRow& row : lab.problem.rows) row.noise_told = false, row.covariance.setZero();
    const RowCalibration found = calibrate_rows(lab.problem);
    ASSERT_TRUE(found.ok()) << found.message;
    error += lab.error_squared(found, columns) / kSets;
    share += found.shared / kSets;
  }
  // As independent rows: 2.7. The mean of 144 squares has a sigma of 0.12; the estimate of the share and the
  // noise, of 60 poses less 30 unknowns, adds a quarter.
  EXPECT_GT(error, 0.6);
  EXPECT_LT(error, 1.6);
  EXPECT_NEAR(share, 0.9, 0.1);
}

TEST(SharedError, IsNoneWhereTargetsAreIndependent) {
  const auto columns = DrawnRows({}, 1).nominal.free_parameters(true, true);
  DrawnRows lab(columns, 5);
  lab.add_three_targets(0, 60);
  const RowCalibration found = calibrate_rows(lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_EQ(found.shared, 0);
}

}  // namespace
}  // namespace understudy::calibration
