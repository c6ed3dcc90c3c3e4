#include "control/registration/part_fit.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random_vector.h"
#include "core/units.h"
#include "tests/geometry/test_solids.h"

namespace understudy::control {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

geometry::Mesh mesh_of(const geometry::Triangles& t) { return {t.vertices, t.triangles}; }

const Vec3 kLower(-20e-3, -15e-3, 0), kUpper(20e-3, 15e-3, 25e-3);
const PartTolerance kTolerance{0.3e-3, 4e-3, 0};

/// A point of a drawn part and its normal there.
struct Spot {
  Vec3 p, normal;
};

/// Three spots on each of five faces of the box, none on an edge.
std::vector<Spot> box_spots(const Vec3& lower = kLower, const Vec3& upper = kUpper) {
  std::vector<Spot> spots;
  for (const Vec3& normal : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)})
    for (const Vec3& share : {Vec3(0.2, 0.3, 0.2), Vec3(0.8, 0.25, 0.7), Vec3(0.4, 0.8, 0.9)}) {
      Vec3 p = lower + share.cwiseProduct(upper - lower);
      for (int i = 0; i < 3; ++i)
        if (normal[i] != 0) p[i] = normal[i] > 0 ? upper[i] : lower[i];
      spots.push_back({p, normal});
    }
  return spots;
}

struct Noise {
  double own = 0, shared = 0;  // [m], 1 sigma
};

/// What a sensor sees of a part that stands at X_W: the spots, off along the normal by what each has of its
/// own and by what all share.
std::vector<MeasuredPoint> measured(const std::vector<Spot>& spots, const Pose& X_W, const Noise& stated,
                                    Random* draw = nullptr) {
  const double shared = draw ? stated.shared * draw->normal() : 0;
  std::vector<MeasuredPoint> points;
  for (const Spot& spot : spots) {
    const double error = shared + (draw ? stated.own * draw->normal() : 0);
    points.push_back({X_W * spot.p + error * (X_W.linear() * spot.normal), stated.own,
                      Eigen::VectorXd::Constant(1, stated.shared)});
  }
  return points;
}

/// As the tolerance says.
Pose drawn_pose(Random& random) {
  const auto vector = [&](double sigma) -> Vec3 { return sigma * normal_vec3(random); };
  const Vec3 turn = vector(kTolerance.rotation);
  return make_pose(exp_rotation(turn), vector(kTolerance.position));
}

/// Of a found pose: shift of the reference point and turn, both what is left of the true one.
Eigen::Matrix<double, 6, 1> error_of(const PartFit& fit, const Pose& truth) {
  Eigen::Matrix<double, 6, 1> error;
  error.head<3>() = fit.reference_W - truth * (fit.X_W.inverse() * fit.reference_W);
  error.tail<3>() = log_rotation(fit.X_W.linear() * truth.linear().transpose());
  return error;
}

TEST(PartFit, FindsABoxThatStandsElsewhere) {
  const geometry::Mesh part = mesh_of(geometry::box(kLower, kUpper));
  const Pose truth = make_pose(exp_rotation(Vec3(6e-3, -4e-3, 9e-3)), Vec3(0.6e-3, -0.4e-3, 0.3e-3));
  const PartFit fit = fit_part(part, measured(box_spots(), truth, {5e-6, 0}), kTolerance);
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.seen, 6);
  EXPECT_TRUE(fit.unseen.empty());
  EXPECT_LT(error_of(fit, truth).head<3>().norm(), 1e-9);
  EXPECT_LT(error_of(fit, truth).tail<3>().norm(), 1e-7);
  EXPECT_LT(fit.chi_square, 1e-6);
  EXPECT_EQ(fit.degrees_of_freedom, 9);
}

