#include "rehearsal/compensation/predicted_play.h"

#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/plant/plant.h"

namespace understudy::rehearsal {
namespace {

TEST(PlayAlongPath, IsLinearBetweenItsPlacesAndKeepsJumpsSharp) {
  PlayAlongPath play;
  Twist none = Twist::Zero(), some = Twist::Zero();
  some[0] = 50e-6;
  for (int k = 0; k <= 10; ++k) play.add({0, 0.1 * k}, k <= 5 ? none : some);
  EXPECT_EQ(play.at(0, 0.45)[0], 0);
  EXPECT_NEAR(play.at(0, 0.55)[0], 25e-6, 1e-12);
  EXPECT_EQ(play.at(0, 0.65)[0], 50e-6);
  EXPECT_EQ(play.at(3, 0)[0], 50e-6) << "behind the last place it stays";
}

TEST(KnownMachine, HasThePlayThatTheCalibrationFound) {
  const auto machine = machine::load_machine("hexapod");
  machine::CalibratedParameters parameters;
  parameters.play.emplace().fill(30e-6);
  const sim::AsBuilt built = known_machine(machine, parameters, PlayReference::middle);
  for (std::size_t i = 0; i < built.nut_play.size(); ++i)
    EXPECT_NEAR(built.nut_play[i] + built.ball_play[i], 30e-6, 1e-12);
}

TEST(KnownMachine, CountedFromRestHomeIsWhereTheDescriptionHasIt) {
  const auto machine = machine::load_machine("hexapod");
  const sim::AsBuilt built = known_machine(machine, {}, PlayReference::rest);
  const auto plant = sim::make_quasistatic_plant(machine, built);
  kinematics::AxisVector home{};
  ASSERT_EQ(machine.make_mechanism()->inverse(machine.X_BT_home, {}, home), kinematics::SolveStatus::ok);
  for (std::size_t i = 0; i < home.size(); ++i) home[i] -= machine.drive_zero()[i];
  plant->reset(home);
  const Pose X_WT_home = machine.X_WB * machine.X_BT_home;
  // Without the sides in the zeros it hangs some 40 um below.
  EXPECT_LT((plant->tool_pose().translation() - X_WT_home.translation()).norm(), 1e-9);
}

}  // namespace
}  // namespace understudy::rehearsal
