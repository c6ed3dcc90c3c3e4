// From a table of measured poses to a machine whose controller knows itself better.
#include "calibration/machine/calibrate_machine.h"

#include <cmath>
#include <filesystem>
#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "calibration/machine/estimation_report.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/units.h"
#include "machine/file/calibration_section.h"
#include "tests/calibration/machine/measured_machine.h"
#include "tests/temporary_folder.h"
#include "tests/told_progress.h"

namespace understudy::calibration {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class Calibrate : public ::testing::Test {
 protected:
  /// A built machine, measured by a controller that knows `known`; the table's path.
  std::string table(const machine::MachineDescription& known, std::uint64_t seed, std::size_t count,
                    const std::function<void(Measurements&)>& edit = {}) const {
    Measurements sample = BuiltMachine(machine::load_machine(known.name), seed).measured(known, count);
    if (edit) edit(sample);
    const fs::path path = folder_ / "poses.csv";
    write_file(path, measurements_csv(sample, known, "test"));
    return path.string();
  }
  std::string table(const std::string& machine, std::uint64_t seed, std::size_t count,
                    const std::function<void(Measurements&)>& edit = {}) const {
    return table(machine::load_machine(machine), seed, count, edit);
  }

  MachineCalibration calibrated(const std::string& machine, std::uint64_t seed, std::size_t count) const {
    CalibrationRequest request;
    request.machine = machine;
    request.measurements = table(machine, seed, count);
    return calibrate_machine(request);
  }

  const TemporaryFolder folder_;
};

/// RMS tip error [m] of machine `seed` when its controller knows `known`.
double open_loop_rms(const machine::MachineDescription& known, std::uint64_t seed) {
  return BuiltMachine(machine::load_machine(known.name), seed).open_loop_rms(known);
}

TEST_F(Calibrate, LowersTheOpenLoopTipErrorOfTheSameTwin) {
  const auto drawn = machine::load_machine("hexapod");
  const MachineCalibration result = calibrated("hexapod", 5, 24);
  const fs::path path = folder_ / "calibrated.yaml";
  machine::write_calibrated(result.machine, path);
  const auto known = machine::load_machine(path.string());
  const double before = open_loop_rms(drawn, 5), after = open_loop_rms(known, 5);
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
    const MachineCalibration result = calibrated("hexapod", static_cast<std::uint64_t>(seed), 16);
    const double error = open_loop_rms(result.machine, static_cast<std::uint64_t>(seed));
    squares += error * error;
    stated += result.tip.rms * result.tip.rms;
  }
  // Errors of one machine's poses go together, about 10 of them independent: 1 sigma of the ratio of mean
  // squares is sqrt(2 / 200) = 0.1.
  EXPECT_NEAR(squares / stated, 1, 0.3);
}

TEST_F(Calibrate, TheMeasuringFramesShareIsInTheUncertainty) {
  CalibrationRequest request;
  request.measurements = table("hexapod", 5, 24);
  const TipMap plain = calibrate_machine(request).tip;
  request.measurements = table("hexapod", 5, 24, [](Measurements& m) { m.frame = {30e-6, 0, 0}; });
  const MachineCalibration shifted = calibrate_machine(request);
  EXPECT_NEAR(std::pow(shifted.tip.rms, 2) - std::pow(plain.rms, 2), 3 * 900e-12, 1e-16);
  EXPECT_DOUBLE_EQ(shifted.frame->position, 30e-6);
  // A turn acts twice squared at a distance from the middle: the reference cube's corners are 87 mm away.
  request.measurements = table("hexapod", 5, 24, [](Measurements& m) { m.frame = {0, 1e-3, 0}; });
  const TipMap turned = calibrate_machine(request).tip;
  const double more = std::pow(turned.worst, 2) - std::pow(plain.worst, 2);
  EXPECT_GT(more, 2 * std::pow(50e-6, 2));
  EXPECT_LT(more, 2 * std::pow(100e-6, 2));
}