// For 200 boxes drawn from the tolerance the mean square of the error in units of the stated covariance is
// that of six normal numbers, and what the fit leaves that of nine. 200 draws scatter by 4 and 3 per cent.
TEST(PartFit, ItsCovarianceIsWhatItIsOffBy) {
  const geometry::Mesh part = mesh_of(geometry::box(kLower, kUpper));
  for (const Noise& noise : {Noise{8e-6, 0}, Noise{8e-6, 12e-6}}) {
    constexpr int kDraws = 200;
    double pose = 0, residual = 0, surface = 0;
    int refused = 0;
    for (int seed = 0; seed < kDraws; ++seed) {
      Random random(static_cast<std::uint64_t>(seed), "part fit");
      const Pose truth = drawn_pose(random);
      const PartFit fit = fit_part(part, measured(box_spots(), truth, noise, &random), kTolerance);
      ASSERT_EQ(fit.seen, 6);
      const Eigen::Matrix<double, 6, 1> error = error_of(fit, truth);
      pose += error.dot(fit.covariance.inverse() * error) / 6;
      residual += fit.chi_square / fit.degrees_of_freedom;
      const Spot top = box_spots().back();
      const double off = (fit.X_W * top.p - truth * top.p).dot(truth.linear() * top.normal);
      surface += std::pow(off / fit.sigma_along(fit.X_W * top.p, fit.X_W.linear() * top.normal), 2);
      refused += !fit.expected_part();
    }
    EXPECT_NEAR(pose / kDraws, 1, 0.2) << "shared " << noise.shared;
    EXPECT_NEAR(residual / kDraws, 1, 0.2) << "shared " << noise.shared;
    EXPECT_NEAR(surface / kDraws, 1, 0.25) << "shared " << noise.shared;
    EXPECT_EQ(refused, 0) << "one in 10 000 may be";
  }
}

// A point of a cylinder's side tells nothing of a turn about its axis or a shift along it.
TEST(PartFit, TwoFreedomsOfACylinderAreNamedAndLeft) {
  constexpr double kRadius = 15e-3, kHeight = 30e-3;
  constexpr int kFacets = 720;  // chords of 0.1 um
  const geometry::Mesh part = mesh_of(geometry::cylinder(kRadius, 60e-3, kFacets));
  std::vector<Spot> spots;
  for (int i = 0; i < 12; ++i) {
    // At vertices, where the drawn part has the radius of the cylinder.
    const double angle = 2 * std::numbers::pi * (i * 60 + 7) / kFacets;
    const Vec3 normal(std::cos(angle), std::sin(angle), 0);
    spots.push_back({kRadius * normal + Vec3(0, 0, kHeight * ((i * 5) % 12 / 11.0 - 0.5)), normal});
  }
  const Pose truth = make_pose(exp_rotation(Vec3(3e-3, -2e-3, 0)), Vec3(0.3e-3, 0.1e-3, 0));
  const PartFit fit = fit_part(part, measured(spots, truth, {5e-6, 0}), kTolerance);
  EXPECT_TRUE(fit.converged);
  EXPECT_EQ(fit.seen, 4);
  ASSERT_EQ(fit.unseen.size(), 2u);
  EXPECT_EQ(to_string(fit.unseen[0]), "shift along (0.00, 0.00, 1.00)");
  EXPECT_THAT(to_string(fit.unseen[1]), StartsWith("turn about (0.00, 0.00, 1.00) through (0.3, 0.1, "));
  EXPECT_NEAR(fit.unseen[0].sigma, kTolerance.position, 1e-6);
  EXPECT_NEAR(fit.unseen[1].sigma, kTolerance.rotation, 1e-5);
  EXPECT_LT(error_of(fit, truth).head<2>().norm(), 1e-6);
  EXPECT_LT(error_of(fit, truth).segment<2>(3).norm(), 1e-4);
  // As it was: neither shifted along the axis nor turned about it.
  EXPECT_NEAR(fit.X_W.translation().z(), 0, 1e-6);
  EXPECT_NEAR(log_rotation(fit.X_W.linear()).z(), 0, 2e-5);
}

