#include "calibration/machine/strut_sides.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::calibration {
namespace {

machine::MachineDescription hexapod() { return machine::load_machine("hexapod"); }

/// Sum of the forces [N] along z that the struts put on the platform: their loads by the slopes of their
/// lengths.
double lift(const machine::MachineDescription& machine, const StrutLengths& load, const Pose& X_BT) {
  Mat6 J;
  EXPECT_EQ(kinematics::jacobian(machine.hexapod().geometry, X_BT, J), kinematics::SolveStatus::ok);
  double force = 0;
  for (std::size_t i = 0; i < kStruts; ++i) force += load[i] * J(static_cast<Eigen::Index>(i), 2);
  return force;
}

// Without motors the struts carry what hangs on them, and at home all alike.
TEST(StrutSides, LoadsCarryThePlatformAndItsNuts) {
  auto machine = hexapod();
  machine.hexapod().masses.motor = 0;
  const auto& masses = machine.hexapod().masses;
  Pose X_BT = machine.X_BT_home;
  StrutLengths load;
  ASSERT_TRUE(strut_loads(machine, machine.hexapod().geometry, X_BT, load));
  for (std::size_t i = 0; i < kStruts; ++i) {
    EXPECT_LT(load[i], 0);
    EXPECT_NEAR(load[i], load[0], 1e-9);
  }
  const double weight = kGravity * (masses.platform + 6 * masses.nut);
  EXPECT_NEAR(lift(machine, load, X_BT), weight, 1e-9);
  X_BT.translation() += Vec3(20e-3, -10e-3, 5e-3);
  ASSERT_TRUE(strut_loads(machine, machine.hexapod().geometry, X_BT, load));
  EXPECT_NEAR(lift(machine, load, X_BT), weight, 1e-9);
}

TEST(StrutSides, APulledStrutRestsAsIfItHadShortened) {
  const auto machine = hexapod();
  for (const Approach side : resting_sides(machine, machine.hexapod().geometry, {}, machine.X_BT_home))
    EXPECT_EQ(side, Approach::shortening);
}

// Turned over, the platform stands on its struts.
TEST(StrutSides, AMachineThatStandsPushes) {
  auto machine = hexapod();
  machine.X_WB = machine.X_WB * make_pose(exp_rotation(Vec3(std::numbers::pi, 0, 0)), Vec3(0, 0, 0));
  for (const Approach side : resting_sides(machine, machine.hexapod().geometry, {}, machine.X_BT_home))
    EXPECT_EQ(side, Approach::lengthening);
}

TEST(StrutSides, FrictionAboveTheLoadLeavesTheSideUnknown) {
  auto machine = hexapod();
  machine.hexapod().play.friction = 10;
  for (const Approach side : resting_sides(machine, machine.hexapod().geometry, {}, machine.X_BT_home))
    EXPECT_EQ(side, Approach::unknown);
}

}  // namespace
}  // namespace understudy::calibration
