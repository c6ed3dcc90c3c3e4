#include "sim/deposition/bead_temperature.h"

#include <gtest/gtest.h>

#include "tests/sim/deposition/laying.h"

namespace understudy::sim {
namespace {

machine::Material pla() { return machine::load_material("pla"); }

TEST(BeadTemperature, FollowsTheCoolingCurveOfAFreeStrandInTheSameAir) {
  const auto machine = printer();
  const BeadTemperature bead(machine, pla());
  for (const double fan : {0.0, 0.3, 1.0}) {
    Surroundings air;
    air.temperature = machine.process.ambient_temperature;
    air.air_speed = fan * machine.process.fan_air_speed;
    const CoolingCurve strand(pla(), free_strand_diameter(machine), pla().nozzle_temperature, air);
    for (const double age : {0.0, 0.5, 3.0, 60.0})
      EXPECT_NEAR(bead(age, fan), strand.temperature(age), 1e-9) << fan << ' ' << age;
  }
}

TEST(BeadTemperature, TheFanCountsInTenthsAndWithinItsRange) {
  const BeadTemperature bead(printer(), pla());
  EXPECT_EQ(bead(2, 0.52), bead(2, 0.5));
  EXPECT_EQ(bead(2, 1.7), bead(2, 1));
  EXPECT_EQ(bead(2, -0.4), bead(2, 0));
  EXPECT_LT(bead(2, 1), bead(2, 0)) << "moving air cools faster";
}

TEST(BeadTemperature, AFreeStrandIsAFifthWiderThanTheBoreUnlessTheMachineSaysOtherwise) {
  auto machine = printer();
  EXPECT_DOUBLE_EQ(free_strand_diameter(machine), 0.48e-3);
  machine.process.free_strand_diameter = 0.41e-3;
  EXPECT_EQ(free_strand_diameter(machine), 0.41e-3);
}

}  // namespace
}  // namespace understudy::sim
