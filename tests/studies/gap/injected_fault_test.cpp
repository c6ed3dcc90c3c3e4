#include "studies/gap/injected_fault.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "kinematics/hexapod/hexapod.h"
#include "tests/shipped_hexapod.h"

namespace understudy::studies {
namespace {

FaultWindow window() {
  const Pose X_WT =
      hexapod().X_WB * hexapod().X_BT_home * make_pose(exp_rotation(Vec3(0.2, 0.1, 0)), Vec3::Zero());
  return {2, 5, X_WT};
}

/// How far an axis moves the tip along its own axis, by the inverse Jacobian of the struts.
double effect(int axis) {
  Mat6 J;
  EXPECT_EQ(kinematics::jacobian(hexapod().hexapod().geometry, hexapod().X_WB.inverse() * window().X_WT_S, J),
            kinematics::SolveStatus::ok);
  const Eigen::Matrix<double, 6, 1> twist = J.inverse().col(axis);
  return twist.head<3>().dot(tool_axis(Pose(hexapod().X_WB.inverse() * window().X_WT_S)));
}

TEST(InjectedFault, AllThatIsDrawnCanHappenAndStrikesInItsWindow) {
  for (const FaultType& type : fault_types()) {
    std::set<double> shares;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Random random(seed, type.name);
      const InjectedFault fault = draw_fault(type, window(), hexapod(), random);
      EXPECT_NO_THROW(sim::check_camera_faults(fault.camera)) << fault.words;
      EXPECT_NO_THROW(sim::check_faults(fault.machine, hexapod())) << fault.words;
      EXPECT_EQ(fault.camera.size(), type.camera ? 1u : 0u);
      EXPECT_EQ(fault.machine.size(), type.machine ? 1u : 0u);
      EXPECT_GE(fault.time, 2);
      EXPECT_LE(fault.time, 5);
      for (const auto& event : fault.camera) shares.insert(event.share);
    }
    if (type.camera) {
      // Half in every frame: of 200 draws 100, 1 sigma 7.
      EXPECT_NEAR(static_cast<double>(shares.size()), 101, 28) << type.name;
    }
  }
}

// Else no controller could keep the nozzle off the part, and a touch would prove nothing.
TEST(InjectedFault, NoneOfTheMachineMovesTheNozzleByMoreThanHalfOfTheAim) {
  const double step = hexapod().drives[0].lead / hexapod().drives[0].steps_per_turn;
  double farthest = 0;
  for (const FaultType& type : fault_types()) {
    if (!type.machine) continue;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
      Random random(seed, type.name);
      const sim::FaultEvent event = draw_fault(type, window(), hexapod(), random).machine.front();
      const double travel =
          event.kind == sim::FaultKind::lost_steps ? event.steps * step : std::abs(event.amount);
      const double moved = std::abs(effect(event.axis)) * travel;
      // A rotor slips by one electrical cycle at least, 32 um of a strut.
      EXPECT_LE(moved, std::max(kMachineJump, 4 * step) + 1e-9) << type.name << ' ' << seed;
      farthest = std::max(farthest, moved);
    }
  }
  EXPECT_GT(farthest, 0.9 * kMachineJump) << "the draw is toothless";
}

TEST(InjectedFault, EqualStreamsDrawEqualFaults) {
  for (const FaultType& type : fault_types()) {
    Random one(3, type.name), other(3, type.name);
    EXPECT_EQ(draw_fault(type, window(), hexapod(), one).words,
              draw_fault(type, window(), hexapod(), other).words);
  }
}

}  // namespace
}  // namespace understudy::studies
