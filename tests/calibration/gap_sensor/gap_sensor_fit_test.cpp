#include "calibration/gap_sensor/gap_sensor_fit.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/gap_sensor/calibrate_gap_sensor.h"
#include "core/units.h"
#include "machine/optics_mounting.h"
#include "tests/calibration/gap_sensor/pinhole_sensor.h"
#include "tests/shipped_hexapod.h"

namespace understudy::calibration {
namespace {

constexpr double kDotSigma = 0.1;  // [px] of one coordinate: docs/gap-control.md#figures
constexpr double kAim = 0.13e-3;   // [m]
constexpr int kSensors = 200;

const Vec2& centre() { return hexapod().microscope.camera.centre_px; }

machine::MountingVector drawn_error(Random& random) {
  machine::MountingVector error;
  for (int i = 0; i < machine::kMountingFreedoms; ++i) error[i] = random.normal();
  return error.cwiseProduct(machine::mounting_sigmas(*hexapod().tolerances.mounting));
}

struct Plan {
  std::vector<Vec2> slopes{Vec2::Zero()};
  double height_sigma = 0;     ///< [m]
  double feeler_sigma = 5e-6;  ///< [m]
  int dots = 10;
  double step = 0.2e-3;  ///< [m]
};

/// What a laboratory measures of a sensor: dots at heights over each flat, whose zero it does not know, and
/// one gap by a feeler gauge.
GapSensorProblem measured(const PinholeSensor& truth, const Plan& plan, Random& random) {
  GapSensorProblem problem = gap_sensor_problem(hexapod());
  problem.slopes = plan.slopes;
  for (std::size_t flat = 0; flat < plan.slopes.size(); ++flat) {
    const double zero = random.uniform(-0.2e-3, 0.2e-3);
    const int index = static_cast<int>(flat);
    problem.known.push_back(
        {index, 0.1e-3 + plan.feeler_sigma * random.normal() - zero, 0.1e-3, plan.feeler_sigma});
    for (int i = 0; i < plan.dots; ++i) {
      const double gap = 0.1e-3 + plan.step * i;
      SeenDot dot{index, gap - zero + plan.height_sigma * random.normal(), plan.height_sigma, {}, {}};
      const double u = random.normal(), v = random.normal();
      dot.position_px = truth.dot(plan.slopes[flat], gap) + kDotSigma * Vec2(u, v);
      dot.covariance_px2 = kDotSigma * kDotSigma * Eigen::Matrix2d::Identity();
      problem.dots.push_back(dot);
    }
  }
  return problem;
}

/// 1 sigma of what a mounting reads, by differences of the plain model.
double stated_sigma(const GapSensorFit& fit, const Vec2& slope, double gap) {
  machine::MountingVector derivative;
  const Vec2 dot = sensor_of(fit.mounting, centre()).dot(slope, gap);
  for (int i = 0; i < machine::kMountingFreedoms; ++i) {
    machine::MountingVector e = machine::MountingVector::Zero();
    e[i] = 1e-6;
    const double ahead = displaced(fit.mounting, centre(), e).read(slope, dot);
    const double behind = displaced(fit.mounting, centre(), -e).read(slope, dot);
    derivative[i] = (ahead - behind) / 2e-6;
  }
  return std::sqrt(derivative.dot(fit.covariance * derivative));
}

struct Errors {
  double before_rms = 0, after_rms = 0, after_max = 0, sigma = 0, chi_square = 0;
  double fit_chi_square = 0;  ///< over its degrees of freedom
};

/// Of the gap that the sensor reads over a slope, over drawn sensors.
Errors errors_over(const Plan& plan, const Vec2& slope, double gap = kAim) {
  Errors errors;
  for (int k = 0; k < kSensors; ++k) {
    Random random(static_cast<std::uint64_t>(k), "gap sensors");
    const auto drawn = machine::mounting_of(hexapod());
    const PinholeSensor truth = displaced(drawn, centre(), drawn_error(random));
    const GapSensorFit fit = fit_gap_sensor(measured(truth, plan, random));
    EXPECT_TRUE(fit.converged) << "sensor " << k;
    if (!fit.converged) continue;
    const Vec2 dot = truth.dot(slope, gap);
    const double before = sensor_of(drawn, centre()).read(slope, dot) - gap;
    const double after = sensor_of(fit.mounting, centre()).read(slope, dot) - gap;
    const double sigma = stated_sigma(fit, slope, gap);
    errors.before_rms += before * before / kSensors;
    errors.after_rms += after * after / kSensors;
    errors.after_max = std::max(errors.after_max, std::abs(after));
    errors.sigma += sigma / kSensors;
    errors.chi_square += std::pow(after / sigma, 2) / kSensors;
    errors.fit_chi_square += fit.chi_square / fit.degrees_of_freedom / kSensors;
  }
  errors.before_rms = std::sqrt(errors.before_rms);
  errors.after_rms = std::sqrt(errors.after_rms);
  return errors;
}

void report(const char* name, const Errors& e) {
  std::printf("%s: before %.1f um RMS, after %.2f um RMS, %.2f um at most, stated %.2f um, chi-square %.2f\n",
              name, to_um(e.before_rms), to_um(e.after_rms), to_um(e.after_max), to_um(e.sigma),
              e.chi_square);
}

/// The mean of 200 squares of a standard normal number is 1 +- 0.1.
void expect_honest(const Errors& e) {
  EXPECT_GT(e.chi_square, 0.8);
  EXPECT_LT(e.chi_square, 1.25);
  EXPECT_NEAR(e.fit_chi_square, 1, 0.1);  // some 20 degrees of freedom each: 1 +- 0.02
}

TEST(GapSensorFit, TwoHundredSensorsReadTheGapToTenMicrometresAsStated) {
  const Errors e = errors_over({}, Vec2::Zero());
  report("flat", e);
  EXPECT_GT(e.before_rms, 50e-6);  // half of the accepted band
  EXPECT_LE(e.after_rms, 10e-6);
  expect_honest(e);
  // Nearly all of it is the feeler's: of a better one the worst of 200, 2.9 sigma, is below 10 um.
  Plan better;
  better.feeler_sigma = 3e-6;
  const Errors best = errors_over(better, Vec2::Zero());
  report("flat, feeler to 3 um", best);
  EXPECT_LE(best.after_max, 10e-6);
  expect_honest(best);
}

TEST(GapSensorFit, TheStatedUncertaintyIsHonestAtTheStandoffAndOnASlope) {
  const Errors far = errors_over({}, Vec2::Zero(), 2e-3);
  report("2 mm", far);
  expect_honest(far);
  // Nothing over a flat tells where along a slope the dot lies.
  const Errors slope = errors_over({}, Vec2(0.2, 0.2));
  report("slope, flat only", slope);
  EXPECT_GT(slope.sigma, 10e-6);
  expect_honest(slope);
}

TEST(GapSensorFit, WedgesTellTheGapOverASlope) {
  const double lean = std::tan(from_deg(15));
  Plan wedges;
  wedges.slopes = {Vec2::Zero(), Vec2(-lean, 0), Vec2(0, -lean)};
  const Errors e = errors_over(wedges, Vec2(0.2, 0.2));
  report("slope, wedges", e);
  EXPECT_LE(e.after_rms, 50e-6 / 3);  // three of them fit into half of the accepted band
  expect_honest(e);
}

TEST(GapSensorFit, HeightsOfAMachineThatScattersCount) {
  Plan plan;
  plan.height_sigma = 10e-6;
  const Errors e = errors_over(plan, Vec2::Zero());
  report("heights to 10 um", e);
  expect_honest(e);
}

TEST(GapSensorFit, WithoutNoiseItIsExactWhereTheDotsTell) {
  Random random(3, "exact");
  const auto drawn = machine::mounting_of(hexapod());
  const PinholeSensor truth = displaced(drawn, centre(), drawn_error(random));
  GapSensorProblem problem = measured(truth, {}, random);
  for (std::size_t i = 0; i < problem.dots.size(); ++i) {
    const double gap = problem.known[0].gap + problem.dots[i].height - problem.known[0].height;
    problem.dots[i].position_px = truth.dot(Vec2::Zero(), gap);
    problem.dots[i].covariance_px2 *= 1e-8;
  }
  problem.known[0].sigma = 1e-9;
  const GapSensorFit fit = fit_gap_sensor(problem);
  ASSERT_TRUE(fit.converged);
  for (const double gap : {0.1e-3, 0.13e-3, 1e-3, 1.9e-3})  // the tolerances still pull by 1e-10 of theirs
    EXPECT_NEAR(sensor_of(fit.mounting, centre()).read(Vec2::Zero(), truth.dot(Vec2::Zero(), gap)), gap,
                1e-8);
}

TEST(GapSensorFit, WhatTheDotsDoNotShowStaysAtTheDrawing) {
  Random random(4, "unshown");
  const auto drawn = machine::mounting_of(hexapod());
  const GapSensorProblem problem = measured(sensor_of(drawn, centre()), {}, random);
  const GapSensorFit fit = fit_gap_sensor(problem);
  ASSERT_TRUE(fit.converged);
  // Laser and camera moved along together show no more than the flat does, which is the same everywhere.
  const Vec3 aside(1, 0, 0);
  machine::MountingVector together = machine::MountingVector::Zero();
  const Vec3 of_laser = drawn.X_TL.linear().transpose() * aside,
             of_camera = drawn.X_TC.linear().transpose() * aside;
  together.head<2>() = of_laser.head<2>();
  together.segment<3>(4) = of_camera;
  const machine::MountingMatrix prior = problem.tolerance.array().square().matrix().asDiagonal();
  // By the information along that direction: the dots add nothing to the tolerances.
  const double before = together.dot(prior.inverse() * together);
  const double after = together.dot(fit.covariance.inverse() * together);
  // The laser's own z is no freedom: what that leaves out is below a part in a hundred.
  EXPECT_NEAR(after, before, 0.01 * before);
  EXPECT_LT(fit.error.cwiseQuotient(problem.tolerance).norm(), 1);
}

TEST(GapSensorFit, ATurnOfTheCameraTakesAWrongPrincipalPoint) {
  Random random(5, "principal point");
  const auto drawn = machine::mounting_of(hexapod());
  PinholeSensor truth = displaced(drawn, centre(), drawn_error(random));
  truth.centre_px += Vec2(4, -3);  // 5 px are 2.4 mrad
  const GapSensorFit fit = fit_gap_sensor(measured(truth, {}, random));
  ASSERT_TRUE(fit.converged);
  const double read = sensor_of(fit.mounting, centre()).read(Vec2::Zero(), truth.dot(Vec2::Zero(), kAim));
  EXPECT_NEAR(read, kAim, 4 * stated_sigma(fit, Vec2::Zero(), kAim));
}

TEST(GapSensorFit, DotsOfOneSpeckleCountOnce) {
  const auto drawn = machine::mounting_of(hexapod());
  const auto sigma_of = [&](int repeated) {
    Random random(6, "speckle");
    GapSensorProblem problem = measured(sensor_of(drawn, centre()), {}, random);
    const std::vector<SeenDot> once = problem.dots;
    for (int i = 1; i < repeated; ++i) problem.dots.insert(problem.dots.end(), once.begin(), once.end());
    problem.known[0].sigma = 1e-7;  // what is left is the dots'
    return stated_sigma(fit_gap_sensor(problem), Vec2::Zero(), kAim);
  };
  // Eight pictures at each height: independent ones would gain a factor of 2.8.
  EXPECT_NEAR(sigma_of(8), sigma_of(1), 0.02 * sigma_of(1));
}

TEST(GapSensorFit, OpticsThatSeeNoDotDoNotConverge) {
  Random random(7, "blind");
  GapSensorProblem problem = measured(sensor_of(machine::mounting_of(hexapod()), centre()), {}, random);
  problem.slopes[0] = Vec2(0, 5);  // steeper than the beam
  EXPECT_FALSE(fit_gap_sensor(problem).converged);
}

}  // namespace
}  // namespace understudy::calibration
