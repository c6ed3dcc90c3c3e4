#include "calibration/estimators/chain_calibration.h"

#include <gmock/gmock.h>

#include "calibration/estimators/chain_likelihood.h"
#include "core/random.h"
#include "core/units.h"
#include "machine/description.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

kinematics::ChainDescription arm() { return machine::load_machine("arm").chain().kinematics; }

std::vector<double> readings(const kinematics::ChainDescription& arm, Random& random) {
  std::vector<double> q;
  for (const auto& axis : arm.chain.axes) q.push_back(random.uniform(0.5 * axis.lower, 0.5 * axis.upper));
  return q;
}

/// Every parameter off by 1 mm or 1 mrad, 1 sigma.
ChainParameters built(const ChainParameters& nominal, Random& random) {
  Eigen::VectorXd by(static_cast<Eigen::Index>(chain_parameter_names(nominal.chain).size()));
  for (double& x : by) x = 1e-3 * random.normal();
  return moved(nominal, by);
}

TEST(ChainCalibration, RowsAreTheDerivativeOfForwardKinematics) {
  const auto description = arm();
  Random random(1, "chain rows");
  const ChainParameters machine = built({description.chain, {}}, random);
  const auto q = readings(description, random);
  const Eigen::MatrixXd rows = chain_rows(machine, q);
  constexpr double kStep = 1e-6;  // truncation 1e-12, rounding 1e-10 of the derivative
  for (Eigen::Index k = 0; k < rows.cols(); ++k) {
    Eigen::VectorXd by = Eigen::VectorXd::Zero(rows.cols());
    by[k] = kStep;
    const Pose after = forward(moved(machine, by), q), before = forward(moved(machine, -by), q);
    Twist change;
    change << after.translation() - before.translation(),
        log_rotation(after.linear() * before.linear().transpose());
    EXPECT_LT((change / (2 * kStep) - rows.col(k)).cwiseAbs().maxCoeff(), 1e-8)
        << chain_parameter_names(machine.chain)[static_cast<std::size_t>(k)];
  }
}

// Everett 1987: 4 for a turning axis, and 6.
TEST(ChainCalibration, ThirtyParametersOfTheArmAreIndependentAndTheOthersAreNamed) {
  const auto description = arm();
  const ChainParameters nominal{description.chain, {}};
  Random random(2, "chain");
  const ChainParameters truth = built(nominal, random);
  std::vector<ChainSample> samples(20);
  for (ChainSample& s : samples) {
    s.axes = readings(description, random);
    s.X_ST = forward(truth, s.axes);
    s.covariance = Mat6::Identity() * 1e-9;
  }
  const ChainCalibration found = calibrate_chain(nominal, samples);
  ASSERT_TRUE(found.ok()) << found.message;
  EXPECT_EQ(found.estimated.size(), 30u);
  EXPECT_EQ(found.estimated.size() + found.redundant.size(), chain_parameter_names(nominal.chain).size());
  // Without noise the very machine, where it was not measured too; 1e-10 m: rounding times the condition.
  for (int n = 0; n < 50; ++n) {
    const auto q = readings(description, random);
    const Pose asked = forward(truth, q), reached = forward(found.parameters, q);
    EXPECT_LT((asked.translation() - reached.translation()).norm(), 1e-10);
    EXPECT_LT(angle_between(asked.linear(), reached.linear()), 1e-7);  // acos of 1 - 1e-16 resolves 1e-8
  }
}

TEST(ChainCalibration, AnAxisThatNeverMovesIsToldByTheRank) {
  const auto description = arm();
  const ChainParameters nominal{description.chain, {}};
  Random random(3, "chain still");
  std::vector<ChainSample> samples(12);
  for (ChainSample& s : samples) {
    s.axes = readings(description, random);
    s.axes[2] = 0.1;
    s.X_ST = forward(nominal, s.axes);
  }
  const ChainCalibration found = calibrate_chain(nominal, samples);
  EXPECT_EQ(found.status, Status::rank_deficient);
  EXPECT_THAT(found.message, HasSubstr("of 30 independent parameters: move every axis"));
  samples.resize(3);
  EXPECT_EQ(calibrate_chain(nominal, samples).status, Status::too_few_poses);
  samples[1].axes.pop_back();
  EXPECT_EQ(calibrate_chain(nominal, samples).message, "pose 2: 5 axis readings for 6 axes");
}

// What all poses tell, some of them may not: axis 3 stands still in the first six.
// Rounding lets about one such set in a hundred through a factorisation, so the draws are many.
TEST(ChainLikelihood, PosesThatLeaveAnAxisStillAreNotFitted) {
  const auto description = arm();
  const ChainParameters nominal{description.chain, {}};
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    Random random(seed, "chain some");
    std::vector<ChainSample> samples(12);
    std::vector<bool> first(12, false), last(12, true);
    for (std::size_t j = 0; j < samples.size(); ++j) {
      samples[j].axes = readings(description, random);
      if (j < 6) samples[j].axes[2] = 0.1, first[j] = true, last[j] = false;
      samples[j].X_ST = forward(nominal, samples[j].axes);
    }
    const ChainLikelihood likelihood(nominal, samples);
    ASSERT_EQ(likelihood.refusal().message, "");
    EXPECT_FALSE(likelihood.fit(first, 30).identifiable) << "seed " << seed;
    EXPECT_TRUE(likelihood.fit(last, 30).identifiable) << "seed " << seed;
    EXPECT_FALSE(likelihood.calibration(first, 30).ok()) << "seed " << seed;
  }
}

}  // namespace
}  // namespace understudy::calibration
