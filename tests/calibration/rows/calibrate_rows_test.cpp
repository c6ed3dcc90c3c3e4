// Is the stated covariance that of the errors, whatever was measured?
#include "calibration/rows/calibrate_rows.h"

#include <gmock/gmock.h>

#include "tests/calibration/rows/drawn_rows.h"

namespace understudy::calibration {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Vec3 kBall(0.03, -0.04, 0.06), kReflector(-0.05, 0.02, 0.03);
const Pose kBody = make_pose(exp_rotation({0.4, 0.2, -1.0}), kReflector);

using Draw = void (*)(DrawnRows&);

void draw_poses(DrawnRows& lab) { lab.add_in_frame(RowKind::pose, "body", kBody, 40); }
void draw_positions(DrawnRows& lab) {
  lab.add_in_frame(RowKind::position, "r1", make_pose(Mat3::Identity(), kReflector), 40);
  lab.add_in_frame(RowKind::position, "r2", make_pose(Mat3::Identity(), kBall), 40);
}
void draw_distances(DrawnRows& lab) {
  lab.add_distances("post", {0.6, 0.3, -0.2}, 0.0, kBall, 80);
  lab.add_distances("wire", {-0.5, 0.7, 0.4}, 0.012, kBall, 80);
  lab.problem.with_zero.insert("wire");
}
void draw_points(DrawnRows& lab) {
  const Vec3 middle = lab.nominal.forward(std::vector<double>(6, 0.6)).translation();
  const Vec3 a = 0.6 * middle, b = 0.6 * middle + Vec3(0, 0.05, 0);
  lab.add_points("a", a, kBall, 40);
  lab.add_points("b", b, kBall, 40);
  lab.problem.distances.push_back({"a", "b", 0.05, 5e-6});
}
void draw_all(DrawnRows& lab) {
  lab.add_in_frame(RowKind::position, "ball", make_pose(Mat3::Identity(), kBall), 20);
  lab.add_in_frame(RowKind::orientation, "camera", kBody, 20);
  lab.add_distances("post", {0.6, 0.3, -0.2}, 0.0, kBall, 20);
  lab.add_points("a", 0.6 * lab.nominal.forward(std::vector<double>(6, 0.6)).translation(), kBall, 20);
  lab.add_plane("table", Vec3(0.1, 0.2, 1).normalized(), 0.1, kBall, 30);
}

// So many that what they tell poorly is still told within the reach of a linear covariance; of 80 rows errors
// squared are 1.26 times what is stated.
void draw_one_reflector(DrawnRows& lab) {
  lab.add_in_frame(RowKind::position, "r1", make_pose(Mat3::Identity(), kReflector), 160);
}
/// Holes of a plate below the tool, and how far two pairs of them are apart.
void draw_plate(DrawnRows& lab) {
  const Vec3 middle = lab.description.X_BT_home * kBall;
  const Vec3 holes[] = {{-0.03, -0.03, 0}, {0.03, -0.03, 0.01}, {0.03, 0.03, -0.01}, {-0.03, 0.03, 0.02}};
  for (std::size_t i = 0; i < 4; ++i)
    lab.add_points(std::string("hole_") + "0123"[i], middle + holes[i], kBall, 40);
  lab.problem.distances.push_back({"hole_0", "hole_1", (holes[0] - holes[1]).norm(), 5e-6});
  lab.problem.distances.push_back({"hole_1", "hole_2", (holes[1] - holes[2]).norm(), 5e-6});
}
void draw_plate_and_tracker(DrawnRows& lab) {
  draw_plate(lab);
  draw_one_reflector(lab);
}
void draw_hexapod_all(DrawnRows& lab) {
  lab.add_in_frame(RowKind::position, "ball", make_pose(Mat3::Identity(), kBall), 40);
  lab.add_in_frame(RowKind::orientation, "camera", kBody, 40);
  lab.add_distances("post", {0.6, 0.3, -0.2}, 0.0, kBall, 40);
}

std::vector<Eigen::Index> all_free(const std::string& machine = "arm") {
  return DrawnRows({}, 1, machine).nominal.free_parameters(true, true);
}

/// (estimate - truth) of the machine's free parameters, in squares by the stated covariance, for each of
/// them; and chi-square of the residuals for each degree of freedom. 1 on average where both are honest.
struct Honesty {
  double error = 0, residual = 0;
};

Honesty honesty(const std::string& machine, Draw draw, int sets) {
  Honesty sum;
  const auto columns = all_free(machine);
  for (int set = 1; set <= sets; ++set) {
    DrawnRows lab(columns, static_cast<std::uint64_t>(set), machine);
    draw(lab);
    const RowCalibration found = calibrate_rows(lab.problem);
    EXPECT_TRUE(found.ok()) << "set " << set << ": " << found.message;
    if (!found.ok()) return {};
    EXPECT_THAT(found.untold, IsEmpty());
    sum.error += lab.error_squared(found, columns) / sets;
    sum.residual += found.chi_square / found.degrees_of_freedom / sets;
  }
  return sum;
}

struct Kind {
  const char* name;
  Draw draw;
  const char* machine = "arm";
};
class RowsOfAKind : public ::testing::TestWithParam<Kind> {};
class SlowRowsOfAKind : public ::testing::TestWithParam<Kind> {};
const auto kKinds = ::testing::Values(
    Kind{"Poses", draw_poses}, Kind{"Positions", draw_positions}, Kind{"Distances", draw_distances},
    Kind{"Points", draw_points}, Kind{"AllTogether", draw_all}, Kind{"HexapodPoses", draw_poses, "hexapod"},
    Kind{"HexapodPositions", draw_positions, "hexapod"},
    Kind{"HexapodOneReflector", draw_one_reflector, "hexapod"},
    Kind{"HexapodDistances", draw_distances, "hexapod"}, Kind{"HexapodPlate", draw_plate, "hexapod"},
    Kind{"HexapodPlateAndTracker", draw_plate_and_tracker, "hexapod"},
    Kind{"HexapodAllTogether", draw_hexapod_all, "hexapod"});
const auto kName = [](const auto& info) { return std::string(info.param.name); };

// 18 free parameters and more, 8 sets: the mean of 144 squares has a sigma of sqrt(2 / 144) = 0.12; three of
// them, and residuals have more degrees.
TEST_P(RowsOfAKind, HaveAnHonestCovariance) {
  const Honesty found = honesty(GetParam().machine, GetParam().draw, 8);
  EXPECT_NEAR(found.error, 1, 0.36);
  EXPECT_NEAR(found.residual, 1, 0.2);
}
INSTANTIATE_TEST_SUITE_P(ExtendedCalibrateRows, RowsOfAKind, kKinds, kName);

TEST_P(SlowRowsOfAKind, HaveAnHonestCovarianceOver200Sets) {
  const Honesty found = honesty(GetParam().machine, GetParam().draw, 200);
  EXPECT_GT(found.error, 0.8);
  EXPECT_LT(found.error, 1.25);
  EXPECT_NEAR(found.residual, 1, 0.05);
}
INSTANTIATE_TEST_SUITE_P(SlowCalibrateRows, SlowRowsOfAKind, kKinds, kName);

TEST(CalibrateRows, FindsTheNoiseThatNoRowTells) {
  DrawnRows lab(all_free(), 3);
  draw_poses(lab);
  for (MeasurementRow& row : lab.problem.rows) row.covariance.setZero(), row.noise_told = false;
  const RowCalibration found = calibrate_rows(lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  // About 100 degrees of freedom each: 1 sigma of a sigma is 7 %.
  EXPECT_NEAR(found.added[0], kDrawnSigma, 0.25 * kDrawnSigma);
  EXPECT_NEAR(found.added[1], kDrawnTurn, 0.25 * kDrawnTurn);
}

TEST(CalibrateRows, EnlargesNoiseThatTheResidualsContradict) {
  DrawnRows lab(all_free(), 3);
  draw_poses(lab);
  for (MeasurementRow& row : lab.problem.rows) row.covariance /= 400;
  const RowCalibration found = calibrate_rows(lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_NEAR(found.added[0], kDrawnSigma, 0.25 * kDrawnSigma);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("more than the told noise explains")));
}

TEST(CalibrateRows, SaysWhatOrientationsAloneDoNotTell) {
  DrawnRows lab(all_free(), 3);
  lab.add_in_frame(RowKind::orientation, "camera", kBody, 30);
  const RowCalibration found = calibrate_rows(lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_THAT(found.untold, Contains(HasSubstr("shift")));
  for (const std::string& name : found.untold) EXPECT_THAT(name, ::testing::Not(HasSubstr("tilt")));
  for (std::size_t i = 0; i < lab.nominal.chain()->chain.axes.size(); ++i)
    EXPECT_LT((found.machine.chain()->chain.axes[i].point - lab.nominal.chain()->chain.axes[i].point).norm(),
              1e-9);
}

TEST(CalibrateRows, RefusesTooFewRowsAndAToolThatNeverTurns) {
  DrawnRows lab(all_free(), 3);
  lab.add_in_frame(RowKind::position, "r", Pose::Identity(), 8);
  const RowCalibration few = calibrate_rows(lab.problem);
  EXPECT_EQ(few.status, Status::too_few_poses);
  EXPECT_THAT(few.message, HasSubstr("24 equations"));

  DrawnRows still(all_free(), 3);
  still.add_in_frame(RowKind::position, "r", Pose::Identity(), 30);
  for (MeasurementRow& row : still.problem.rows) row.axes = still.problem.rows.front().axes;
  EXPECT_EQ(calibrate_rows(still.problem).status, Status::rank_deficient);
}

TEST(CalibrateRows, AnAxisThatNeverMovesStaysAsDrawnAndIsNamed) {
  DrawnRows lab(all_free(), 3);
  const std::size_t still = 0;
  for (int j = 0; j < 80; ++j) {
    lab.add_in_frame(RowKind::position, "r", make_pose(Mat3::Identity(), kBall), 1);
    MeasurementRow& row = lab.problem.rows.back();
    row.axes[still] = 0.3;
    row.X_MG.translation() = lab.X_MS * (lab.built.forward(row.axes) * kBall) + lab.noise(kDrawnSigma);
  }
  const RowCalibration found = calibrate_rows(lab.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_THAT(found.warnings, Contains(HasSubstr("axis j1 stands still in all rows")));
  for (const std::string& name : found.estimated) EXPECT_FALSE(name.starts_with("j1 ")) << name;
  // The reflector is placed to what 80 rows of 50 um leave, not to the prior's millimetres.
  ASSERT_EQ(found.target_sigmas.size(), 1u);
  EXPECT_LT(found.target_sigmas[0].median, 2 * kDrawnSigma);
  EXPECT_GT(found.target_sigmas[0].median, 0.1 * kDrawnSigma);
}

TEST(CalibrateRows, RowsThatWereNotFittedAreComparedWithTheFoundFrame) {
  DrawnRows lab(all_free(), 3);
  draw_poses(lab);
  const RowProblem fitted = lab.problem;
  const RowCalibration found = calibrate_rows(fitted);
  lab.problem.rows.clear();
  lab.add_in_frame(RowKind::pose, "body", kBody, 60);
  for (std::size_t j = 0; j < lab.problem.rows.size(); ++j) lab.problem.rows[j].table = j < 20 ? 0 : 1;
  const ComparedRows compared = compared_rows(lab.problem, fitted, found);
  const auto& parts = compared.all;
  ASSERT_EQ(parts.size(), 2u);
  // Noise of three axes, and a little of the parameters'.
  EXPECT_NEAR(parts[0].after, std::sqrt(3) * kDrawnSigma, 0.3 * kDrawnSigma);
  EXPECT_GT(parts[0].before, 5 * parts[0].after);
  ASSERT_EQ(compared.by_table.size(), 2u);
  EXPECT_EQ(compared.by_table[0][0].values, 20);
  EXPECT_EQ(compared.by_table[1][0].values, 40);
}

}  // namespace
}  // namespace understudy::calibration
