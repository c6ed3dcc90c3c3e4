// The search on the simplest model of all: a pose is six numbers about one mean. Its fit is the average of
// the poses used, of covariance 1 / n, which are the closed forms.
#include "calibration/estimators/trimmed_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/frames.h"
#include "core/random.h"
#include "tests/told_progress.h"

namespace understudy::calibration {
namespace {

class MeanOfPoses : public PoseFit {
 public:
  MeanOfPoses(std::size_t count, std::uint64_t seed) {
    Random random(seed, "mean of poses");
    for (std::size_t j = 0; j < count; ++j) {
      Twist pose;
      for (double& x : pose) x = random.normal();
      poses.push_back(pose);
    }
  }

  bool fit(const std::vector<bool>& used, int, std::vector<double>& distances) override {
    Twist mean = Twist::Zero();
    double count = 0;
    for (std::size_t j = 0; j < poses.size(); ++j)
      if (used[j]) mean += poses[j], ++count;
    mean /= count;
    distances.clear();
    for (std::size_t j = 0; j < poses.size(); ++j)
      distances.push_back((poses[j] - mean).squaredNorm() / (used[j] ? 1 : 1 + 1 / count));
    return true;
  }

  std::vector<Twist> poses;
};

class NoFit : public PoseFit {
 public:
  bool fit(const std::vector<bool>&, int, std::vector<double>&) override { return false; }
};

// Six numbers a pose: 7 poses tell the hexapod's 42 parameters, 5 the arm's 30.
TEST(TrimmedSearch, StartsFromOnePoseMoreThanTheParametersNeed) {
  EXPECT_EQ(start_poses(42), 8u);
  EXPECT_EQ(start_poses(30), 6u);
  EXPECT_EQ(start_poses(31), 7u);
}

TEST(TrimmedSearch, LeavesOutTheQuarterThatLiesElsewhereEvenWhereItAgreesWithItself) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    MeanOfPoses model(24, seed);
    std::vector<bool> good(24, true);
    for (std::size_t j = 0; j < 6; ++j) {
      model.poses[3 * j] += Twist::Constant(20);
      good[3 * j] = false;
    }
    EXPECT_EQ(agreeing_poses(model, {24, 6, 50, seed}), good) << "seed " << seed;
  }
}

// 0.999 of the poses lie within the limit: of 2400 some 2.4 do not, 6 by one chance in 30.
TEST(TrimmedSearch, TakesNearlyAllPosesThatAreAlike) {
  std::ptrdiff_t rejected = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    MeanOfPoses model(24, seed);
    const std::vector<bool> used = agreeing_poses(model, {24, 6, 50, seed});
    rejected += std::count(used.begin(), used.end(), false);
  }
  EXPECT_LE(rejected, 6);
}

TEST(TrimmedSearch, FindsNothingWhereNoStartCanBeFitted) {
  NoFit model;
  EXPECT_TRUE(agreeing_poses(model, {24, 30, 50, 1}).empty());
}

TEST(TrimmedSearch, NamesWhatIsLeftOutFromOneOn) {
  EXPECT_EQ(rejection_warning({true, true}), "");
  EXPECT_EQ(rejection_warning({false, true, true, false}), "rejected as outliers: poses 1, 4");
}

TEST(TrimmedSearch, TellsHowManyStartsAreTried) {
  MeanOfPoses model(24, 1);
  test::ToldProgress told;
  (void)agreeing_poses(model, {24, 6, 50, 1, told.teller()});
  EXPECT_EQ(told.stages(), (std::set<std::string>{"fits to a few poses", "poses that join"}));
  EXPECT_GE(told.times(), 60u);
}

}  // namespace
}  // namespace understudy::calibration
