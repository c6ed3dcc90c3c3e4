#include "calibration/bound.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/calibration/calibration_rig.h"

namespace understudy::calibration {
namespace {

double bound_um(const Case& c, const std::vector<PoseSample>& samples) {
  return to_um(tip_uncertainty(c.truth, parameter_bound(c.truth, samples, {}), {}, c.held_out).rms);
}

// The long way: the measured poses' derivatives by forward kinematics and differences, then the textbook
// formula.
TEST(CramerRaoBound, IsTheInverseOfTheInformationOfTheMeasuredPoses) {
  const Case c = make_case(1, 24);
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(42, 42);
  for (const PoseSample& sample : c.exact) {
    Eigen::MatrixXd D(6, 42);
    for (Eigen::Index k = 0; k < 42; ++k) {
      constexpr double kStep = 1e-5;
      ParameterVector by = ParameterVector::Zero(42);
      by[k] = kStep;
      const HexapodParameters high = moved(c.truth, by, {}), low = moved(c.truth, -by, {});
      const Pose after = kinematics::forward(high.geometry, strut_lengths(high, sample), sample.X_BT).X_BT;
      const Pose before = kinematics::forward(low.geometry, strut_lengths(low, sample), sample.X_BT).X_BT;
      D.col(k) << (after.translation() - before.translation()) / (2 * kStep),
          log_rotation(after.linear() * before.linear().transpose()) / (2 * kStep);
    }
    F += D.transpose() * sample.covariance.inverse() * D;
  }
  const Eigen::MatrixXd by_differences = F.inverse();
  const ParameterMatrix bound = parameter_bound(c.truth, c.exact, {});
  // Differences are good to 1e-6 and the inverse magnifies that by a condition number of up to 1e3.
  EXPECT_LT((bound - by_differences).norm(), 3e-3 * by_differences.norm());
}

TEST(CramerRaoBound, GrowsWithNoiseAndFallsWithRepetition) {
  const Case c = make_case(2, 12);
  const double once = bound_um(c, c.exact);
  std::vector<PoseSample> noisier = c.exact, twice = c.exact;
  for (PoseSample& sample : noisier) sample.covariance *= 9;
  twice.insert(twice.end(), c.exact.begin(), c.exact.end());
  EXPECT_NEAR(bound_um(c, noisier) / once, 3, 1e-9);
  EXPECT_NEAR(bound_um(c, twice) / once, 1 / std::sqrt(2), 1e-9);
}

TEST(CramerRaoBound, UnknownDevOrPlayCannotLowerIt) {
  Case c = make_case(2, 24);
  Random side(1, "sides");
  for (PoseSample& sample : c.exact)
    for (Approach& a : sample.approach)
      a = side.uniform() < 0.5 ? Approach::lengthening : Approach::shortening;
  const double plain = bound_um(c, c.exact);
  for (const Unknowns more : {Unknowns{.deviation = true}, Unknowns{.play = true}}) {
    const auto covariance = parameter_bound(c.truth, c.exact, more);
    EXPECT_GT(to_um(tip_uncertainty(c.truth, covariance, more, c.held_out).rms), plain);
  }
}

TEST(CramerRaoBound, IsEmptyWhereThePosesDoNotTell) {
  const Case c = make_case(1, 6);
  EXPECT_EQ(parameter_bound(c.truth, c.exact, {}).size(), 0);
}

// A calibration's own covariance says how far the tip is off: chi-square with 3 degrees of freedom a pose.
TEST(TipUncertainty, CoversTheErrorsThatCalibrationsMake) {
  const Case c = make_case(4, 24);
  Random noise(4, "coverage");
  for (const char* name : {"maximum_likelihood", "ik_residual"}) {
    double sum = 0;
    int count = 0;
    for (int n = 0; n < 60; ++n) {
      const Calibration found = make_estimator(name)->calibrate(c.noisy(noise));
      ASSERT_TRUE(found.ok()) << found.message;
      const auto tip = tip_uncertainty(found.parameters, found.covariance, {}, c.held_out);
      Twist e;
      for (std::size_t j = 0; j < c.held_out.size(); ++j, ++count) {
        ASSERT_TRUE(driven_error(c.truth, found.parameters, c.held_out[j], e));
        sum += e.head<3>().dot(tip.covariances[j].ldlt().solve(e.head<3>())) / 3;
      }
    }
    // 60 runs, the 60 poses of each moved by about 15 independent combinations: 1 +- 0.05.
    EXPECT_NEAR(sum / count, 1, 0.15) << name;
  }
}

TEST(DrivenError, IsTheOffsetOfAShiftedBase) {
  HexapodParameters shifted{rig().nominal, {}};
  for (Vec3& b : shifted.geometry.base_joint) b += Vec3(1e-3, 0, -2e-3);
  Twist e;
  ASSERT_TRUE(driven_error(shifted, {rig().nominal, {}}, rig().machine.X_BT_home, e));
  EXPECT_LT((e.head<3>() - Vec3(1e-3, 0, -2e-3)).norm(), 1e-12);  // forward kinematics is good to 1e-13
  EXPECT_LT(e.tail<3>().norm(), 1e-11);
}

}  // namespace
}  // namespace understudy::calibration