TEST(PartFit, AFlatTellsItsHeightAndHowItLeans) {
  const geometry::Mesh part = mesh_of(geometry::box(kLower, kUpper));
  std::vector<Spot> spots;
  for (int i = 0; i < 9; ++i)
    spots.push_back({Vec3(-15e-3 + 15e-3 * (i % 3), -10e-3 + 10e-3 * (i / 3), kUpper.z()), Vec3::UnitZ()});
  const Pose truth = make_pose(exp_rotation(Vec3(2e-3, -3e-3, 0)), Vec3(0, 0, 0.2e-3));
  const PartFit fit = fit_part(part, measured(spots, truth, {5e-6, 0}), kTolerance);
  EXPECT_EQ(fit.seen, 3);
  ASSERT_EQ(fit.unseen.size(), 3u);
  EXPECT_FALSE(fit.unseen[0].turn);
  EXPECT_FALSE(fit.unseen[1].turn);
  EXPECT_TRUE(fit.unseen[2].turn);
  EXPECT_NEAR(std::abs(fit.unseen[2].direction_W.z()), 1, 1e-4);
  for (const Spot& spot : spots) EXPECT_NEAR((fit.X_W * spot.p - truth * spot.p).z(), 0, 2e-9);
}

// What each place has of its own tells nothing below what all share: the box's height is known to no less.
TEST(PartFit, AnErrorThatAllPlacesShareIsNotAveragedAway) {
  const geometry::Mesh part = mesh_of(geometry::box(kLower, kUpper));
  std::vector<Spot> spots;
  for (int i = 0; i < 25; ++i)
    spots.push_back({Vec3(-15e-3 + 7e-3 * (i % 5), -10e-3 + 5e-3 * (i / 5), kUpper.z()), Vec3::UnitZ()});
  const PartFit alone = fit_part(part, measured(spots, Pose::Identity(), {10e-6, 0}), kTolerance);
  const PartFit shared = fit_part(part, measured(spots, Pose::Identity(), {10e-6, 20e-6}), kTolerance);
  EXPECT_NEAR(std::sqrt(alone.covariance(2, 2)), 2e-6, 0.02e-6);  // 10 um over the root of 25
  EXPECT_NEAR(std::sqrt(shared.covariance(2, 2)), std::hypot(2e-6, 20e-6), 0.02e-6);
}

TEST(PartFit, APartOfAnotherSizeIsNotTheOneExpected) {
  const geometry::Mesh part = mesh_of(geometry::box(kLower, kUpper));
  const auto longer = box_spots(kLower - Vec3(0.2e-3, 0, 0), kUpper + Vec3(0.2e-3, 0, 0));
  const PartFit wrong = fit_part(part, measured(longer, Pose::Identity(), {10e-6, 0}), kTolerance);
  EXPECT_FALSE(wrong.expected_part());
  EXPECT_GT(wrong.chi_square, wrong.chi_square_limit);
  // A part whose size may be off by a per cent may be so long: 0.2 of 40 mm is half of that.
  PartTolerance loose = kTolerance;
  loose.size = 0.01;
  EXPECT_TRUE(fit_part(part, measured(longer, Pose::Identity(), {100e-6, 0}), loose).expected_part());
}

// Tables of the chi-square distribution: 0.9999 of 9 degrees of freedom is 33.72. The approximation is 2 per
// cent off so far out.
TEST(PartFit, TheLimitIsThatOfOneInTenThousand) {
  const geometry::Mesh part = mesh_of(geometry::box(kLower, kUpper));
  EXPECT_NEAR(fit_part(part, measured(box_spots(), Pose::Identity(), {5e-6, 0}), kTolerance).chi_square_limit,
              33.72, 0.02 * 33.72);
  auto fewer = box_spots();
  fewer.resize(9);
  fewer.push_back(box_spots().back());
  const PartFit fit = fit_part(part, measured(fewer, Pose::Identity(), {5e-6, 0}), kTolerance);
  EXPECT_EQ(fit.degrees_of_freedom, 10 - fit.seen);
}

}  // namespace
}  // namespace understudy::control
