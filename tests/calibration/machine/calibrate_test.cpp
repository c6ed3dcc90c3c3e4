// From a table of measured poses to a machine whose controller knows itself better.
#include "calibration/machine/calibrate.h"

#include <cmath>
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "calibration/bound.h"
#include "calibration/machine/calibrate_poses.h"
#include "calibration/machine/calibrate_tip.h"
#include "calibration/pose_choice.h"
#include "core/error.h"
#include "core/output_file.h"
#include "core/units.h"
#include "machine/calibration_section.h"
#include "report/chart/calibrate_charts.h"
#include "sim/as_built/as_built.h"

namespace understudy::rehearsal {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class Calibrate : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(::testing::TempDir()) / (std::string("calibrate.") + test->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A manufactured twin of `machine`, measured; the table's path.
  std::string table(const std::string& machine, std::uint64_t seed, int count,
                    const std::function<void(Measurements&)>& edit = {}) const {
    SamplePosesRequest request;
    request.machine = machine;
    request.count = count;
    request.design = "random";
    request.as_built = "manufactured";
    request.seed = seed;
    const auto description = machine::load_machine(machine);
    Measurements sample = sample_poses(request, description);
    if (edit) edit(sample);
    const fs::path path = folder_ / "poses.csv";
    write_file(path, measurements_csv(sample, description, "test"));
    return path.string();
  }

  CalibrateResult calibrated(const std::string& machine, std::uint64_t seed, int count) const {
    CalibrateRequest request;
    request.machine = machine;
    request.measurements = table(machine, seed, count);
    return calibrate(request);
  }

  fs::path folder_;
};

/// Distances [m] between asked and true tip of a manufactured twin whose controller knows `known`, at poses
/// that were not measured.
std::vector<double> open_loop_errors(const machine::MachineDescription& known, std::uint64_t seed) {
  const auto built = sim::make_as_built(known, "manufactured", seed);
  const auto mechanism = known.make_mechanism();
  Random random(99, "held-out poses");
  std::vector<double> errors;
  for (const Pose& X : calibration::random_reachable_poses(
           *mechanism, calibration::reference_region(known.X_BT_home), 60, random)) {
    std::vector<double> axes(6);
    EXPECT_EQ(mechanism->inverse(X, {}, axes), kinematics::SolveStatus::ok);
    Vec3 tip;
    if (known.chain) {
      for (std::size_t i = 0; i < 6; ++i) axes[i] += built.axis_zero[i];
      tip = kinematics::forward(built.chain, axes).translation();
    } else {
      kinematics::StrutLengths lengths{};
      for (std::size_t i = 0; i < 6; ++i)
        lengths[i] = axes[i] - known.hexapod().geometry.length_offset[i] + built.hexapod.length_offset[i];
      tip = kinematics::forward(built.hexapod, lengths, X).X_BT.translation();
    }
    errors.push_back((tip - X.translation()).norm());
  }
  return errors;
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST_F(Calibrate, LowersTheOpenLoopTipErrorOfTheSameTwin) {
  const auto drawn = machine::load_machine("hexapod");
  const CalibrateResult result = calibrated("hexapod", 5, 24);
  const fs::path path = folder_ / "calibrated.yaml";
  machine::write_calibrated(result.machine, path);
  const auto known = machine::load_machine(path.string());
  const double before = rms(open_loop_errors(drawn, 5)), after = rms(open_loop_errors(known, 5));
  // The tolerances of manufacture: 1 to 3 mm for most machines; the project's goal after it: 0.1 mm.
  EXPECT_GT(before, 0.8e-3);
  EXPECT_LT(after, 0.1e-3);
  // The report's "before" is that error, as the new model tells it, over other poses of the same region.
  EXPECT_NEAR(result.tip.moved_median, before, 0.35 * before);
}

TEST_F(Calibrate, TheUncertaintyItStatesIsTheErrorThatIsLeft) {
  double squares = 0, stated = 0;
  constexpr int kMachines = 20;
  for (int seed = 1; seed <= kMachines; ++seed) {
    const CalibrateResult result = calibrated("hexapod", static_cast<std::uint64_t>(seed), 16);
    const double error = rms(open_loop_errors(result.machine, static_cast<std::uint64_t>(seed)));
    squares += error * error;
    stated += result.tip.rms * result.tip.rms;
  }
  // Errors of one machine's poses go together, about 10 of them independent: 1 sigma of the ratio of mean
  // squares is sqrt(2 / 200) = 0.1.
  EXPECT_NEAR(squares / stated, 1, 0.3);
}

TEST_F(Calibrate, TheMeasuringFramesShareIsInTheUncertainty) {
  CalibrateRequest request;
  request.measurements = table("hexapod", 5, 24);
  const TipMap plain = calibrate(request).tip;
  request.measurements = table("hexapod", 5, 24, [](Measurements& m) { m.frame = {30e-6, 0, 0}; });
  const CalibrateResult shifted = calibrate(request);
  EXPECT_NEAR(std::pow(shifted.tip.rms, 2) - std::pow(plain.rms, 2), 3 * 900e-12, 1e-16);
  EXPECT_THAT(calibration_text(shifted), HasSubstr("of which the measuring frame"));
  EXPECT_EQ(nlohmann::json::parse(calibration_json(shifted)).at("frame").at("position_um"), 30);
  // A turn acts twice squared at a distance from the middle: the reference cube's corners are 87 mm away.
  request.measurements = table("hexapod", 5, 24, [](Measurements& m) { m.frame = {0, 1e-3, 0}; });
  const TipMap turned = calibrate(request).tip;
  const double more = std::pow(turned.worst, 2) - std::pow(plain.worst, 2);
  EXPECT_GT(more, 2 * std::pow(50e-6, 2));
  EXPECT_LT(more, 2 * std::pow(100e-6, 2));
}

class SlowCalibrate : public Calibrate {};

/// From pictures: what is common to all poses is most of the error, and no residual shows it.
TEST_F(SlowCalibrate, TheUncertaintyFromPixelsIsTheErrorThatIsLeft) {
  double squares = 0, stated = 0;
  constexpr int kStands = 6;
  const auto drawn = machine::load_machine("hexapod");
  for (int seed = 1; seed <= kStands; ++seed) {
    SamplePosesRequest sample;
    sample.as_built = "manufactured";
    sample.from_pixels = true;
    sample.seed = static_cast<std::uint64_t>(seed);
    write_file(folder_ / "poses.csv", measurements_csv(sample_poses(sample, drawn), drawn, "test"));
    CalibrateRequest request;
    request.measurements = (folder_ / "poses.csv").string();
    const CalibrateResult result = calibrate(request);
    const double error = rms(open_loop_errors(result.machine, sample.seed));
    std::printf("stand %d: error %.1f um, stated %.1f um, chi-square %.1f of %d\n", seed, to_um(error),
                to_um(result.tip.rms), result.chi_square, result.degrees_of_freedom);
    squares += error * error;
    stated += result.tip.rms * result.tip.rms;
  }
  // About seven independent errors a stand: 1 sigma of the ratio is sqrt(2 / 42) = 0.22; three of them.
  EXPECT_NEAR(squares / stated, 1, 0.66);
}

TEST_F(Calibrate, AnArmLearnsItsAxesAndTool) {
  const auto drawn = machine::load_machine("arm");
  const CalibrateResult result = calibrated("arm", 3, 40);
  EXPECT_EQ(result.parameters.size(), 30u) << "4 x 6 + 6 (Everett 1987)";
  EXPECT_EQ(result.redundant.size(), 12u);
  const double before = rms(open_loop_errors(drawn, 3)), after = rms(open_loop_errors(result.machine, 3));
  EXPECT_GT(before, 4 * after);
  // Poses held out lie in the 100 mm cube that the report's own poses fill.
  EXPECT_LT(after, 3 * result.tip.rms);
}

TEST_F(Calibrate, ZerosMovedIntoTheAxesLeaveThePosesWhereTheyWere) {
  calibration::ChainParameters machine{machine::load_machine("arm").chain().kinematics.chain, {}};
  machine.zero = {0.02, -0.03, 0.05, 0.01, -0.02, 0.04};
  const kinematics::Chain chain = zeros_absorbed(machine);
  Random random(1, "zeros");
  for (int k = 0; k < 20; ++k) {
    std::vector<double> q;
    for (int i = 0; i < 6; ++i) q.push_back(random.uniform(-1, 1));
    EXPECT_TRUE(kinematics::forward(chain, q).isApprox(calibration::forward(machine, q), 1e-13));  // rounding
  }
}

TEST_F(Calibrate, WarnsWhereTheStatedNoiseDoesNotExplainTheResiduals) {
  CalibrateRequest request;
  request.measurements = table("hexapod", 5, 24);
  EXPECT_TRUE(calibrate(request).warnings.empty()) << calibrate(request).warnings.front();
  request.measurements = table("hexapod", 5, 24, [](Measurements& m) {
    for (MeasuredPose& pose : m.poses) pose.covariance /= 9;
  });
  const CalibrateResult result = calibrate(request);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(result.warnings.front(), HasSubstr("the noise is understated"));
  // What cameras err alike in all poses is in their covariance, and in no residual.
  request.measurements = table("hexapod", 5, 24, [](Measurements& m) {
    for (MeasuredPose& pose : m.poses) pose.covariance *= 9;
  });
  const CalibrateResult loose = calibrate(request);
  ASSERT_EQ(loose.warnings.size(), 1u);
  EXPECT_THAT(loose.warnings.front(), HasSubstr("the same in all poses"));
}

TEST_F(Calibrate, RejectsAWrongPoseAndSaysWhichLineItWas) {
  CalibrateRequest request;
  request.estimator = "robust";
  request.measurements =
      table("hexapod", 5, 24, [](Measurements& m) { m.poses[10].X_WT.translation() += Vec3(2e-3, 0, 0); });
  const CalibrateResult result = calibrate(request);
  EXPECT_FALSE(result.poses[10].used);
  EXPECT_THAT(calibration_text(result), HasSubstr("rejected as outliers: line 13"));
  EXPECT_LT(rms(open_loop_errors(result.machine, 5)), 0.1e-3);
}

// The same table without the wrong row says what the arm should be.
TEST_F(Calibrate, AnArmRejectsAWrongPoseAndSaysWhichLineItWas) {
  CalibrateRequest request;
  request.machine = "arm";
  request.estimator = "robust";
  request.measurements =
      table("arm", 3, 24, [](Measurements& m) { m.poses[10].X_WT.translation() += Vec3(2e-3, 0, 0); });
  const CalibrateResult result = calibrate(request);
  for (std::size_t j = 0; j < result.poses.size(); ++j) EXPECT_EQ(result.poses[j].used, j != 10) << j;
  EXPECT_THAT(result.warnings, Contains(HasSubstr("rejected as outliers: poses 11")));
  EXPECT_THAT(calibration_text(result), HasSubstr("rejected as outliers: line 13"));
  EXPECT_EQ(result.degrees_of_freedom, 6 * 23 - 30);
  EXPECT_EQ(result.machine.calibration->estimator, "robust");

  request.estimator = "";
  request.measurements = table("arm", 3, 24, [](Measurements& m) { m.poses.erase(m.poses.begin() + 10); });
  const CalibrateResult clean = calibrate(request);
  EXPECT_NEAR(result.chi_square, clean.chi_square, 1e-3);  // written to 1e-6 mm and 1e-9 of a quaternion
  EXPECT_NEAR(result.tip.rms, clean.tip.rms, 1e-3 * clean.tip.rms);
}

TEST_F(Calibrate, ACalibratedMachineCanBeCalibratedAgain) {
  const fs::path path = folder_ / "once.yaml";
  machine::write_calibrated(calibrated("hexapod", 5, 12).machine, path);
  const double once = rms(open_loop_errors(machine::load_machine(path.string()), 5));
  // Commands now come from the first calibration; the twin is the same.
  const CalibrateResult again = calibrated(path.string(), 5, 100);
  const double twice = rms(open_loop_errors(again.machine, 5));
  // docs/reference.md#calibration-figures: about 35 um with 12 random poses, 9 um with 100.
  EXPECT_LT(twice, once);
  EXPECT_LT(twice, 20e-6);
}

TEST_F(Calibrate, SummaryAndPageHaveWhatTheTextSays) {
  const CalibrateResult result = calibrated("hexapod", 5, 24);
  const auto summary = nlohmann::json::parse(calibration_json(result));
  EXPECT_EQ(summary["schema"], "understudy.calibration/1");
  EXPECT_EQ(summary["parameters"].size(), 42u);
  EXPECT_EQ(summary["samples"].size(), 24u);
  EXPECT_NEAR(summary["tip"]["sigma_median_um"].get<double>(), to_um(result.tip.median), 1e-3);
  EXPECT_LT(summary["residual"]["tip_rms_after_um"], summary["residual"]["tip_rms_before_um"]);
  const std::string page = calibration_html(result);
  EXPECT_THAT(page, AllOf(HasSubstr("base joint 6 z"), HasSubstr("Parameters are correlated")));
  for (const char* outside : {"http://", "https://", ">nan", ">inf"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  EXPECT_EQ(calibration_html(calibrated("hexapod", 5, 24)), page);
}

TEST(CalibrateCharts, NormalQuantilesAreThoseOfTheTables) {
  // Abramowitz and Stegun, table 26.5.
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-9);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963985, 1e-8);
  EXPECT_NEAR(normal_quantile(0.001), -3.090232306, 1e-8);
}

}  // namespace
}  // namespace understudy::rehearsal
