// What the data cannot tell is said before any fit (docs/reference.md#identifiable-parameters: 42 of 42; 8
// with dev; 4 of 7 without rotation).
#include "calibration/identifiability.h"

#include <gmock/gmock.h>

#include "tests/calibration/calibration_rig.h"

namespace understudy::calibration {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;

Problem noisy_problem(std::uint64_t seed, std::size_t poses) {
  Random noise(seed, "identifiability noise");
  return make_case(seed, poses).noisy(noise);
}

Problem in_region(const PoseRegion& region, bool noisy) {
  Random random(4, "region");
  Problem problem{{rig().nominal, {}}, {}};
  for (const Pose& X_BT : random_reachable_poses(*rig().mechanism, region, 12, random)) {
    PoseSample sample;
    EXPECT_TRUE(true_sample({rig().nominal, {}}, rig().nominal, X_BT, kReferenceNoise, {}, sample));
    problem.samples.push_back(noisy ? measured(sample, random) : sample);
  }
  return problem;
}

/// Every estimator refuses, with the same words, and leaves the nominal machine as it was.
void expect_all_refuse(const Problem& problem, Status status, const std::string& words) {
  for (const EstimatorEntry& entry : estimators()) {
    const Calibration found = entry.make()->calibrate(problem);
    EXPECT_EQ(found.status, status) << entry.name << ": " << found.message;
    EXPECT_THAT(found.message, HasSubstr(words)) << entry.name;
    EXPECT_EQ(largest_error(found.parameters.geometry, problem.nominal.geometry), 0) << entry.name;
  }
}

TEST(Identifiability, TwelvePosesTellAllFortyTwoParameters) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Identifiability found = check_identifiability(noisy_problem(seed, 12), {});
    EXPECT_EQ(found.status, Status::ok) << found.message;
    EXPECT_EQ(found.rank, 42);
    EXPECT_THAT(found.strut_rank, Each(7));
    EXPECT_GT(found.condition, 10);   // unlike parameters
    EXPECT_LT(found.condition, 1e4);  // far from what double precision could not take
  }
}

TEST(Identifiability, DevIsAnEighthParameterOfAStrut) {
  const Identifiability found = check_identifiability(noisy_problem(1, 50), {.deviation = true});
  EXPECT_EQ(found.status, Status::ok) << found.message;
  EXPECT_EQ(found.rank, 43);
  EXPECT_THAT(found.strut_rank, Each(8));
}

// Noise turns every measured pose by 0.2 mrad, which makes the Jacobian full in numbers but not in fact.
TEST(Identifiability, WithoutRotationFourOfSevenAreLeftAndTheAdviceIsToTilt) {
  PoseRegion region = rig().region;
  region.tilt_max = region.yaw_max = 0;
  for (const bool noisy : {false, true}) {
    const Problem problem = in_region(region, noisy);
    const Identifiability found = check_identifiability(problem, {});
    EXPECT_THAT(found.strut_rank, Each(4)) << (noisy ? "noisy" : "exact");
    EXPECT_EQ(found.rank, 24);
    expect_all_refuse(problem, Status::no_rotation, "only 4 of the 7 parameters");
  }
  EXPECT_THAT(check_identifiability(in_region(region, true), {}).message, HasSubstr("tilt the platform"));
}

TEST(Identifiability, RotationAboutOneAxisIsNamed) {
  PoseRegion region = rig().region;
  region.tilt_max = 0;
  const Problem problem = in_region(region, true);
  EXPECT_THAT(check_identifiability(problem, {}).strut_rank, Each(6));
  expect_all_refuse(problem, Status::no_rotation, "about a second axis");
}

TEST(Identifiability, TooFewPosesSayHowManyAreNeeded) {
  expect_all_refuse({{rig().nominal, {}}, {}}, Status::bad_input, "there is no pose");
  Problem problem = noisy_problem(1, 12);
  problem.samples.resize(6);
  expect_all_refuse(problem, Status::too_few_poses, "36 equations");
  EXPECT_THAT(check_identifiability(problem, {}).message, HasSubstr("measure at least 7"));
  EXPECT_THAT(check_identifiability(problem, {.deviation = true}).message, HasSubstr("measure at least 8"));
}

