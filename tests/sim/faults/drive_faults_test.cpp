// What each fault makes of the commands that pass, and which events are refused.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/faults/faults.h"
#include "tests/sim/faults/still_plant.h"

namespace understudy::sim {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// The hexapod's screws: 1/16 inch a turn of 200 full steps.
constexpr double kFullStep = 1.5875e-3 / 200;  // [m]
constexpr double kPeriod = 1e-3;               // [s], between commands
// Sums of a few positions of millimetres.
constexpr double kRounding = 1e-17;

class DriveFaults : public testing::Test {
 protected:
  /// What the drive of axis 1 is told when the controller asks for `asked`, one position a period.
  std::vector<double> told(const std::vector<FaultEvent>& events, const std::vector<double>& asked) {
    FaultyDrives drives(machine_, events);
    std::vector<double> positions;
    for (std::size_t k = 0; k < asked.size(); ++k) {
      DriveCommand command;
      command.position.fill(asked[k]);
      command.velocity.fill(1.0);
      drives.apply(kPeriod * static_cast<double>(k), command, plant_);
      EXPECT_EQ(command.position[1], asked[k]) << "another axis is touched";
      positions.push_back(command.position[0]);
      velocities_.push_back(command.velocity[0]);
    }
    return positions;
  }
  static std::vector<double> ramp(double speed, int count) {
    std::vector<double> positions;
    for (int k = 0; k < count; ++k) positions.push_back(0.02 + speed * kPeriod * k);
    return positions;
  }

