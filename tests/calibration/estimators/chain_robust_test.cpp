// Spoiled poses of the arm. What a fit should be is told by the likelihood of the poses that were not
// spoiled, which the robust estimator does not know.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "calibration/estimators/chain_calibration.h"
#include "calibration/synthetic.h"
#include "core/random_vector.h"
#include "core/units.h"
#include "machine/description.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

const kinematics::Chain& chain() {
  static const kinematics::Chain arm = machine::load_machine("arm").chain().kinematics.chain;
  return arm;
}

const ChainParameters& nominal() {
  static const ChainParameters drawn{chain(), {}};
  return drawn;
}

std::vector<double> readings(Random& random) {
  std::vector<double> q;
  for (const auto& axis : chain().axes) q.push_back(random.uniform(0.5 * axis.lower, 0.5 * axis.upper));
  return q;
}

/// An arm whose every parameter is off by 1 mm or 1 mrad, 1 sigma, and its measured poses.
struct ArmCase {
  Random random;
  ChainParameters truth;
  std::vector<ChainSample> samples;
  std::vector<bool> good;
  std::vector<std::vector<double>> held_out;

  ArmCase(std::uint64_t seed, std::size_t poses) : random(seed, "robust arm") {
    Eigen::VectorXd by(static_cast<Eigen::Index>(chain_parameter_names(chain()).size()));
    for (double& x : by) x = 1e-3 * random.normal();
    truth = moved(nominal(), by);
    for (std::size_t j = 0; j < poses; ++j) add(readings(random));
    for (int n = 0; n < 60; ++n) held_out.push_back(readings(random));
  }

  void add(const std::vector<double>& axes) {
    PoseSample sample;
    sample.X_BT = forward(truth, axes);
    sample.covariance = kReferenceNoise.covariance();
    samples.push_back({axes, measured(sample, random).X_BT, sample.covariance});
    good.push_back(true);
  }

  /// `count` poses off by 1 to 5 mm and 1 to 5 degrees.
  void spoil(std::size_t count) {
    const auto direction = [this] { return normal_vec3(random).normalized(); };
    while (count > 0) {
      const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(good.size()));
      if (!good[j]) continue;
      good[j] = false;
      --count;
      Pose& X = samples[j].X_ST;
      X.translation() += random.uniform(1e-3, 5e-3) * direction();
      X.linear() = exp_rotation(random.uniform(1, 5) * kDegree * direction()) * X.linear();
    }
  }

  std::vector<ChainSample> unspoiled() const {
    std::vector<ChainSample> left;
    for (std::size_t j = 0; j < samples.size(); ++j)
      if (good[j]) left.push_back(samples[j]);
    return left;
  }

  /// "rejected as outliers: poses 3, 7"
  std::string expected_warning() const {
    std::string text;
    for (std::size_t j = 0; j < good.size(); ++j)
      if (!good[j]) text += (text.empty() ? "rejected as outliers: poses " : ", ") + std::to_string(j + 1);
    return text;
  }

  /// [m^2], mean over readings held out.
  double square_error(const ChainParameters& model) const {
    double sum = 0;
    for (const auto& q : held_out)
      sum += (forward(model, q).translation() - forward(truth, q).translation()).squaredNorm();
    return sum / static_cast<double>(held_out.size());
  }
};

/// Tip errors with `bad` of `poses` spoiled, over 10 arms; each rejects just the spoiled ones.
void expect_spoiled_poses_cost_only_themselves(std::size_t poses, std::size_t bad) {
  double robust_sum = 0, clean_sum = 0, plain_sum = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    ArmCase c(seed, poses);
    c.spoil(bad);
    const ChainCalibration found = calibrate_chain_robust(nominal(), c.samples);
    const ChainCalibration clean = calibrate_chain(nominal(), c.unspoiled());
    ASSERT_TRUE(found.ok()) << found.message << ", seed " << seed;
    ASSERT_TRUE(clean.ok()) << clean.message << ", seed " << seed;
    // A good pose in a thousand is left out by chance; a spoiled one never slips in.
    for (std::size_t j = 0; j < poses; ++j) EXPECT_FALSE(found.used[j] && !c.good[j]) << "seed " << seed;
    robust_sum += c.square_error(found.parameters);
    clean_sum += c.square_error(clean.parameters);
    plain_sum += c.square_error(calibrate_chain(nominal(), c.samples).parameters);
    if (found.used != c.good) continue;
    ASSERT_EQ(found.warnings.size(), 1u);
    EXPECT_EQ(found.warnings.front(), c.expected_warning());
    // One search, two ways to it: rounding times the condition.
    EXPECT_TRUE(found.covariance.isApprox(clean.covariance, 1e-6));
    EXPECT_EQ(found.degrees_of_freedom, clean.degrees_of_freedom);
    EXPECT_EQ(found.residuals.size(), poses);
  }
  EXPECT_LT(std::sqrt(robust_sum), 1.3 * std::sqrt(clean_sum));
  EXPECT_GT(std::sqrt(plain_sum), 10 * std::sqrt(clean_sum));
}

