#include "sim/sensors/built_mounting.h"

#include <cmath>

#include <gtest/gtest.h>

#include "machine/optics_mounting.h"

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
  MicroscopeOptions options;
  build_mounting(machine::MountingVector::Zero(), options);
  EXPECT_TRUE(options.X_LL_built.isApprox(Pose::Identity(), 0));
  EXPECT_TRUE(options.X_CC_built.isApprox(Pose::Identity(), 0));
  EXPECT_EQ(options.scale_built, 1);
}

TEST(BuiltMounting, TheDotIsWhereTheMovedMountingHasIt) {
  const auto machine = machine::load_machine("hexapod");
  const machine::MountingVector error = draw_mounting(machine, 11);
  MicroscopeOptions options{.speckle = false, .noise = false};
  build_mounting(error, options);
  const Microscope built(machine, nullptr, 1, options);
  machine::MachineDescription moved = machine;
  machine::set_mounting(machine::moved(machine::mounting_of(machine), error), moved.laser, moved.microscope);
  const Microscope described(moved, nullptr, 1, {.speckle = false, .noise = false});
  const Pose X_WT = make_pose(Quat::Identity(), Vec3(0, 0, 0.5e-3));
  EXPECT_LT((*built.true_dot(X_WT) - *described.true_dot(X_WT)).norm(), 1e-9);
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
  Microscope before(machine, nullptr, 1), after(calibrated, nullptr, 1);
  const Region region{300, 100, 200, 150};
  EXPECT_EQ(before.expose(X_WT, region, 3).pixels, after.expose(X_WT, region, 3).pixels);
}

}  // namespace
}  // namespace understudy::sim
