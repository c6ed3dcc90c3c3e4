#include "vision/boards/stereo_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>

#include "core/random_vector.h"
#include "tests/vision/boards/two_cameras.h"
#include "vision/boards/rigid_fit.h"

namespace understudy::vision {
namespace {

Twist error_of(const Pose& measured, const Pose& truth) {
  Twist e;
  e << truth.translation() - measured.translation(),
      log_rotation(Mat3(truth.linear() * measured.linear().transpose()));
  return e;
}

std::array<std::array<PixelPoint, 3>, 2> observed_targets(const CalibrationRig& rig,
                                                          const std::array<MountedCamera, 2>& truth,
                                                          const Pose& X_WT, double sigma_px, Random& random) {
  std::array<std::array<PixelPoint, 3>, 2> seen;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto both = observed_point(truth, X_WT * rig.targets[k], sigma_px, random);
    seen[0][k] = both[0];
    seen[1][k] = both[1];
  }
  return seen;
}

Pose random_pose(Random& random) {
  const auto within = [&](double a) { return uniform_vec3(random, a); };
  return make_pose(exp_rotation(within(0.25)), Vec3(within(10e-3) + Vec3(0, 0, 0.1)));
}

// docs/reference.md#two-cameras: an equilateral triangle of 60 mm turns by sigma / 42.4 mm in its plane's
// axes and by sigma / 60 mm about its normal.
TEST(RigidFit, RotationOfTheTriangleHasItsClosedFormSpread) {
  const CalibrationRig rig = reference_rig();
  const Pose X_WT = make_pose(exp_rotation(Vec3(0.3, -0.2, 0.7)), Vec3(0.1, 0.2, 0.3));
  constexpr double kSigma = 15e-6;
  const Mat6 C = fit_covariance(X_WT, rig.targets, kSigma * kSigma * Mat9::Identity());
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(Mat3(C.bottomRightCorner<3, 3>()));
  const Vec3 sigma = axes.eigenvalues().cwiseSqrt();
  EXPECT_NEAR(sigma[0], kSigma / 60e-3, 1e-4 * sigma[0]);
  EXPECT_NEAR(sigma[1], kSigma / 42.4264e-3, 1e-4 * sigma[1]);
  EXPECT_NEAR(sigma[2], kSigma / 42.4264e-3, 1e-4 * sigma[2]);
  const Vec3 normal =
      (X_WT.linear() * (rig.targets[1] - rig.targets[0]).cross(rig.targets[2] - rig.targets[0])).normalized();
  EXPECT_NEAR(std::abs(axes.eigenvectors().col(0).dot(normal)), 1, 1e-9);
}

TEST(RigidFit, IsExactForExactPointsAndNeverAReflection) {
  const CalibrationRig rig = reference_rig();
  Random random(5, "rigid fit");
  for (int i = 0; i < 200; ++i) {
    const Pose X = make_pose(exp_rotation(uniform_vec3(random, 3)),
                             Vec3(random.uniform(), random.uniform(), random.uniform()));
    std::array<Vec3, 3> p_W;
    for (std::size_t k = 0; k < 3; ++k) p_W[k] = X * rig.targets[k];
    const auto fit = fit_rigid(rig.targets, p_W);
    ASSERT_TRUE(fit);
    EXPECT_LT((fit->X_WT.matrix() - X.matrix()).norm(), 1e-12) << "seed 5, case " << i;
    EXPECT_GT(fit->X_WT.linear().determinant(), 0);
    EXPECT_LT(fit->residual_rms, 1e-15 + 1e-12);
  }
}

TEST(RigidFit, RefusesPointsInALineAndNumbersThatAreNone) {
  const std::array<Vec3, 3> line{Vec3(0, 0, 0), Vec3(0.01, 0.02, 0.03), Vec3(0.02, 0.04, 0.06)};
  EXPECT_FALSE(fit_rigid(line, line));
  std::array<Vec3, 3> broken = reference_rig().targets;
  broken[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fit_rigid(reference_rig().targets, broken));
}

// e' C^-1 e of six degrees of freedom: mean 6, its own spread over n draws sqrt(12 / n). Every draw has new
// boards, new corners, a new pose. `replicas` scatter adds 48 / (48 - 7) to the inverse.
double mean_normalised_error(ViewRayMethod method, const BoardTolerance& boards, int draws,
                             double& worst_share) {
  const CalibrationRig rig = reference_rig();
  const auto truth = true_cameras(rig);
  double sum = 0;
  int within = 0;
  for (int d = 0; d < draws; ++d) {
    Random random(static_cast<std::uint64_t>(d), "normalised error");
    const auto layers = observed_layers(rig, truth, boards, 0.05, random);
    const StereoModel model = calibrate_stereo(
        method, layers, {.boards = boards, .corner_px = 0.05, .seed = static_cast<std::uint64_t>(d)});
    const Pose X_WT = random_pose(random);
    const PoseMeasurement m =
        measure_pose(model, rig.targets, observed_targets(rig, truth, X_WT, 0.05, random),
                     {.gap_max = 3e-3, .shape_max = 3e-3});
    EXPECT_EQ(m.status, PoseStatus::ok) << to_string(m.status) << ", draw " << d;
    const Twist e = error_of(m.X_WT, X_WT);
    const double squared = e.dot(m.total().ldlt().solve(e));
    sum += squared;
    within += squared < 16.8;  // 99 % of chi-squared with six degrees
  }
  worst_share = static_cast<double>(within) / draws;
  return sum / draws;
}

TEST(PoseMeasurement, ErrorsAreWhatTheCovarianceSays) {
  for (const ViewRayMethod method : {ViewRayMethod::layer_line, ViewRayMethod::pinhole}) {
    double share = 0;
    const double mean = mean_normalised_error(method, {0.1e-3, 1e-3, 1e-3}, 30, share);
    EXPECT_GT(mean, 4.1) << to_string(method);  // 6 - 3 sqrt(12 / 30)
    EXPECT_LT(mean, 9.3) << to_string(method);  // 7.0 + 3.5 sqrt(12 / 30), with 48 replicas
    EXPECT_GT(share, 0.85) << to_string(method);
  }
}

TEST(SlowPoseMeasurement, ErrorsAreWhatTheCovarianceSaysForEveryMethod) {
  for (const ViewRayMethod method :
       {ViewRayMethod::layer_polyline, ViewRayMethod::layer_line, ViewRayMethod::pinhole}) {
    double share = 0;
    const double mean = mean_normalised_error(method, {0.2e-3, 2e-3, 2e-3}, 250, share);
    std::printf("%s: mean normalised squared error %.2f, %.3f within 99 %%\n", to_string(method), mean,
                share);
    EXPECT_GT(mean, 5.2) << to_string(method);
    EXPECT_LT(mean, 8.2) << to_string(method);
    EXPECT_GT(share, 0.94) << to_string(method);
  }
}

TEST(PoseMeasurement, SaysWhyThereIsNone) {
  const CalibrationRig rig = reference_rig();
  Random random(8, "pose reasons");
  const auto layers = observed_layers(rig, rig.cameras, {}, 0, random);
  const StereoModel model =
      calibrate_stereo(ViewRayMethod::layer_line, layers, {.boards = {}, .replicas = 0});
  const Pose X_WT = random_pose(random);
  const auto good = observed_targets(rig, rig.cameras, X_WT, 0, random);
  ASSERT_EQ(measure_pose(model, rig.targets, good).status, PoseStatus::ok);

  auto crossed = good;  // 30 px of height in one camera only: 2.8 mm
  crossed[1][2].pixel.y() += 30;
  const PoseMeasurement gap = measure_pose(model, rig.targets, crossed);
  EXPECT_EQ(gap.status, PoseStatus::view_rays_do_not_meet);
  EXPECT_EQ(gap.target, 2);
  EXPECT_NEAR(gap.gap, 30 * 0.4 / 4267, 0.4e-3);  // the target is within 14 % of 400 mm

  auto swapped =
      good;  // in both cameras: an equilateral triangle looks the same from behind, so it turns over
  std::swap(swapped[0][1], swapped[0][2]);
  std::swap(swapped[1][1], swapped[1][2]);
  EXPECT_GT(angle_between(measure_pose(model, rig.targets, swapped).X_WT.linear(), X_WT.linear()), 2.5);

  std::array<Vec3, 3> longer = rig.targets;
  longer[1] *= 1.2;
  EXPECT_EQ(measure_pose(model, longer, good).status, PoseStatus::wrong_shape);
  EXPECT_EQ(measure_pose(model, {Vec3(0, 0, 0), Vec3(1e-2, 0, 0), Vec3(2e-2, 0, 0)}, good).status,
            PoseStatus::targets_in_line);

  std::array<TargetsMeasurement, 2> outlines;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      outlines[i].targets[k].status = TargetStatus::ok;
      outlines[i].targets[k].centre_px = good[i][k].pixel;
    }
  }
  EXPECT_EQ(measure_pose(model, rig.targets, outlines).status, PoseStatus::ok);
  outlines[1].targets[0].status = TargetStatus::partly_hidden;
  const PoseMeasurement hidden = measure_pose(model, rig.targets, outlines);
  EXPECT_EQ(hidden.status, PoseStatus::target_not_measured);
  EXPECT_EQ(hidden.camera, 1);
  EXPECT_EQ(hidden.target, 0);
  EXPECT_EQ(hidden.target_status, TargetStatus::partly_hidden);
}

}  // namespace
}  // namespace understudy::vision
