// The section `gap_sensor`: what the controller then knows of laser and microscope, and what is refused.
#include "machine/file/gap_sensor_section.h"

#include <cmath>

#include "core/file/read_file.h"
#include "core/random.h"
#include "machine/file/section_text.h"
#include "machine/optics_mounting.h"
#include "tests/machine/edited_file.h"

namespace understudy::machine {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr double kDigits = 1e-11;  // the file has twelve decimals of a quaternion, nine of a millimetre

/// The shipped hexapod as a calibration may have found it.
MachineDescription calibrated() {
  MachineDescription m = load_machine("hexapod");
  Random random(3, "gap sensor section test");
  MountingVector error;
  MountingMatrix mixed;
  for (int i = 0; i < kMountingFreedoms; ++i) {
    error[i] = 1e-4 * random.normal();
    for (int j = 0; j < kMountingFreedoms; ++j) mixed(i, j) = 1e-4 * random.normal();
  }
  const OpticsMounting drawn = mounting_of(m);
  m.gap_sensor = {drawn, "gaps \"3\".csv",          std::string(64, '0'),
                  12,    mixed * mixed.transpose(), MeasuredWaist{m.laser.waist_diameter, 1.5e-6}};
  m.laser.waist_diameter = 0.13e-3;
  set_mounting(moved(drawn, error), m.laser, m.microscope);
  return m;
}

class GapSensorSection : public EditedFile {
 protected:
  static std::string text() {
    const MachineDescription m = calibrated();
    return with_section(read_file(m.file), gap_sensor_section(m));
  }
  std::string refusal(const std::string& from, const std::string& to) {
    return error_of(edited(text(), "gap_sensor:", from, to));
  }
};

TEST_F(GapSensorSection, GivesTheMountingThatTheControllerUses) {
  const MachineDescription m = calibrated(), drawn = load_machine("hexapod"),
                           read = load_machine(write(text()));
  EXPECT_TRUE(read.laser.X_TL.isApprox(m.laser.X_TL, kDigits));
  EXPECT_TRUE(read.microscope.X_TC.isApprox(m.microscope.X_TC, kDigits));
  EXPECT_NEAR(read.microscope.camera.focal_px, m.microscope.camera.focal_px, 1e-8);
  EXPECT_FALSE(read.laser.X_TL.isApprox(drawn.laser.X_TL, 1e-6));
  ASSERT_TRUE(read.gap_sensor);
  EXPECT_EQ(read.gap_sensor->measurements, "gaps \"3\".csv");
  EXPECT_EQ(read.gap_sensor->pictures, 12);
  EXPECT_TRUE(read.gap_sensor->covariance.isApprox(m.gap_sensor->covariance, 1e-9));
  EXPECT_FALSE(drawn.gap_sensor);
}

TEST_F(GapSensorSection, TheDrawingIsKeptForWhatIsBuilt) {
  const MachineDescription drawn = load_machine("hexapod"), read = load_machine(write(text()));
  EXPECT_TRUE(drawn_mounting(read).X_TL.isApprox(drawn.laser.X_TL, 0));
  EXPECT_TRUE(drawn_mounting(read).X_TC.isApprox(drawn.microscope.X_TC, 0));
  EXPECT_EQ(drawn_mounting(read).focal_px, drawn.microscope.camera.focal_px);
  EXPECT_TRUE(mounting_of(read).X_TL.isApprox(read.laser.X_TL, 0));
}

TEST_F(GapSensorSection, TheMeasuredWaistIsTheControllersAndTheDrawnOneIsKept) {
  const MachineDescription drawn = load_machine("hexapod"), read = load_machine(write(text()));
  EXPECT_NEAR(read.laser.waist_diameter, 0.13e-3, 1e-9);
  ASSERT_TRUE(read.gap_sensor->waist);
  EXPECT_NEAR(read.gap_sensor->waist->sigma, 1.5e-6, 1e-9);
  EXPECT_EQ(drawn_waist(read), drawn.laser.waist_diameter);
  EXPECT_EQ(drawn_waist(drawn), drawn.laser.waist_diameter);
}

TEST_F(GapSensorSection, OfACalibrationThatMeasuredNoWaistTheDrawnOneCounts) {
  MachineDescription m = calibrated();
  m.gap_sensor->waist.reset();
  const MachineDescription read = load_machine(write(with_section(read_file(m.file), gap_sensor_section(m))));
  EXPECT_FALSE(read.gap_sensor->waist);
  EXPECT_EQ(read.laser.waist_diameter, load_machine("hexapod").laser.waist_diameter);
}

TEST_F(GapSensorSection, AWaistNeedsItsSigmaAndIsNearTheDrawnOne) {
  EXPECT_THAT(refusal("  waist_sigma_um: 1.500\n", ""), HasSubstr("gap_sensor.waist_sigma_um"));
  EXPECT_THAT(refusal("waist_diameter_mm: 0.13", "waist_diameter_mm: 0.23"),
              AllOf(HasSubstr("gap_sensor.waist_diameter_mm is 0.23 mm, +53 % off the drawn 0.15 mm"),
                    HasSubstr("more than 50 %"), HasSubstr(kInThatLine)));
}

TEST_F(GapSensorSection, LeavesTheRestOfTheFileAsItIsAndReplacesAnOlderOne) {
  const MachineDescription m = calibrated();
  EXPECT_THAT(text(), StartsWith(read_file(m.file)));
  EXPECT_EQ(with_section(text(), gap_sensor_section(m)), text());
}

TEST_F(GapSensorSection, ACovarianceIsPositiveSemiDefiniteAndWhole) {
  MachineDescription m = calibrated();
  m.gap_sensor->covariance(4, 4) = -m.gap_sensor->covariance(4, 4);
  const auto refused = [&] { return error_of(with_section(read_file(m.file), gap_sensor_section(m))); };
  EXPECT_THAT(refused(), AllOf(HasSubstr("gap_sensor.covariance_mm_rad is not positive semi-definite"),
                               HasSubstr("the variance of number 5 is"),
                               HasSubstr("write it with understudy calibrate gap-sensor")));
  m = calibrated();
  m.gap_sensor->covariance(1, 0) = m.gap_sensor->covariance(0, 1) = 1;
  EXPECT_THAT(refused(), HasSubstr("an eigenvalue of its correlations is -"));
  m.gap_sensor->covariance.setZero();
  EXPECT_EQ(refused(), "accepted");  // known exactly
  EXPECT_THAT(refusal("covariance_mm_rad: [", "covariance_mm_rad: [0, "),
              AllOf(HasSubstr("covariance_mm_rad"), HasSubstr("66"), HasSubstr(kInThatLine)));
}

TEST_F(GapSensorSection, IsRefusedWhereItBelongsToAnotherMachine) {
  EXPECT_THAT(refusal("laser_mm: [", "laser_mm: [9"),
              AllOf(HasSubstr("the laser is"), HasSubstr("more than 5 mm"), HasSubstr(kInThatLine)));
  EXPECT_THAT(refusal("microscope_mm: [", "microscope_mm: [9"), HasSubstr("the microscope is"));
  EXPECT_THAT(
      refusal("focal_px: 2", "focal_px: 3"),
      AllOf(HasSubstr("gap_sensor.focal_px is 3"), HasSubstr("more than 20 %"), HasSubstr(kInThatLine)));
  const std::string section = gap_sensor_section(calibrated());
  const std::string quaternion = section.substr(section.find("laser_quaternion"));
  const std::string whole = quaternion.substr(0, quaternion.find('\n'));
  EXPECT_THAT(refusal(whole, "laser_quaternion: [1, 0, 0, 0]"),
              AllOf(HasSubstr("the laser is turned by"), HasSubstr("more than 9.7 deg")));
  EXPECT_THAT(refusal(whole, "laser_quaternion: [1, 0, 0, 0.1]"), HasSubstr("has length"));
  EXPECT_THAT(refusal("  pictures: 12\n", ""), HasSubstr("gap_sensor.pictures"));
  EXPECT_THAT(refusal("pictures: 12", "picture: 12"), HasSubstr("did you mean"));
}

TEST_F(GapSensorSection, AMachineWithoutAMicroscopeHasNone) {
  const MachineDescription arm = load_machine("arm");
  ASSERT_FALSE(arm.has_microscope);
  EXPECT_THAT(error_of(with_section(read_file(arm.file), gap_sensor_section(calibrated()))),
              HasSubstr("a machine without laser and microscope has no gap sensor"));
}

TEST_F(GapSensorSection, TolerancesOfMountingAreOptional) {
  const auto mounting = load_machine("hexapod").tolerances.mounting;
  ASSERT_TRUE(mounting);
  EXPECT_DOUBLE_EQ(mounting->position, 0.1e-3);
  EXPECT_DOUBLE_EQ(mounting->angle, 2e-3);
  EXPECT_DOUBLE_EQ(mounting->scale, 5e-3);
  const std::string original = read_file(load_machine("hexapod").file);
  EXPECT_THAT(error_of(edited(original, "  mounting:", "angle_mrad: 2", "angle_mrad: 200")),
              AllOf(HasSubstr("tolerances.mounting.angle_mrad"), HasSubstr("100"), HasSubstr(kInThatLine)));
}

}  // namespace
}  // namespace understudy::machine
