#include "sim/sensors/built_mounting.h"

#include <cmath>

#include <gtest/gtest.h>

#include "machine/optics_mounting.h"
#include "sim/sensors/microscope.h"

namespace understudy::sim {
namespace {

TEST(BuiltMounting, IsDrawnFromTheTolerancesOfMounting) {
  const auto machine = machine::load_machine("hexapod");
  const machine::MountingVector sigmas = machine::mounting_sigmas(*machine.tolerances.mounting);
  double squares = 0;
  constexpr int kMachines = 400;
  for (std::uint64_t seed = 1; seed <= kMachines; ++seed)
    squares += draw_mounting(machine, seed).cwiseQuotient(sigmas).squaredNorm();
  EXPECT_NEAR(squares / (kMachines * machine::kMountingFreedoms), 1, 0.085);  // 4 sigma of 4400 squares
  EXPECT_EQ(draw_mounting(machine, 7), draw_mounting(machine, 7));
  EXPECT_NE(draw_mounting(machine, 7), draw_mounting(machine, 8));
}

TEST(BuiltMounting, AMachineThatStatesNoToleranceIsBuiltAsDrawn) {
  auto machine = machine::load_machine("hexapod");
  machine.tolerances.mounting.reset();
  EXPECT_EQ(draw_mounting(machine, 7), machine::MountingVector::Zero());
}

/// What the controller has found out moves no pixel of the twin.
TEST(BuiltMounting, ACalibratedDescriptionIsBuiltAsDrawn) {
  const auto machine = machine::load_machine("hexapod");
  machine::MachineDescription calibrated = machine;
  const machine::OpticsMounting drawn = machine::mounting_of(machine);
  calibrated.gap_sensor = {drawn, "", "", 1, machine::MountingMatrix::Zero()};
  machine::set_mounting(machine::moved(drawn, draw_mounting(machine, 11)), calibrated.laser,
                        calibrated.microscope);
  const Pose X_WT = make_pose(Quat::Identity(), Vec3(0, 0, 0.5e-3));
  const Region region{300, 100, 200, 150};
  const auto picture = [&](const machine::MachineDescription& built) {
    return Microscope(built, nullptr, 1).expose(X_WT, region, 3).pixels;
  };
  EXPECT_EQ(picture(machine), picture(machine::with_drawn_optics(calibrated)));
  EXPECT_NE(picture(machine), picture(calibrated));
}

}  // namespace
}  // namespace understudy::sim