TEST_F(Calibrate, AnArmLearnsItsAxesAndTool) {
  const auto drawn = machine::load_machine("arm");
  const MachineCalibration result = calibrated("arm", 3, 40);
  EXPECT_EQ(result.parameters.size(), 30u) << "4 x 6 + 6 (Everett 1987)";
  EXPECT_EQ(result.redundant.size(), 12u);
  const double before = open_loop_rms(drawn, 3), after = open_loop_rms(result.machine, 3);
  EXPECT_GT(before, 4 * after);
  // Poses held out lie in the 100 mm cube that the report's own poses fill.
  EXPECT_LT(after, 3 * result.tip.rms);
}

TEST_F(Calibrate, WarnsWhereTheStatedNoiseDoesNotExplainTheResiduals) {
  CalibrationRequest request;
  request.measurements = table("hexapod", 5, 24);
  EXPECT_TRUE(calibrate_machine(request).warnings.empty()) << calibrate_machine(request).warnings.front();
  request.measurements = table("hexapod", 5, 24, [](Measurements& m) {
    for (MeasuredPose& pose : m.poses) pose.covariance /= 9;
  });
  const MachineCalibration result = calibrate_machine(request);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_THAT(result.warnings.front(), HasSubstr("the noise is understated"));
  // What cameras err alike in all poses is in their covariance, and in no residual.
  request.measurements = table("hexapod", 5, 24, [](Measurements& m) {
    for (MeasuredPose& pose : m.poses) pose.covariance *= 9;
  });
  const MachineCalibration loose = calibrate_machine(request);
  ASSERT_EQ(loose.warnings.size(), 1u);
  EXPECT_THAT(loose.warnings.front(), HasSubstr("the same in all poses"));
}

TEST_F(Calibrate, RejectsAWrongPoseAndSaysWhichLineItWas) {
  CalibrationRequest request;
  request.estimator = "robust";
  request.measurements =
      table("hexapod", 5, 24, [](Measurements& m) { m.poses[10].X_WT.translation() += Vec3(2e-3, 0, 0); });
  const MachineCalibration result = calibrate_machine(request);
  EXPECT_FALSE(result.poses[10].used);
  EXPECT_THAT(result.warnings, Contains(HasSubstr("rejected as outliers: line 13")));
  EXPECT_LT(open_loop_rms(result.machine, 5), 0.1e-3);
}

// The same table without the wrong row says what the arm should be.
TEST_F(Calibrate, AnArmRejectsAWrongPoseAndSaysWhichLineItWas) {
  CalibrationRequest request;
  request.machine = "arm";
  request.estimator = "robust";
  request.measurements =
      table("arm", 3, 24, [](Measurements& m) { m.poses[10].X_WT.translation() += Vec3(2e-3, 0, 0); });
  const MachineCalibration result = calibrate_machine(request);
  for (std::size_t j = 0; j < result.poses.size(); ++j) EXPECT_EQ(result.poses[j].used, j != 10) << j;
  EXPECT_THAT(result.warnings, Contains(HasSubstr("rejected as outliers: poses 11")));
  EXPECT_THAT(result.warnings, Contains(HasSubstr("rejected as outliers: line 13")));
  EXPECT_EQ(result.degrees_of_freedom, 6 * 23 - 30);
  EXPECT_EQ(result.machine.calibration->estimator, "robust");

  request.estimator = "";
  request.measurements = table("arm", 3, 24, [](Measurements& m) { m.poses.erase(m.poses.begin() + 10); });
  const MachineCalibration clean = calibrate_machine(request);
  EXPECT_NEAR(result.chi_square, clean.chi_square, 1e-3);  // written to 1e-6 mm and 1e-9 of a quaternion
  EXPECT_NEAR(result.tip.rms, clean.tip.rms, 1e-3 * clean.tip.rms);
}

