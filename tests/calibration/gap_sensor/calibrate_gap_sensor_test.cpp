#include "calibration/gap_sensor/calibrate_gap_sensor.h"

#include <fmt/format.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "machine/optics_mounting.h"
#include "tests/calibration/gap_sensor/drawn_dots.h"
#include "tests/calibration/gap_sensor/pinhole_sensor.h"

namespace understudy::calibration {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kFirst = 0.1e-3, kStep = 0.2e-3;  // [m]
constexpr int kPictures = 8;

class CalibrateGapSensor : public DotFolder {
 protected:
  CalibrateGapSensor() : machine_(machine::load_machine("hexapod")) {
    error_ << 60e-6, -90e-6, 1e-3, -1.5e-3, 50e-6, 120e-6, -70e-6, 2e-3, -1e-3, 3e-3, 4e-3;
    truth_ = displaced(machine::mounting_of(machine_), machine_.microscope.camera.centre_px, error_);
  }
  static double gap(int i) { return kFirst + kStep * i; }

  /// Heights count from 50 um above the flat.
  std::string shoot() const {
    std::string table = "height_mm,picture,gap_mm,gap_sigma_um\n";
    for (int i = 0; i < kPictures; ++i) {
      const std::string name = fmt::format("{}.pgm", i);
      draw(name, truth_.dot(Vec2::Zero(), gap(i)));
      table += fmt::format("{:.6f},{},{}\n", to_mm(gap(i)) - 0.05, name, i == 0 ? "0.1,1" : ",");
    }
    return write("table.csv", table);
  }
  std::string refusal(const std::string& table) const {
    try {
      calibrate_gap_sensor(table, machine_);
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.find('\n'), std::string::npos);
      return what;
    }
    return "accepted";
  }

  machine::MachineDescription machine_;
  machine::MountingVector error_;
  PinholeSensor truth_;
};

TEST_F(CalibrateGapSensor, PicturesOfAMisplacedSensorGiveOneThatReadsRight) {
  const GapSensorResult result = calibrate_gap_sensor(shoot(), machine_);
  EXPECT_EQ(result.pictures.size(), static_cast<std::size_t>(kPictures));
  ASSERT_TRUE(result.machine.gap_sensor);
  EXPECT_EQ(result.machine.gap_sensor->pictures, kPictures);
  const auto found = sensor_of(machine::mounting_of(result.machine), machine_.microscope.camera.centre_px);
  const auto drawn = sensor_of(machine::mounting_of(machine_), machine_.microscope.camera.centre_px);
  for (const double g : {0.1e-3, 0.13e-3, 0.2e-3, 1e-3}) {
    const Vec2 dot = truth_.dot(Vec2::Zero(), g);
    EXPECT_GT(std::abs(drawn.read(Vec2::Zero(), dot) - g), 50e-6);
    EXPECT_NEAR(found.read(Vec2::Zero(), dot), g,
                2e-6);  // the drawn spots have no speckle, the feeler no error
  }
  EXPECT_TRUE(result.warnings.empty());
}

TEST_F(CalibrateGapSensor, BeginsAtTheDrawingWhateverAnEarlierCalibrationFound) {
  const std::string table = shoot();
  const GapSensorResult once = calibrate_gap_sensor(table, machine_);
  const GapSensorResult again = calibrate_gap_sensor(table, once.machine);
  // The dots are looked for at another scale, by half a per cent: their noise is stated a little otherwise.
  EXPECT_LT((again.fit.error - once.fit.error).cwiseQuotient(once.tolerance).norm(), 0.01);
  EXPECT_TRUE(again.machine.gap_sensor->drawn.X_TC.isApprox(machine_.microscope.X_TC, 1e-12));
}

TEST_F(CalibrateGapSensor, APictureWithoutADotIsLeftOutUntilTooFewRemain) {
  const std::string table = shoot();
  const auto dark = [&](int i) { draw(fmt::format("{}.pgm", i), Vec2(300, 200), 640, 480, 0); };
  dark(3);
  const GapSensorResult result = calibrate_gap_sensor(table, machine_);
  EXPECT_EQ(result.machine.gap_sensor->pictures, kPictures - 1);
  EXPECT_EQ(result.pictures[3].dot.status, vision::DotStatus::no_dot);
  for (const int i : {4, 5, 6}) dark(i);
  EXPECT_THAT(
      refusal(table),
      HasSubstr("table.csv: pictures with a dot (line 5: no dot) at 4 heights over one flat, at least 5"));
}

TEST_F(CalibrateGapSensor, RefusesPicturesOfAnotherCameraAndFilesThatAreNone) {
  const std::string table = shoot();
  draw("2.pgm", Vec2(100, 100), 320, 240);
  EXPECT_THAT(refusal(table),
              HasSubstr("table.csv:4: 2.pgm is 320 x 240 px, the microscope has 640 x 480 px"));
  write("2.pgm", "no picture");
  EXPECT_THAT(refusal(table), AllOf(HasSubstr("2.pgm"), HasSubstr("holds no picture")));
  std::filesystem::remove(folder_ / "2.pgm");
  EXPECT_THAT(refusal(table), HasSubstr("2.pgm"));
}

TEST_F(CalibrateGapSensor, ADotOfAnotherHeightIsNamed) {
  const std::string table = shoot();
  draw("4.pgm", truth_.dot(Vec2::Zero(), gap(4)) + Vec2(5, 3));
  EXPECT_THAT(refusal(table),
              AllOf(HasSubstr("table.csv:6: the dot of 4.pgm is"), HasSubstr("degrees of freedom")));
}

TEST_F(CalibrateGapSensor, KnownGapsThatDisagreeAreRefused) {
  const std::string table = shoot();
  std::ofstream(table, std::ios::app) << "0.05,,0.4,5\n";  // 0.1 by the first row
  EXPECT_THAT(refusal(table), HasSubstr("chi-square"));
}

TEST_F(CalibrateGapSensor, AMountingFarBeyondItsToleranceIsSaid) {
  // Laser and camera share 190 um across the track, some 4.3 tolerances each.
  machine_.tolerances.mounting = {0.02e-3, 0.05e-3, 1e-3};
  error_.setZero();
  error_[0] = 190e-6;
  truth_ = displaced(machine::mounting_of(machine_), machine_.microscope.camera.centre_px, error_);
  const GapSensorResult result = calibrate_gap_sensor(shoot(), machine_);
  ASSERT_FALSE(result.warnings.empty());
  EXPECT_THAT(result.warnings[0], AllOf(HasSubstr("camera offset y is +"), HasSubstr("um off the drawing"),
                                        HasSubstr("times its tolerance")));
}

TEST_F(CalibrateGapSensor, NeedsTolerancesAndAMicroscope) {
  const std::string table = shoot();
  machine_.tolerances.mounting.reset();
  EXPECT_THAT(refusal(table), HasSubstr("machine.yaml: has no tolerances.mounting"));
  machine_ = machine::load_machine("arm");
  EXPECT_THAT(refusal(table), HasSubstr("has no laser and microscope"));
}

}  // namespace
}  // namespace understudy::calibration
