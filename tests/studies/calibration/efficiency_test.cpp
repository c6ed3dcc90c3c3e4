// The acceptance of docs/reference.md#whitening, and the table of #calibration-figures. Efficiency is the
// bound's variance over the mean squared error; a run's error has about 15 independent parts, so n runs know
// it to about 0.4 / sqrt(n).
#include <gtest/gtest.h>

#include <map>

#include "studies/calibration/estimator_study.h"
#include "tests/calibration/calibration_rig.h"

namespace understudy::studies {
namespace {

using namespace calibration;

StudySetting setting(std::uint64_t seed) {
  StudySetting s;
  s.nominal = rig().nominal;
  s.mechanism = rig().mechanism.get();
  s.region = rig().region;
  s.seed = seed;
  return s;
}

const std::vector<std::string> kPlainWhitenedLikelihood{"ik_residual", "whitened", "maximum_likelihood"};

/// Over machines: means of efficiencies, medians of the rest; `runs` = machines x sets x draws.
struct Summary {
  std::map<std::string, double> efficiency, median_um;
  double bound_um = 0;
  int runs = 0, failures = 0;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

Summary over_machines(int machines, const StudyPlan& plan) {
  Summary summary;
  std::map<std::string, double> excess;
  std::map<std::string, std::vector<double>> medians;
  std::vector<double> bounds;
  for (int m = 1; m <= machines; ++m) {
    const Study study = run_study(setting(static_cast<std::uint64_t>(m)), plan, kPlainWhitenedLikelihood);
    bounds.push_back(to_um(median(study.bounds)));
    for (const StudyResult& r : study.results) {
      excess[r.estimator] += 1 / r.efficiency / machines;
      medians[r.estimator].push_back(to_um(r.median));
      summary.failures += r.failures;
    }
    summary.runs += study.results[0].runs;
  }
  summary.bound_um = median(bounds);
  for (const auto& [name, value] : excess) summary.efficiency[name] = 1 / value;
  for (const auto& [name, values] : medians) summary.median_um[name] = median(values);
  return summary;
}

// 600 runs: 0.017 of noise. 0.95 is what an estimator called efficient must reach; 0.54 is the plain one's
// figure at 24 poses, and 0.75 lies 10 standard deviations from both.
TEST(Efficiency, WhitenedAndLikelihoodReachTheBoundAndThePlainResidualDoesNot) {
  Summary found = over_machines(2, {24, PoseChoice::random, 10, 30});
  EXPECT_EQ(found.runs, 600);
  EXPECT_EQ(found.failures, 0);
  EXPECT_GE(found.efficiency["whitened"], 0.95);
  EXPECT_GE(found.efficiency["maximum_likelihood"], 0.95);
  EXPECT_LE(found.efficiency["maximum_likelihood"], 1.06);  // more would be a wrong bound
  EXPECT_LT(found.efficiency["ik_residual"], 0.75);
  EXPECT_GT(found.efficiency["ik_residual"], 0.35);
}

// docs/reference.md#calibration-figures, one machine of its own: 41 (paper's estimator), 32 (likelihood), 21
// (D-optimal, likelihood) um. Machines drawn here scatter from 43 to 63 (paper's estimator) and from 31 to 39
// um (likelihood).
TEST(Efficiency, TwelvePosesGiveTheReferenceFigures) {
  Summary random = over_machines(7, {12, PoseChoice::random, 8, 6});
  EXPECT_NEAR(random.median_um["ik_residual"], 41, 0.25 * 41);
  EXPECT_NEAR(random.median_um["maximum_likelihood"], 32, 0.15 * 32);
  EXPECT_NEAR(random.bound_um, 43, 0.25 * 43);
  Summary chosen = over_machines(2, {12, PoseChoice::d_optimal, 2, 12});
  EXPECT_NEAR(chosen.median_um["maximum_likelihood"], 21, 0.15 * 21);
}

struct TableRow {
  std::size_t poses;
  // [um], docs/reference.md#calibration-figures, G4
  double bound, bound_chosen, plain, likelihood, chosen_likelihood;
};

TEST(SlowCalibrationTables, MeetReferenceBOverEightMachines) {
  for (const TableRow& row : {TableRow{8, 97, 30, 91, 66, 28}, TableRow{12, 43, 22, 41, 32, 21},
                              TableRow{24, 21.4, 15.5, 22, 18, 13}, TableRow{50, 13.1, 10.6, 13.8, 12.3, 9.3},
                              TableRow{100, 8.9, 7.5, 9.4, 8.4, 7.6}}) {
    Summary random = over_machines(8, {row.poses, PoseChoice::random, 8, 12});
    Summary chosen = over_machines(4, {row.poses, PoseChoice::d_optimal, 2, 12});
    // Its random sets of 8 poses reach from 57 to 843 um: their median is known to a factor.
    const double share = row.poses == 8 ? 0.7 : 0.25;
    EXPECT_NEAR(random.bound_um, row.bound, share * row.bound) << row.poses;
    EXPECT_NEAR(random.median_um["ik_residual"], row.plain, share * row.plain) << row.poses;
    EXPECT_NEAR(random.median_um["maximum_likelihood"], row.likelihood, share * row.likelihood) << row.poses;
    EXPECT_NEAR(chosen.bound_um, row.bound_chosen, 0.2 * row.bound_chosen) << row.poses;
    EXPECT_NEAR(chosen.median_um["maximum_likelihood"], row.chosen_likelihood, 0.2 * row.chosen_likelihood)
        << row.poses;
  }
}

// 1920 runs each: 0.01 of noise.
TEST(SlowCalibrationTables, EfficienciesAtTwelveTwentyFourAndFiftyPoses) {
  for (const auto& [poses, plain] : std::map<std::size_t, double>{{12, 0.47}, {24, 0.54}, {50, 0.59}}) {
    Summary found = over_machines(8, {poses, PoseChoice::random, 8, 30});
    EXPECT_EQ(found.runs, 1920);
    EXPECT_GE(found.efficiency["whitened"], 0.95) << poses;
    EXPECT_GE(found.efficiency["maximum_likelihood"], 0.95) << poses;
    EXPECT_NEAR(found.efficiency["ik_residual"], plain, 0.15) << poses;  // depends on the sets
  }
}

}  // namespace
}  // namespace understudy::studies