  const machine::MachineDescription machine_ = machine::load_machine("hexapod");
  StillPlant plant_;
  std::vector<double> velocities_;
};

TEST_F(DriveFaults, NothingHappensBeforeItsTime) {
  const auto asked = ramp(0.01, 500);
  EXPECT_EQ(told({{FaultKind::lost_steps, 0, 1.0, 4}, {FaultKind::stall, 0, 2.0, 0, 1.0}}, asked), asked);
  EXPECT_EQ(plant_.changes, 0);
}

TEST_F(DriveFaults, LostStepsSlipByExactlyThatManyWhicheverWayTheAxisMoves) {
  for (const double speed : {0.01, -0.01})
    for (const int steps : {4, 8, 40}) {
      const auto asked = ramp(speed, 500);
      const auto done = told({{FaultKind::lost_steps, 0, 0.1, steps}}, asked);
      EXPECT_EQ(done[99], asked[99]);
      // 10 mm/s passes 40 full steps, 0.3175 mm, in 32 ms: over by then.
      for (std::size_t k = 200; k < asked.size(); ++k)
        ASSERT_NEAR(asked[k] - done[k], std::copysign(steps * kFullStep, speed), kRounding) << k;
    }
}

TEST_F(DriveFaults, ARotorThatSlipsNeitherJumpsNorRunsBack) {
  const auto asked = ramp(0.01, 500);
  const auto done = told({{FaultKind::lost_steps, 0, 0.1, 8}}, asked);
  for (std::size_t k = 1; k < done.size(); ++k) {
    ASSERT_GE(done[k], done[k - 1] - kRounding) << k;
    ASSERT_LE(done[k] - done[k - 1], 0.01 * kPeriod + kRounding) << k;
  }
}

TEST_F(DriveFaults, StepsAreLostOnTheMoveNotAtRest) {
  std::vector<double> asked(300, 0.02);
  for (std::size_t k = 200; k < 300; ++k) asked[k] = 0.02 + 1e-5 * static_cast<double>(k - 200);
  const auto done = told({{FaultKind::lost_steps, 0, 0.05, 4}}, asked);
  for (std::size_t k = 0; k < 200; ++k) ASSERT_EQ(done[k], asked[k]);
  EXPECT_NEAR(asked[299] - done[299], 4 * kFullStep, kRounding);
}

TEST_F(DriveFaults, StepsLostTwiceAddUp) {
  const auto asked = ramp(0.01, 500);
  const FaultEvent once{FaultKind::lost_steps, 0, 0.1, 4}, later{FaultKind::lost_steps, 0, 0.3, 8};
  EXPECT_NEAR(asked[499] - told({once, later}, asked)[499], 12 * kFullStep, kRounding);
  // Also when the second comes before the first is over: 4 steps take 3.2 ms.
  FaultEvent soon = later;
  soon.time = 0.101;
  EXPECT_NEAR(asked[499] - told({once, soon}, asked)[499], 12 * kFullStep, kRounding);
}

TEST_F(DriveFaults, AStalledRotorStandsStillAndCatchesTheNearestCycle) {
  const auto asked = ramp(0.01, 600);
  const double cycle = 4 * kFullStep;
  for (const double stalled_for : {0.0331, 0.1, 0.25}) {
    const auto done = told({{FaultKind::stall, 0, 0.1, 0, stalled_for}}, asked);
    const auto end = static_cast<std::size_t>(std::ceil((0.1 + stalled_for) / kPeriod - 1e-9));
    for (std::size_t k = 100; k < end; ++k) ASSERT_EQ(done[k], asked[100]);
    const double slip = asked[end] - done[end];
    EXPECT_NEAR(slip / cycle, std::round(slip / cycle), 1e-9);       // whole cycles
    EXPECT_LE(std::abs(done[end] - asked[100]), cycle / 2 + 1e-12);  // the nearest one
    EXPECT_NEAR(asked[599] - done[599], slip, kRounding);
  }
}

TEST_F(DriveFaults, AStallHasNoSpeed) {
  told({{FaultKind::stall, 0, 0.1, 0, 0.1}}, ramp(0.01, 300));
  EXPECT_EQ(velocities_[99], 1.0);
  EXPECT_EQ(velocities_[150], 0.0);
  EXPECT_EQ(velocities_[250], 1.0);
}

TEST_F(DriveFaults, StallsThatOverlapEndTogetherWithTheLast) {
  const auto asked = ramp(0.01, 500);
  const auto done = told({{FaultKind::stall, 0, 0.1, 0, 0.1}, {FaultKind::stall, 0, 0.15, 0, 0.15}}, asked);
  for (std::size_t k = 100; k < 300; ++k) ASSERT_EQ(done[k], asked[100]);
  EXPECT_NE(done[310], asked[100]);
}

TEST_F(DriveFaults, GrowthIsARampThatStays) {
  FaultyDrives drives(machine_, {{FaultKind::thermal_growth, 2, 0.1, 0, 0.4, 30e-6}});
  DriveCommand command;
  const auto growth_at = [&](double time) {
    drives.apply(time, command, plant_);
    return plant_.conditions[2].growth;
  };
  EXPECT_EQ(growth_at(0.05), 0);
  EXPECT_NEAR(growth_at(0.2), 7.5e-6, 1e-18);
  EXPECT_NEAR(growth_at(0.4), 22.5e-6, 1e-18);
  EXPECT_NEAR(growth_at(0.5), 30e-6, 1e-18);
  EXPECT_NEAR(growth_at(5.0), 30e-6, 1e-18);
  EXPECT_EQ(command.position[2], 0);  // the drive is asked for the same
  EXPECT_FALSE(drives.counts_only(2));
}

TEST_F(DriveFaults, TwoGrowthsOfAnAxisAddUp) {
  FaultyDrives drives(machine_, {{FaultKind::thermal_growth, 0, 0.0, 0, 1.0, 10e-6},
                                 {FaultKind::thermal_growth, 0, 0.5, 0, 1.0, -4e-6}});
  DriveCommand command;
  for (int k = 0; k <= 75; ++k) drives.apply(0.01 * k, command, plant_);
  EXPECT_NEAR(plant_.conditions[0].growth, 7.5e-6 - 1e-6, 1e-18);
  for (int k = 76; k <= 200; ++k) drives.apply(0.01 * k, command, plant_);
  EXPECT_NEAR(plant_.conditions[0].growth, 6e-6, 1e-18);
}

TEST_F(DriveFaults, AGrowthWithoutDurationIsAStep) {
  FaultyDrives drives(machine_, {{FaultKind::thermal_growth, 0, 0.1, 0, 0, 10e-6}});
  DriveCommand command;
  drives.apply(0.1, command, plant_);
  EXPECT_NEAR(plant_.conditions[0].growth, 10e-6, 1e-20);
}

TEST_F(DriveFaults, ALooseJointAddsPlayAndADisconnectedMotorLetsGo) {
  FaultyDrives drives(machine_, {{FaultKind::loose_joint, 3, 0.1, 0, 0, 50e-6},
                                 {FaultKind::loose_joint, 3, 0.2, 0, 0, 20e-6},
                                 {FaultKind::disconnected, 4, 0.2}});
  DriveCommand command;
  drives.apply(0.1, command, plant_);
  EXPECT_EQ(plant_.conditions[3].play_added, 50e-6);
  EXPECT_FALSE(plant_.conditions[4].released);
  drives.apply(0.2, command, plant_);
  EXPECT_NEAR(plant_.conditions[3].play_added, 70e-6, 1e-19);
  EXPECT_TRUE(plant_.conditions[4].released);
  EXPECT_TRUE(drives.counts_only(4));
  EXPECT_FALSE(drives.counts_only(3));
  EXPECT_FALSE(drives.power_is_cut());
}

TEST_F(DriveFaults, APowerCutReleasesEveryMotorOfTheMachineAndNoOther) {
  FaultyDrives drives(machine_, {{FaultKind::power_cut, 0, 0.1}});
  DriveCommand command;
  drives.apply(0.05, command, plant_);
  EXPECT_FALSE(drives.power_is_cut());
  drives.apply(0.1, command, plant_);
  EXPECT_TRUE(drives.power_is_cut());
  for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(plant_.conditions[i].released) << i;
  for (std::size_t i = 6; i < kinematics::kMaxAxes; ++i) EXPECT_FALSE(plant_.conditions[i].released) << i;
}

TEST_F(DriveFaults, EventsThatTheMachineCannotHaveAreRefused) {
  const auto refused = [&](const FaultEvent& event, const std::string& why) {
    EXPECT_THAT([&] { check_faults({event}, machine_); }, ThrowsMessage<InputError>(HasSubstr(why)));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused({FaultKind::stall, 6, 0, 0, 1}, "fault stall of axis 7: the machine has 6");
  refused({FaultKind::stall, -1, 0, 0, 1}, "the machine has 6");
  refused({FaultKind::stall, 0, -0.5, 0, 1}, "at -0.5 s, before 0");
  refused({FaultKind::stall, 0, nan, 0, 1}, "before 0");
  refused({FaultKind::stall, 0, 0, 0, -1}, "for -1 s, below 0");
  refused({FaultKind::lost_steps, 0, 0, 6}, "6 steps, not a positive multiple of 4");
  refused({FaultKind::lost_steps, 0, 0, 0}, "0 steps");
  refused({FaultKind::lost_steps, 0, 0, -4}, "-4 steps");
  refused({FaultKind::loose_joint, 0, 0, 0, 0, 0}, "play of 0 is not above 0");
  refused({FaultKind::loose_joint, 0, 0, 0, 0, nan}, "not above 0");
  refused({FaultKind::thermal_growth, 0, 0, 0, 1, nan}, "not finite");
  auto stiff = machine_;
  stiff.hexapod().play = {};
  EXPECT_THAT(
      [&] {
        check_faults({{FaultKind::loose_joint, 2, 0, 0, 0, 1e-5}}, stiff);
      },
      ThrowsMessage<InputError>(HasSubstr("axis 3: the machine has no play there to grow")));
  EXPECT_NO_THROW(check_faults({{FaultKind::power_cut, 99, 0}}, machine_));  // it has no axis
}

TEST_F(DriveFaults, AreToldWithAxisTimeAndAmount) {
  EXPECT_EQ(describe({FaultKind::stall, 2, 2.5, 0, 0.4}, machine_),
            "stall of axis l3 at 2.500 s for 0.400 s");
  EXPECT_EQ(describe({FaultKind::lost_steps, 0, 1, 8}, machine_), "8 lost steps of axis l1 at 1.000 s");
  EXPECT_EQ(describe({FaultKind::thermal_growth, 5, 0, 0, 60, 30e-6}, machine_),
            "growth of axis l6 at 0.000 s by 30.0 um over 60.0 s");
  EXPECT_EQ(describe({FaultKind::loose_joint, 1, 0, 0, 0, from_deg(0.1)}, machine::load_machine("arm")),
            "loose joint of axis j2 at 0.000 s, 6.00 arcmin more play");
  EXPECT_EQ(describe({FaultKind::power_cut, 0, 3}, machine_), "power cut at 3.000 s");
}

}  // namespace
}  // namespace understudy::sim
