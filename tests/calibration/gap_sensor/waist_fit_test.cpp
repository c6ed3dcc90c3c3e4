// The beam's width by the widths of its dots: against rays written out once more.
#include "calibration/gap_sensor/waist_fit.h"

#include <Eigen/Cholesky>
#include <cmath>

#include <gtest/gtest.h>

#include "calibration/gap_sensor/calibrate_gap_sensor.h"
#include "machine/optics_mounting.h"
#include "tests/calibration/gap_sensor/pinhole_sensor.h"
#include "tests/shipped_hexapod.h"

namespace understudy::calibration {
namespace {

constexpr double kShare =
    0.07;  // 1 sigma of a second moment under speckle, a share of it (docs/gap-control.md)

/// Of rays a standard deviation beside the beam's axis, the blur, and a pixel's own square.
Eigen::Matrix2d spread_of(double waist, const Vec2& slope, double gap) {
  const machine::OpticsMounting mounting = machine::mounting_of(hexapod());
  const PinholeSensor sensor = sensor_of(mounting, hexapod().microscope.camera.centre_px);
  Eigen::Matrix2d spread =
      (std::pow(hexapod().microscope.blur_px, 2) + 1.0 / 12) * Eigen::Matrix2d::Identity();
  for (int axis = 0; axis < 2; ++axis) {
    PinholeSensor ahead = sensor, behind = sensor;
    ahead.ray_from += waist / 4 * mounting.X_TL.linear().col(axis);
    behind.ray_from -= waist / 4 * mounting.X_TL.linear().col(axis);
    const Vec2 half = 0.5 * (ahead.dot(slope, gap) - behind.dot(slope, gap));
    spread += half * half.transpose();
  }
  return spread;
}

/// Moments that scatter by kShare along any direction.
Eigen::Matrix2d noisy(const Eigen::Matrix2d& spread, Random& random) {
  const double u = random.normal(), v = random.normal(), w = random.normal() / std::sqrt(2.0);
  Eigen::Matrix2d noise;
  noise << u, w, w, v;
  const Eigen::Matrix2d root = spread.llt().matrixL();
  return root * (Eigen::Matrix2d::Identity() + kShare * noise) * root.transpose();
}

GapSensorProblem dots_of(double waist, const std::vector<double>& gaps, Random& random,
                         const Vec2& slope = Vec2::Zero()) {
  GapSensorProblem problem = gap_sensor_problem(hexapod());
  problem.slopes = {slope};
  for (const double gap : gaps)
    problem.dots.push_back({0, gap, 0, Vec2::Zero(), Eigen::Matrix2d::Identity(),
                            noisy(spread_of(waist, slope, gap), random), kShare});
  return problem;
}

std::vector<double> ten_heights(double step) {
  std::vector<double> gaps;
  for (int i = 0; i < 10; ++i) gaps.push_back(0.1e-3 + step * i);
  return gaps;
}

Waist fitted(const GapSensorProblem& problem) {
  const auto waist = fit_waist(problem, machine::mounting_of(hexapod()), {0});
  EXPECT_TRUE(waist);
  return waist.value_or(Waist{});
}

TEST(WaistFit, TwoHundredBeamsAreFoundWithinTheirStatedUncertainty) {
  double error = 0, ratio = 0;
  constexpr int kBeams = 200;
  for (int k = 0; k < kBeams; ++k) {
    Random random(static_cast<std::uint64_t>(k), "waists");
    const double waist = 0.15e-3 * (1 + 0.05 * random.normal());
    const Waist found = fitted(dots_of(waist, ten_heights(0.2e-3), random));
    error += std::pow(found.diameter / waist - 1, 2) / kBeams;
    ratio += std::pow((found.diameter - waist) / found.sigma, 2) / kBeams;
  }
  // A diameter errs by half the share of a moment: 3.5 % of one dot, 1.1 % of ten, less for two directions.
  EXPECT_LT(std::sqrt(error), 0.012) << "drawn: 5 %";
  EXPECT_GT(std::sqrt(error), 0.005);
  EXPECT_LT(ratio, 1.1) << "the sigma is an upper bound";
  EXPECT_GT(ratio, 0.3) << "and no more than by the two directions";
}

TEST(WaistFit, OverASlopeTheBeamIsTheSame) {
  Random random(1, "waists");
  for (const Vec2& slope : {Vec2(0.3, 0), Vec2(0, -0.3)}) {
    const Waist found = fitted(dots_of(0.13e-3, ten_heights(0.2e-3), random, slope));
    EXPECT_NEAR(found.diameter, 0.13e-3, 4 * found.sigma);
    EXPECT_LT(found.sigma, 0.02 * found.diameter);
  }
}

TEST(WaistFit, DotsOnOnePlaceShowTheirSpeckleOnce) {
  Random random(2, "waists");
  const Waist apart = fitted(dots_of(0.15e-3, ten_heights(0.2e-3), random));
  GapSensorProblem same = dots_of(0.15e-3, {0.1e-3}, random);
  const Waist one = fitted(same);
  same.dots.insert(same.dots.end(), 9, same.dots.front());
  EXPECT_NEAR(fitted(same).sigma, one.sigma, 0.02 * one.sigma);
  EXPECT_LT(apart.sigma, 0.6 * one.sigma);
}

TEST(WaistFit, WidthsThatDisagreeCountByTheirScatter) {
  Random random(3, "waists");
  GapSensorProblem problem = dots_of(0.15e-3, ten_heights(0.2e-3), random);
  const double stated = fitted(problem).sigma;
  for (std::size_t i = 0; i < problem.dots.size(); i += 2) problem.dots[i].spread_px2 *= 0.5;
  EXPECT_GT(fitted(problem).sigma, 2 * stated);
}

TEST(WaistFit, DotsThatTellNoWidthGiveNone) {
  Random random(4, "waists");
  GapSensorProblem problem = dots_of(0.15e-3, ten_heights(0.2e-3), random);
  GapSensorProblem narrow = problem;
  for (SeenDot& dot : narrow.dots) dot.spread_px2 = 0.1 * Eigen::Matrix2d::Identity();  // below the blur
  EXPECT_FALSE(fit_waist(narrow, narrow.drawn, {0}));
  for (SeenDot& dot : problem.dots) dot.spread_sigma = 0;
  EXPECT_FALSE(fit_waist(problem, problem.drawn, {0}));
}

}  // namespace
}  // namespace understudy::calibration
