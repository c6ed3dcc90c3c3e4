#include "control/registration/registration_tolerance.h"

#include <cmath>

#include <gtest/gtest.h>

namespace understudy::control {
namespace {

std::vector<ProbingPlace> two_places(double apart) {
  std::vector<ProbingPlace> places(2);
  places[0].p_W = {0, 0, 0.1};
  places[1].p_W = {apart, 0, 0.1};
  return places;
}

/// Without play and without a calibration, so that waves alone are left beside repeatability (4 um).
machine::MachineDescription exact_machine() {
  machine::MachineDescription machine = machine::load_machine("hexapod");
  machine.calibration.reset();
  machine.hexapod().play = {};
  return machine;
}

TEST(RegistrationTolerance, AFileThatStatesNoneMeansAPartClampedByHand) {
  const PartTolerance silent = part_tolerance({});
  EXPECT_EQ(silent.position, 0.5e-3);
  EXPECT_EQ(silent.rotation, 5e-3);
  machine::BuiltTolerances stated;
  stated.part_position = 0.1e-3;
  stated.part_rotation = 1e-3;
  stated.part_size = 2e-3;
  EXPECT_EQ(part_tolerance(stated).position, 0.1e-3);
  EXPECT_EQ(part_tolerance(stated).rotation, 1e-3);
  EXPECT_EQ(part_tolerance(stated).size, 2e-3);
}

TEST(RegistrationTolerance, WavesDifferBetweenPlacesAsFarAsTheirLength) {
  machine::BuiltTolerances stated;
  stated.part_ripple = 14.142136e-6;  // an amplitude: 10 um RMS
  const auto machine = exact_machine();
  EXPECT_NEAR(place_sigma(stated, machine, two_places(0)), 4e-6, 1e-12);
  // Half of their distance is the spread: 10 mm of a wave's 20.
  EXPECT_NEAR(place_sigma(stated, machine, two_places(20e-3)), std::hypot(4e-6, 5e-6), 1e-11);
  EXPECT_NEAR(place_sigma(stated, machine, two_places(80e-3)), std::hypot(4e-6, 10e-6), 1e-11);
}

TEST(RegistrationTolerance, PlayAndTheCalibratedTipCountByTheSpreadOfThePlaces) {
  auto machine = exact_machine();
  machine::CalibrationRecord calibrated;
  calibrated.tip_sigma = 17.320508e-6;  // 10 um along one direction
  machine.calibration = calibrated;
  EXPECT_NEAR(place_sigma({}, machine, two_places(100e-3)), std::hypot(4e-6, 5e-6), 1e-11);
  EXPECT_NEAR(place_sigma({}, machine, two_places(1)), std::hypot(4e-6, 10e-6), 1e-11);
  const auto with_play = machine::load_machine("hexapod");
  ASSERT_GT(with_play.tip_play(), 0);
  EXPECT_NEAR(place_sigma({}, with_play, two_places(80e-3)), std::hypot(4e-6, 0.25 * with_play.tip_play()),
              1e-11);
  EXPECT_NEAR(place_sigma({}, with_play, two_places(1)), std::hypot(4e-6, 0.25 * with_play.tip_play()),
              1e-11);
  EXPECT_NEAR(place_sigma({}, with_play, two_places(40e-3)), std::hypot(4e-6, 0.0625 * with_play.tip_play()),
              1e-11);
}

}  // namespace
}  // namespace understudy::control