TEST(ChainRobust, FifteenPercentOfSpoiledPosesCostNoMoreThanThemselvesAndAreNamed) {
  expect_spoiled_poses_cost_only_themselves(20, 3);
}

TEST(ChainRobust, AQuarterOfThePosesMayBeSpoiled) { expect_spoiled_poses_cost_only_themselves(24, 6); }

// Both see the same draws, so only poses left out by chance tell them apart: one arm in 50, which then loses
// up to a third. 60 arms know the loss to half a percent.
TEST(ChainRobust, WithoutSpoiledPosesItLosesLessThanFivePercentOfEfficiency) {
  double robust_sum = 0, plain_sum = 0;
  for (std::uint64_t seed = 101; seed <= 160; ++seed) {
    const ArmCase c(seed, 20);
    const ChainCalibration found = calibrate_chain_robust(nominal(), c.samples);
    ASSERT_TRUE(found.ok()) << found.message << ", seed " << seed;
    robust_sum += c.square_error(found.parameters);
    plain_sum += c.square_error(calibrate_chain(nominal(), c.samples).parameters);
  }
  EXPECT_GT(plain_sum / robust_sum, 0.95);
}

// Noise three times what is stated makes no pose an outlier: all are alike.
TEST(ChainRobust, UnderstatedNoiseIsNotTakenForOutliers) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    ArmCase c(seed, 24);
    for (ChainSample& sample : c.samples) sample.covariance /= 9;
    const ChainCalibration found = calibrate_chain_robust(nominal(), c.samples);
    ASSERT_TRUE(found.ok()) << found.message;
    EXPECT_LE(std::count(found.used.begin(), found.used.end(), false), 2) << "seed " << seed;
  }
}

TEST(ChainRobust, RefusesWhatNoPosesCanTellAsTheLikelihoodDoes) {
  ArmCase c(1, 12);
  std::vector<ChainSample> samples = c.samples;
  for (ChainSample& sample : samples) sample.axes[2] = 0.1;
  ChainCalibration found = calibrate_chain_robust(nominal(), samples);
  EXPECT_EQ(found.status, Status::rank_deficient);
  EXPECT_THAT(found.message, HasSubstr("of 30 independent parameters: move every axis"));
  samples = c.samples;
  samples.resize(3);
  EXPECT_EQ(calibrate_chain_robust(nominal(), samples).status, Status::too_few_poses);
  samples[1].axes.pop_back();
  found = calibrate_chain_robust(nominal(), samples);
  EXPECT_EQ(found.status, Status::bad_input);
  EXPECT_EQ(found.message, "pose 2: 5 axis readings for 6 axes");
}

// 5 poses tell 30 parameters, a sixth contradicts them, and a seventh says which is wrong.
TEST(ChainRobust, RefusesPosesTooFewToLeaveOneOut) {
  const ArmCase c(1, 6);
  EXPECT_TRUE(calibrate_chain(nominal(), c.samples).ok());
  const ChainCalibration found = calibrate_chain_robust(nominal(), c.samples);
  EXPECT_EQ(found.status, Status::too_few_poses);
  EXPECT_EQ(found.message, "of 6 poses none can be rejected: robust needs at least 7");
  EXPECT_TRUE(calibrate_chain_robust(nominal(), ArmCase(1, 7).samples).ok());
}

// 5 poses that differ, one of them measured 36 times: told, but never by 6 poses at random.
TEST(ChainRobust, RefusesPosesThatRepeatEachOther) {
  ArmCase c(1, 5);
  for (int n = 0; n < 35; ++n) c.add(c.samples[0].axes);
  EXPECT_TRUE(calibrate_chain(nominal(), c.samples).ok());
  const ChainCalibration found = calibrate_chain_robust(nominal(), c.samples);
  EXPECT_EQ(found.status, Status::not_converged);
  EXPECT_THAT(found.message, HasSubstr("move every axis from pose to pose"));
}

}  // namespace
}  // namespace understudy::calibration
