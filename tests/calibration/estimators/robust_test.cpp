// Outlying poses: a target taken for another shifts and turns a whole pose.
#include <gmock/gmock.h>

#include "core/random_vector.h"
#include "tests/calibration/calibration_rig.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

/// Spoils `count` poses by 0.3 to 2 mm and 3 to 20 mrad; returns which.
std::vector<bool> spoil(Problem& problem, std::size_t count, Random& random) {
  std::vector<bool> good(problem.samples.size(), true);
  while (count > 0) {
    const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(good.size()));
    if (!good[j]) continue;
    good[j] = false;
    --count;
    const auto direction = [&random] { return normal_vec3(random).normalized(); };
    Pose& X = problem.samples[j].X_BT;
    X.translation() += random.uniform(0.3e-3, 2e-3) * direction();
    X.linear() = exp_rotation(random.uniform(3e-3, 20e-3) * direction()) * X.linear();
  }
  return good;
}

TEST(Robust, TenPercentOfOutliersCostNoMoreThanTheirPoses) {
  double with_sum = 0, clean_sum = 0, plain_sum = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Case c = make_case(seed, 24);
    Random noise(seed, "outliers");
    const Problem clean = c.noisy(noise);
    Problem spoilt = clean;
    const std::vector<bool> good = spoil(spoilt, 3, noise);  // 12.5 %
    const Calibration found = make_robust()->calibrate(spoilt);
    ASSERT_TRUE(found.ok()) << found.message;
    EXPECT_EQ(found.used, good) << "seed " << seed;
    EXPECT_THAT(found.warnings.back(), HasSubstr("rejected as outliers"));
    with_sum += c.median_tip_error(found.parameters);
    clean_sum += c.median_tip_error(make_maximum_likelihood()->calibrate(clean).parameters);
    const Calibration plain = make_maximum_likelihood()->calibrate(spoilt);
    plain_sum += c.median_tip_error(plain.parameters);
    ASSERT_FALSE(plain.warnings.empty());  // who takes all poses is told
    EXPECT_THAT(plain.warnings.front(), HasSubstr("times what the stated noise explains"));
  }
  // 21 of 24 poses: sqrt(24 / 21) = 1.07 and a little for the worse design.
  EXPECT_LT(with_sum, 1.3 * clean_sum);
  EXPECT_GT(plain_sum, 4 * clean_sum);
}

TEST(Robust, WithoutOutliersItIsMaximumLikelihood) {
  int same = 0;
  constexpr int kRuns = 8;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Random noise(seed, "no outliers");
    const Problem problem = make_case(seed, 24).noisy(noise);
    const auto robust = make_robust()->calibrate(problem), ml = make_maximum_likelihood()->calibrate(problem);
    ASSERT_TRUE(robust.ok() && ml.ok());
    same += largest_error(robust.parameters.geometry, ml.parameters.geometry) < 1e-9;
  }
  EXPECT_GE(same, kRuns - 2);  // a pose in a thousand lies beyond the limit by chance
}

// Noise three times what is stated makes no pose an outlier: all are alike.
TEST(Robust, UnderstatedNoiseIsNotTakenForOutliers) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random noise(seed, "understated");
    Problem problem = make_case(seed, 24).noisy(noise);
    for (PoseSample& sample : problem.samples) sample.covariance /= 9;
    const Calibration found = make_robust()->calibrate(problem);
    ASSERT_TRUE(found.ok()) << found.message;
    EXPECT_LE(std::count(found.used.begin(), found.used.end(), false), 2) << "seed " << seed;
  }
}

}  // namespace
}  // namespace understudy::calibration
