// Rows that are off by 5 mm or 2 deg: named, left out, and of no consequence.
#include "calibration/rows/row_outliers.h"

#include <gmock/gmock.h>

#include "core/units.h"
#include "tests/calibration/rows/drawn_rows.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Pose kBoard = make_pose(exp_rotation({0.4, 0.2, -1.0}), {-0.05, 0.02, 0.03});
const Vec3 kBall(0.03, -0.04, 0.06);

struct Set {
  const char* name;
  const char* machine;
  RowKind kind;
  int rows;
};

DrawnRows drawn(const Set& set, std::uint64_t seed) {
  const auto columns = DrawnRows({}, 1, set.machine).nominal.free_parameters(true, true);
  DrawnRows lab(columns, seed, set.machine);
  if (set.kind == RowKind::distance) {
    lab.add_distances("post", {0.6, 0.3, -0.2}, 0.0, kBall, set.rows / 2);
    lab.add_distances("other", {-0.5, 0.7, 0.4}, 0.0, kBall, set.rows - set.rows / 2);
  } else {
    lab.add_in_frame(set.kind, "board", kBoard, set.rows);
  }
  return lab;
}

/// Every 20th row, each in a direction of its own.
std::vector<std::size_t> spoil(DrawnRows& lab, std::size_t first, double length = 5e-3) {
  std::vector<std::size_t> rows;
  for (std::size_t j = first; j < lab.problem.rows.size(); j += 20) {
    MeasurementRow& row = lab.problem.rows[j];
    const Vec3 along = lab.noise(1).normalized();
    row.distance += length;
    if (row.kind == RowKind::orientation)
      row.X_MG.linear() = exp_rotation(2 * kDegree * along) * row.X_MG.linear();
    else
      row.X_MG.translation() += length * along;
    rows.push_back(j);
  }
  return rows;
}

std::vector<std::size_t> named(const RowCalibration& found) {
  std::vector<std::size_t> rows;
  for (const SpoiledRow& row : found.spoiled) rows.push_back(row.row);
  return rows;
}

RowProblem without(RowProblem problem, const std::vector<std::size_t>& rows) {
  for (auto row = rows.rbegin(); row != rows.rend(); ++row)
    problem.rows.erase(problem.rows.begin() + static_cast<std::ptrdiff_t>(*row));
  return problem;
}

class SpoiledRows : public ::testing::TestWithParam<Set> {};

TEST_P(SpoiledRows, AreNamedAndChangeNothing) {
  for (const bool told : {true, false}) {
    DrawnRows lab = drawn(GetParam(), 4);
    const auto rows = spoil(lab, 7);
    for (MeasurementRow& row : lab.problem.rows)
      if (!told) row.covariance.setZero(), row.noise_told = false;
    const RowCalibration found = calibrate_rows(lab.problem);
    ASSERT_TRUE(found.ok()) << found.message;
    EXPECT_EQ(named(found), rows);
    for (const SpoiledRow& row : found.spoiled) {
      EXPECT_GT(row.sigmas, 5);
      if (GetParam().kind == RowKind::orientation)
        EXPECT_NEAR(row.turn, 2 * kDegree, 0.2 * kDegree);
      else
        EXPECT_NEAR(row.length, 5e-3, 1e-3);
    }
    const RowCalibration clean = calibrate_rows(without(lab.problem, rows));
    ASSERT_TRUE(clean.ok()) << clean.message;
    EXPECT_EQ(found.degrees_of_freedom, clean.degrees_of_freedom);
    for (Eigen::Index k = 0; k < clean.changes.size(); ++k)
      EXPECT_NEAR(found.changes[k], clean.changes[k], 0.02 * std::sqrt(clean.covariance(k, k)));
  }
}

