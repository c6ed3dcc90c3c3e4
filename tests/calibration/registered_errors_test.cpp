#include "calibration/registered_errors.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random_vector.h"

namespace understudy::calibration {
namespace {

std::vector<Vec3> points(std::size_t count, Random& random) {
  std::vector<Vec3> all;
  for (std::size_t k = 0; k < count; ++k) all.push_back(Vec3(0.1, 0.2, 0.3) + 0.05 * normal_vec3(random));
  return all;
}

// A turn of 1 urad bends by the square of it.
TEST(RegisteredErrors, ARigidMotionLeavesNone) {
  Random random(1, "registered errors");
  const auto registered = points(20, random), others = points(10, random);
  const Mat3 R = exp_rotation(Vec3(1e-6, -2e-6, 3e-6));
  const auto moved = [&](const std::vector<Vec3>& all) {
    std::vector<Vec3> errors;
    for (const Vec3& p : all) errors.push_back(R * p + Vec3(1e-4, 2e-4, -3e-4) - p);
    return errors;
  };
  for (const Vec3& e :
       registered_errors(registration_of(registered, others), moved(registered), moved(others)))
    EXPECT_LT(e.norm(), 1e-11);
}

TEST(RegisteredErrors, AStretchStays) {
  Random random(2, "registered errors");
  const auto registered = points(50, random);
  const std::vector<Vec3> others{Vec3(0.2, 0.2, 0.3), Vec3(0, 0.2, 0.3)};
  std::vector<Vec3> at_registered, at_others;
  for (const Vec3& p : registered) at_registered.push_back(1e-3 * p);
  for (const Vec3& p : others) at_others.push_back(1e-3 * p);
  const auto left = registered_errors(registration_of(registered, others), at_registered, at_others);
  // No rigid motion changes the distance of two points.
  EXPECT_NEAR((left[0] - left[1]).x(), 1e-3 * 0.2, 1e-12);
}

// 4000 draws know a variance to sqrt(2 / 4000) = 2.2 %; four of these.
TEST(RegisteredErrors, CovariancesAreThoseOfDraws) {
  Random random(3, "registered errors");
  const auto registered = points(8, random), others = points(1, random);
  const Eigen::MatrixXd M = registration_of(registered, others);
  ErrorModel at_registered{Eigen::MatrixXd::Zero(24, 1), std::vector<Mat3>(8, 4 * Mat3::Identity())};
  ErrorModel at_others{Eigen::MatrixXd::Zero(3, 1), {Mat3::Identity()}};
  for (Eigen::Index row = 0; row < 24; ++row) at_registered.rows(row, 0) = random.normal();
  for (Eigen::Index row = 0; row < 3; ++row) at_others.rows(row, 0) = 3 * random.normal();
  const Eigen::MatrixXd variance = 9 * Eigen::MatrixXd::Identity(1, 1);
  const Mat3 stated = registered_covariances(M, at_registered, at_others, variance)[0];
  constexpr int kDraws = 4000;
  Vec3 squares = Vec3::Zero();
  for (int n = 0; n < kDraws; ++n) {
    const double number = 3 * random.normal();
    std::vector<Vec3> e;
    for (Eigen::Index k = 0; k < 8; ++k) {
      const Vec3 own = 2 * normal_vec3(random);
      e.push_back(at_registered.rows.block<3, 1>(3 * k, 0) * number + own);
    }
    const Vec3 own = normal_vec3(random);
    const std::vector<Vec3> at{at_others.rows.col(0) * number + own};
    squares += registered_errors(M, e, at)[0].cwiseAbs2() / kDraws;
  }
  for (Eigen::Index k = 0; k < 3; ++k) EXPECT_NEAR(squares[k] / stated(k, k), 1, 4 * std::sqrt(2.0 / kDraws));
}

}  // namespace
}  // namespace understudy::calibration
