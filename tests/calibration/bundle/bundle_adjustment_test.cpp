#include "calibration/bundle/bundle_adjustment.h"

#include <Eigen/Cholesky>
#include <cmath>

#include <gtest/gtest.h>

#include "calibration/bound.h"
#include "calibration/estimators/estimator.h"
#include "calibration/machine/camera_poses.h"
#include "calibration/registered_errors.h"
#include "calibration/strut_model.h"
#include "core/units.h"
#include "tests/calibration/bundle/drawn_bundle.h"

namespace understudy::calibration {
namespace {

Eigen::VectorXd numbers(const BundleState& state) {
  Eigen::VectorXd v(kGeometryParameters + kStruts);
  for (std::size_t i = 0; i < kStruts; ++i) {
    const auto row = kStrutParameters * static_cast<Eigen::Index>(i);
    v.segment<3>(row) = state.machine.geometry.base_joint[i];
    v.segment<3>(row + 3) = state.machine.geometry.platform_joint[i];
    v[row + 6] = state.machine.geometry.length_offset[i];
    v[kGeometryParameters + static_cast<Eigen::Index>(i)] = state.lead[i];
  }
  return v;
}

/// 80 poses that were not measured; W is registered at the first 20, errors are those at the others.
struct HeldOut {
  HeldOut() {
    Random random(99, "held-out poses");
    poses = random_reachable_poses(*hexapod().make_mechanism(), reference_region(hexapod().X_BT_home), 80,
                                   random);
    for (const Pose& X_BT : poses) places.emplace_back(X_BT.translation());
    registration = registration_of(first(places), rest(places));
  }
  static std::span<const Vec3> first(const std::vector<Vec3>& all) { return std::span(all).first(20); }
  static std::span<const Vec3> rest(const std::vector<Vec3>& all) { return std::span(all).subspan(20); }
  Eigen::MatrixXd matrix(bool registered) const { return (registered ? 1.0 : 0.0) * registration; }

  /// Mean square [m^2] of the tip that a machine of this truth misses, driven by the model.
  double square(const HexapodParameters& truth, const HexapodParameters& model, bool registered) const {
    std::vector<Vec3> errors;
    for (const Pose& X_BT : poses) {
      Twist error;
      if (!driven_error(truth, model, X_BT, error)) return NAN;
      errors.emplace_back(error.head<3>());
    }
    double sum = 0;
    const auto left = registered_errors(matrix(registered), first(errors), rest(errors));
    for (const Vec3& e : left) sum += e.squaredNorm();
    return sum / static_cast<double>(left.size());
  }

  /// The same by a covariance of the parameters.
  double square(const HexapodParameters& machine, const Eigen::MatrixXd& covariance, bool registered) const {
    const auto model = [&](std::size_t begin, std::size_t count) {
      ErrorModel errors{Eigen::MatrixXd(3 * static_cast<Eigen::Index>(count), covariance.rows()),
                        std::vector<Mat3>(count, Mat3::Zero())};
      for (std::size_t k = 0; k < count; ++k) {
        StrutLinearisation at;
        EXPECT_TRUE(linearise(machine, {}, poses[begin + k], at));
        errors.rows.middleRows<3>(3 * static_cast<Eigen::Index>(k)) = pose_rows(at, {}).topRows<3>();
      }
      return errors;
    };
    double sum = 0;
    for (const Mat3& C : registered_covariances(matrix(registered), model(0, 20), model(20, 60), covariance))
      sum += C.trace() / 60;
    return sum;
  }