// 20 sets of 80 to 160 rows: 0.002 rows are expected to go.
TEST_P(SpoiledRows, AreNoneWhereNothingIsSpoiled) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    DrawnRows lab = drawn(GetParam(), seed);
    if (seed % 2 == 0)
      for (MeasurementRow& row : lab.problem.rows) row.covariance.setZero(), row.noise_told = false;
    const RowCalibration found = calibrate_rows(lab.problem);
    ASSERT_TRUE(found.ok()) << found.message;
    EXPECT_THAT(named(found), IsEmpty()) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(CalibrateRows, SpoiledRows,
                         ::testing::Values(Set{"ArmPoses", "arm", RowKind::pose, 60},
                                           Set{"ArmPositions", "arm", RowKind::position, 80},
                                           Set{"ArmOrientations", "arm", RowKind::orientation, 80},
                                           Set{"ArmDistances", "arm", RowKind::distance, 160},
                                           Set{"HexapodPoses", "hexapod", RowKind::pose, 60},
                                           Set{"HexapodPositions", "hexapod", RowKind::position, 80}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(RowOutliers, AnEchoMetresAwayDoesNotHideTheFrame) {
  DrawnRows lab = drawn({"", "arm", RowKind::position, 60}, 4);
  const auto rows = spoil(lab, 7, 3.0);
  lab.problem.rows[20].X_MG.translation().setZero();  // a beam that was broken
  const RowCalibration found = calibrate_rows(lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_THAT(named(found), ::testing::ElementsAre(rows[0], 20u, rows[1], rows[2]));
}

// A fifth of the rows, all in the same direction, as of a target that was taken for another: a fit of all
// rows is drawn towards them.
TEST(RowOutliers, AFifthOfTheRowsInOneDirectionIsFound) {
  DrawnRows lab = drawn({"", "arm", RowKind::position, 80}, 4);
  std::vector<std::size_t> rows;
  for (std::size_t j = 2; j < lab.problem.rows.size(); j += 5) {
    lab.problem.rows[j].X_MG.translation() += Vec3(0, 3e-3, 4e-3);
    rows.push_back(j);
  }
  for (MeasurementRow& row : lab.problem.rows) row.covariance.setZero(), row.noise_told = false;
  const RowCalibration found = calibrate_rows(lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_EQ(named(found), rows);
}

TEST(RowOutliers, MoreThanAQuarterIsRefused) {
  DrawnRows lab = drawn({"", "arm", RowKind::position, 80}, 4);
  for (const std::size_t first : {0u, 3u, 6u, 9u, 12u, 15u}) spoil(lab, first);
  const RowCalibration found = calibrate_rows(lab.problem);
  EXPECT_EQ(found.status, Status::not_converged);
  EXPECT_THAT(found.message, HasSubstr("of 80 rows do not agree with the others, more than a quarter"));
}

// A point that one row alone visits says nothing about that row.
TEST(RowOutliers, WhatNoOtherRowTellsIsNotCalledSpoiled) {
  DrawnRows lab = drawn({"", "arm", RowKind::position, 60}, 4);
  lab.add_points("once", {0.3, 0.2, 0.2}, kBall, 1);
  lab.problem.rows.back().target = "board";
  const RowCalibration found = calibrate_rows(lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_THAT(named(found), IsEmpty());
}

TEST(RowOutliers, TheLimitsAreOneInAMillion) {
  // 1 - P of chi-square in closed form: erfc(sqrt(x/2)), that + sqrt(2x/pi) e^(-x/2), e^(-x/2)(1 + x/2 +
  // x^2/8).
  const double one = spoiled_from(RowKind::distance), three = spoiled_from(RowKind::position),
               six = spoiled_from(RowKind::pose);
  EXPECT_NEAR(std::erfc(std::sqrt(one / 2)), kRowSpoiled, 0.01 * kRowSpoiled);
  EXPECT_NEAR(
      std::erfc(std::sqrt(three / 2)) + std::sqrt(2 * three / std::numbers::pi) * std::exp(-three / 2),
      kRowSpoiled, 0.01 * kRowSpoiled);
  EXPECT_NEAR(std::exp(-six / 2) * (1 + six / 2 + six * six / 8), kRowSpoiled, 0.01 * kRowSpoiled);
}

}  // namespace
}  // namespace understudy::calibration