TEST(Identifiability, RepeatedPosesCountOnce) {
  Problem problem = noisy_problem(1, 6);
  for (std::size_t j = 0; j < 6; ++j) problem.samples.push_back(problem.samples[j]);
  expect_all_refuse(problem, Status::repeated_poses, "6 different poses (12 rows");
  // Repeating a full set is no fault.
  Problem full = noisy_problem(1, 12);
  for (std::size_t j = 0; j < 12; ++j) full.samples.push_back(full.samples[j]);
  const Identifiability found = check_identifiability(full, {});
  EXPECT_EQ(found.status, Status::ok) << found.message;
  EXPECT_TRUE(found.warnings.empty());
}

TEST(Identifiability, EqualCommandsMeasuredApartWarn) {
  Problem problem = noisy_problem(1, 12);
  problem.samples.push_back(problem.samples[2]);
  problem.samples.back().X_BT.translation().x() += 1e-3;
  const Identifiability found = check_identifiability(problem, {});
  EXPECT_EQ(found.status, Status::ok);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_THAT(found.warnings[0],
              HasSubstr("poses 3 and 13 were commanded alike but measured 1.000 mm apart"));
}

TEST(Identifiability, ADeadStrutOrAxisIsNamed) {
  Problem strut = noisy_problem(1, 12);
  for (PoseSample& sample : strut.samples) sample.displacement[3] = 0.02;
  expect_all_refuse(strut, Status::dead_measurement, "strut 4 reads the same displacement, 20.000 mm");
  Problem axis = noisy_problem(1, 12);
  Random noise(2, "dead axis");
  for (PoseSample& sample : axis.samples) sample.X_BT.translation().z() = 0.01 + 20e-6 * noise.normal();
  expect_all_refuse(axis, Status::dead_measurement, "z of the measured poses");
}

TEST(Identifiability, BadNumbersNameThePose) {
  const Problem good = noisy_problem(1, 12);
  const auto spoilt = [&good](auto spoil) {
    Problem p = good;
    spoil(p.samples[4]);
    return p;
  };
  const double nan = std::nan("");
  expect_all_refuse(spoilt([&](PoseSample& s) { s.X_BT.translation().x() = nan; }), Status::bad_input,
                    "pose 5");
  expect_all_refuse(spoilt([&](PoseSample& s) { s.X_BT.linear() *= 1.01; }), Status::bad_input, "rigid");
  expect_all_refuse(spoilt([&](PoseSample& s) { s.displacement[1] = nan; }), Status::bad_input, "strut 2");
  expect_all_refuse(spoilt([&](PoseSample& s) { s.displacement[1] = 20; }), Status::bad_input, "below 10 m");
  expect_all_refuse(spoilt([&](PoseSample& s) { s.X_BT.translation() *= 1e3; }), Status::bad_input, "metres");
  expect_all_refuse(spoilt([&](PoseSample& s) { s.covariance.setZero(); }), Status::bad_input, "covariance");
  expect_all_refuse(spoilt([&](PoseSample& s) { s.covariance(0, 1) = 1e-9; }), Status::bad_input,
                    "symmetric");
}

TEST(Identifiability, PlayNeedsBothApproaches) {
  Problem problem = noisy_problem(1, 24);
  for (PoseSample& sample : problem.samples) sample.approach.fill(Approach::lengthening);
  problem.samples[0].approach[0] = Approach::shortening;
  const Identifiability found = check_identifiability(problem, {.play = true});
  EXPECT_EQ(found.status, Status::rank_deficient);
  EXPECT_THAT(found.message, HasSubstr("strut 2 never came to a pose by shortening"));
}

}  // namespace
}  // namespace understudy::calibration