  std::vector<Pose> poses;
  std::vector<Vec3> places;
  Eigen::MatrixXd registration;
};

/// Cameras by the boards, poses by the cameras, the machine by the poses.
HexapodParameters in_two_steps(const BundleProblem& problem) {
  vision::CalibrationUncertainty uncertainty = problem.uncertainty;
  uncertainty.boards.scale = uncertainty.boards.print_scale;
  const vision::StereoModel model =
      vision::calibrate_rig(problem.rig, problem.boards, vision::ViewRayMethod::pinhole, uncertainty);
  std::vector<CameraPose> seen;
  for (const BundlePose& pose : problem.poses)
    seen.push_back(camera_pose(vision::measure_pose(model, problem.rig.targets, pose.targets)));
  take_out_frame(seen);
  Problem poses{problem.nominal, {}};
  const Pose X_BW = problem.X_WB.inverse();
  for (std::size_t j = 0; j < seen.size(); ++j) {
    PoseSample sample;
    sample.X_BT = X_BW * seen[j].X_WT;
    sample.covariance = told_in(X_BW.linear(), seen[j].covariance);
    sample.displacement = problem.poses[j].displacement;
    poses.samples.push_back(sample);
  }
  return make_maximum_likelihood()->calibrate(poses, {}).parameters;
}

// Nothing is off but cameras and machine. What rounding leaves: 1e-12 of 1000 px over slopes of 1e4 px/m.
TEST(BundleAdjustment, FindsTheTruthFromDataWithoutNoise) {
  DrawnSetting setting;
  setting.boards = {};
  setting.drives.lead = 0;
  setting.noise = false;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    DrawnBundle drawn = draw_bundle(setting, seed);
    drawn.problem.uncertainty.principal_px = 0;  // prior knowledge that is off is noise, too
    const BundleAdjustment found = adjust_bundle(drawn.problem);
    ASSERT_TRUE(found.ok()) << found.message;
    EXPECT_LT((numbers(found.state) - numbers(drawn.truth)).cwiseAbs().maxCoeff(), 1e-9) << seed;
    EXPECT_LT(found.chi_square, 1e-6);
  }
}

// 30 draws of 54 unknowns and of some 4900 degrees of freedom: means of chi-square are known to
// sqrt(2 / (30 n)); four of these.
TEST(BundleAdjustment, StatesItsUncertaintyAsItIs) {
  constexpr int kDraws = 30;
  double residuals = 0, errors = 0, degrees = 0;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const DrawnBundle drawn = draw_bundle({}, seed);
    const BundleAdjustment found = adjust_bundle(drawn.problem);
    ASSERT_TRUE(found.ok()) << found.message;
    const Eigen::VectorXd e = numbers(found.state) - numbers(drawn.truth);
    errors += e.dot(found.covariance.ldlt().solve(e)) / kDraws;
    residuals += found.chi_square / kDraws;
    degrees = static_cast<double>(found.degrees_of_freedom);
  }
  const double unknowns = kGeometryParameters + kStruts;
  std::printf("chi-square of the machine %.1f of %.0f, of residuals %.0f of %.0f\n", errors, unknowns,
              residuals, degrees);
  EXPECT_NEAR(errors / unknowns, 1, 4 * std::sqrt(2 / (kDraws * unknowns)));
  EXPECT_NEAR(residuals / degrees, 1, 4 * std::sqrt(2 / (kDraws * degrees)));
}

TEST(BundleAdjustment, BoundAtTheTruthIsTheCovarianceAtTheAnswer) {
  const DrawnBundle drawn = draw_bundle({}, 4);
  const BundleAdjustment found = adjust_bundle(drawn.problem);
  ASSERT_TRUE(found.ok()) << found.message;
  const Eigen::MatrixXd bound = bundle_bound(drawn.problem, drawn.truth);
  // Both are the same function at points that are some standard deviations apart.
  EXPECT_LT((bound - found.covariance).norm(), 0.02 * bound.norm());
}

// What the boards leave open of where W is nobody can win back; the rest of their errors the machine's own
// motion tells. In W six numbers make most of the error of a draw: 20 draws know its square to sqrt(2 / 120)
// = 13 %; three of these.
TEST(BundleAdjustment, ReachesTheBoundWhereTwoStepsDoNot) {
  double bundle[2] = {0, 0}, steps[2] = {0, 0}, bound[2] = {0, 0};
  constexpr int kDraws = 20;
  const HeldOut held_out;
  DrawnSetting setting;
  setting.drives.lead = 0;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const DrawnBundle drawn = draw_bundle(setting, seed);
    const BundleAdjustment found = adjust_bundle(drawn.problem);
    ASSERT_TRUE(found.ok()) << found.message;
    const HexapodParameters by_steps = in_two_steps(drawn.problem);
    const HexapodParameters& truth = drawn.truth.machine;
    const Eigen::MatrixXd least = bundle_bound(drawn.problem, drawn.truth);
    for (const bool registered : {false, true}) {
      bundle[registered] += held_out.square(truth, found.state.machine, registered) / kDraws;
      steps[registered] += held_out.square(truth, by_steps, registered) / kDraws;
      bound[registered] += held_out.square(truth, least, registered) / kDraws;
    }
  }
  const auto um = [](double square) { return to_um(std::sqrt(square)); };
  for (const bool registered : {false, true})
    std::printf("%s: tip RMS %.1f um, least possible %.1f um, in two steps %.1f um\n",
                registered ? "registered" : "in W", um(bundle[registered]), um(bound[registered]),
                um(steps[registered]));
  EXPECT_NEAR(bundle[0] / bound[0], 1, 0.39);
  EXPECT_NEAR(bundle[1] / bound[1], 1, 0.39);
  EXPECT_LT(bundle[0], steps[0]);
  EXPECT_LT(bundle[1], 0.25 * steps[1]);
}

TEST(BundleAdjustment, SaysWhatIsMissing) {
  DrawnBundle drawn = draw_bundle({}, 1);
  BundleProblem few = drawn.problem;
  few.poses.resize(5);
  EXPECT_EQ(adjust_bundle(few).status, Status::too_few_poses);
  BundleProblem blind = drawn.problem;
  std::erase_if(blind.boards, [](const vision::SeenBoard& b) { return b.camera == 1; });
  EXPECT_EQ(adjust_bundle(blind).status, Status::bad_input);
  BundleProblem sure = drawn.problem;
  sure.poses[3].targets[1][2].covariance.setZero();
  const BundleAdjustment refused = adjust_bundle(sure);
  EXPECT_EQ(refused.status, Status::bad_input);
  EXPECT_NE(refused.message.find("pose 4"), std::string::npos) << refused.message;
}

}  // namespace
}  // namespace understudy::calibration
