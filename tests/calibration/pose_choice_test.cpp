#include "calibration/pose_choice.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/calibration/calibration_rig.h"

namespace understudy::calibration {
namespace {

DesignSetting setting() { return {{rig().nominal, {}}, kReferenceNoise.covariance(), {}}; }

double value(std::span<const Pose> candidates, const std::vector<std::size_t>& design) {
  std::vector<Pose> poses;
  for (const std::size_t j : design) poses.push_back(candidates[j]);
  return log_det_information(setting(), poses);
}

TEST(RandomPoses, LieInTheRegionAndBreakNoLimit) {
  Random random(1, "random poses");
  const PoseRegion& region = rig().region;
  for (const Pose& X : rig().poses(200, random)) {
    const Vec3 from_centre = X.translation() - region.centre_B;
    EXPECT_LE(from_centre.cwiseAbs().maxCoeff(), 0.05);
    EXPECT_LE(angle_between(rig().mechanism->home().linear(), X.linear()), from_deg(20 + 15));
    EXPECT_GE(X.linear()(2, 2), std::cos(from_deg(20)) - 1e-12);
    std::vector<double> axes(6);
    ASSERT_EQ(rig().mechanism->inverse(X, {}, axes), kinematics::SolveStatus::ok);
    std::vector<kinematics::LimitViolation> violations;
    rig().mechanism->check(X, axes, violations);
    EXPECT_TRUE(violations.empty()) << to_string(violations[0]);
  }
}

TEST(RandomPoses, ARegionOutOfReachIsAnError) {
  Random random(1, "out of reach");
  PoseRegion region = rig().region;
  region.centre_B.z() -= 0.5;
  // However many are asked for, the end of a search without a find is not waited for.
  for (const auto& [count, tries] : {std::pair(2u, "20000"), std::pair(400u, "46000")}) try {
      random_reachable_poses(*rig().mechanism, region, count, random);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(std::string("0 of ") + tries +
                                                     " random poses are within the machine's limits"));
    }
}

TEST(DOptimal, NoExchangeOfAPoseImprovesTheDesign) {
  Random random(2, "d-optimal");
  const auto candidates = rig().poses(60, random);
  auto design = d_optimal(setting(), candidates, 10, random);
  ASSERT_EQ(design.size(), 10u);
  EXPECT_TRUE(std::is_sorted(design.begin(), design.end()));
  EXPECT_EQ(std::adjacent_find(design.begin(), design.end()), design.end());
  const double best = value(candidates, design);
  for (std::size_t& place : design) {
    const std::size_t kept = place;
    for (std::size_t j = 0; j < candidates.size(); ++j) {
      if (std::find(design.begin(), design.end(), j) != design.end()) continue;
      place = j;
      EXPECT_LE(value(candidates, design), best + 1e-5);  // the exchange stops at 1e-6
    }
    place = kept;
  }
}

// Few enough to try every design.
TEST(DOptimal, FindsTheBestOfAllDesignsOfASmallSet) {
  Random random(3, "small d-optimal");
  const auto candidates = rig().poses(12, random);
  double best = -1e300;
  for (unsigned mask = 0; mask < 1u << 12; ++mask) {
    if (__builtin_popcount(mask) != 9) continue;
    std::vector<std::size_t> design;
    for (std::size_t j = 0; j < 12; ++j)
      if (mask >> j & 1u) design.push_back(j);
    best = std::max(best, value(candidates, design));
  }
  EXPECT_NEAR(value(candidates, d_optimal(setting(), candidates, 9, random, 10)), best, 1e-6);
}

TEST(DOptimal, HalvesTheBoundOfRandomPoses) {
  Random random(4, "halves");
  const Case c = make_case(4, 12);
  const auto bound = [&](const std::vector<Pose>& poses) {
    std::vector<PoseSample> samples(poses.size());
    for (std::size_t j = 0; j < poses.size(); ++j) {
      samples[j].X_BT = poses[j];
      samples[j].covariance = kReferenceNoise.covariance();
    }
    return to_um(tip_uncertainty(c.truth, parameter_bound(c.truth, samples, {}), {}, c.held_out).rms);
  };
  const auto candidates = rig().poses(300, random);
  std::vector<Pose> best;
  for (const std::size_t j : d_optimal(setting(), candidates, 12, random)) best.push_back(candidates[j]);
  EXPECT_NEAR(bound(best), 22, 0.2 * 22);  // docs/reference.md#calibration-figures; its own 300 candidates
  EXPECT_LT(bound(best), 0.65 * bound({candidates.begin(), candidates.begin() + 12}));
}

TEST(DOptimal, GivesAllWhereThereIsNothingToChoose) {
  Random random(5, "all");
  const auto candidates = rig().poses(5, random);
  EXPECT_EQ(d_optimal(setting(), candidates, 7, random), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace understudy::calibration