TEST_F(Calibrate, ACalibratedMachineCanBeCalibratedAgain) {
  const fs::path path = folder_ / "once.yaml";
  machine::write_calibrated(calibrated("hexapod", 5, 12).machine, path);
  const double once = open_loop_rms(machine::load_machine(path.string()), 5);
  // Commands now come from the first calibration; the twin is the same.
  CalibrationRequest request;
  request.machine = path.string();
  request.measurements = table(machine::load_machine(path.string()), 5, 100);
  const MachineCalibration again = calibrate_machine(request);
  const double twice = open_loop_rms(again.machine, 5);
  // docs/reference.md#calibration-figures: about 35 um with 12 random poses, 9 um with 100.
  EXPECT_LT(twice, once);
  EXPECT_LT(twice, 20e-6);
}

TEST_F(Calibrate, APlugInStandsInForAnEstimator) {
  CalibrationRequest request;
  request.measurements = table("hexapod", 5, 24);
  const double ours = open_loop_rms(calibrate_machine(request).machine, 5);
  request.plugin = "python3 " UNDERSTUDY_SOURCE_DIR "/examples/calibration-plugin/strut_by_strut.py";
  const MachineCalibration result = calibrate_machine(request);
  // It weighs all struts alike: docs/reference.md#calibration-figures gives it 0.54 of the likelihood's
  // efficiency at 24 poses.
  EXPECT_LT(open_loop_rms(result.machine, 5), 2 * ours);
  EXPECT_TRUE(std::isnan(result.tip.rms)) << "a plug-in gives no covariance";
  EXPECT_THAT(result.warnings, Contains(HasSubstr("no covariance")));
  EXPECT_THAT(result.estimator, HasSubstr("strut_by_strut"));
  const fs::path path = folder_ / "plugged.yaml";
  machine::write_calibrated(result.machine, path);
  EXPECT_THAT(machine::load_machine(path.string()).calibration->estimator, HasSubstr("strut_by_strut"));
}

TEST_F(Calibrate, APlugInStandsInForAnEstimatorOfAnArm) {
  CalibrationRequest request;
  request.machine = "arm";
  request.measurements = table("arm", 3, 24);
  const MachineCalibration ours = calibrate_machine(request);
  request.plugin = "python3 " UNDERSTUDY_SOURCE_DIR "/examples/calibration-plugin/screw_by_screw.py";
  const MachineCalibration theirs = calibrate_machine(request);
  EXPECT_NEAR(theirs.chi_square, ours.chi_square, 1e-2 * ours.chi_square);
  EXPECT_EQ(theirs.degrees_of_freedom, ours.degrees_of_freedom);
}

TEST_F(Calibrate, APlugInThatGivesNothingIsAnErrorWithItsName) {
  CalibrationRequest request;
  request.measurements = table("hexapod", 5, 12);
  request.plugin = "echo broken >&2; exit 3";
  try {
    calibrate_machine(request);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("plug-in: echo broken"), HasSubstr("status 3"), HasSubstr("\"broken\"")));
  }
  request.estimator = "robust";
  EXPECT_THROW(calibrate_machine(request), InputError);
}

/// Whatever the message says, the place is the line of the pose.
TEST_F(Calibrate, APoseAtFaultIsNamedByItsLine) {
  Estimation found;
  found.status = Status::bad_input;
  found.message = "a message that names no pose";
  found.pose = 1;
  Measurements table;
  table.file = "poses.csv";
  table.poses.resize(3);
  table.poses[1].line = 17;
  try {
    check_found(found, table, "robust");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().line, 17);
    EXPECT_THAT(error.what(), HasSubstr("poses.csv:17"));
  }
}

TEST_F(Calibrate, TellsItsStages) {
  for (const std::string machine : {"hexapod", "arm"}) {
    test::ToldProgress told;
    CalibrationRequest request;
    request.machine = machine;
    request.measurements = table(machine, 4, 24);
    request.progress = told.teller();
    (void)calibrate_machine(request);
    EXPECT_EQ(told.stages(), (std::set<std::string>{"fitting 24 poses", "where the tip goes"})) << machine;
  }
}

}  // namespace
}  // namespace understudy::calibration
