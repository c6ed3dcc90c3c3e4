#include "rehearsal/replay.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "core/units.h"
#include "rehearsal/scene.h"

namespace understudy::rehearsal {
namespace {

using Carrier = ReplayBody::Carrier;

std::map<Carrier, int> counts(const Replay& replay) {
  std::map<Carrier, int> by_carrier;
  for (const ReplayBody& body : replay.bodies) ++by_carrier[body.carrier];
  return by_carrier;
}

/// Home, moved and tilted a little from instant to instant.
std::vector<Moment> wobble(const machine::MachineDescription& machine, const sim::AsBuilt& as_built,
                           int count) {
  std::vector<Moment> moments;
  const Pose home = machine.X_WB * machine.X_BT_home;
  const auto mechanism = machine.make_mechanism();
  for (int i = 0; i < count; ++i) {
    Moment moment{0.1 * i, {home, {}}};
    Pose& X_WT = moment.configuration.X_WT;
    X_WT.translation() += Vec3(1e-3 * std::sin(i), 1e-3 * std::cos(i), 0.2e-3 * i);
    X_WT.linear() =
        Eigen::AngleAxisd(0.02 * std::sin(2 * i), Vec3::UnitY()).toRotationMatrix() * X_WT.linear();
    const auto solved = mechanism->inverse(machine.X_WB.inverse() * X_WT, {}, moment.configuration.axes);
    EXPECT_EQ(solved, kinematics::SolveStatus::ok) << i;
    moments.push_back(moment);
  }
  static_cast<void>(as_built);
  return moments;
}

TEST(Replay, AHexapodIsToolSixStrutsAndAFrameThatStands) {
  const auto machine = machine::load_machine("hexapod");
  const auto as_built = sim::as_described(machine);
  const auto moments = wobble(machine, as_built, 12);
  const Replay replay = make_replay(machine, as_built, moments);
  EXPECT_EQ(replay.key_times.size(), 12u);
  EXPECT_EQ(counts(replay)[Carrier::strut], 6);
  EXPECT_EQ(counts(replay)[Carrier::tool], static_cast<int>(machine.tool.bodies.size()));
  EXPECT_EQ(counts(replay)[Carrier::world], 12) << "six joints and the six rods between them";
  EXPECT_EQ(counts(replay)[Carrier::axes], 0);
  EXPECT_TRUE(replay.X_WO.empty());
}

// Each body, put together again as docs/report-data.md says, is where machine_scene() poses it.
TEST(Replay, PutTogetherAgainEveryBodyIsWhereItWas) {
  for (const char* name : {"hexapod", "arm", "five-axis"}) {
    const auto machine = machine::load_machine(name);
    const auto as_built = sim::as_described(machine);
    const auto moments = wobble(machine, as_built, 9);
    const Replay replay = make_replay(machine, as_built, moments);
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const auto& configuration = moments[k].configuration;
      const Scene scene = machine_scene(machine, as_built, configuration);
      ASSERT_EQ(scene.bodies.size(), replay.bodies.size()) << name;
      for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const ReplayBody& body = replay.bodies[b];
        const Pose& truth = scene.bodies[b].X_FS;
        if (body.carrier == Carrier::strut) {
          const Vec3 middle = 0.5 * (body.from_W + configuration.X_WT * body.to_T);
          EXPECT_LT((middle - truth.translation()).norm(), 1e-6) << name << " " << body.shape.name;
          continue;
        }
        const Pose X_WF = body.carrier == Carrier::axes   ? body.X_WF[k]
                          : body.carrier == Carrier::tool ? Pose(configuration.X_WT * body.shape.X_FS)
                                                          : body.shape.X_FS;
        EXPECT_LT((X_WF.matrix() - truth.matrix()).cwiseAbs().maxCoeff(), 1e-6)
            << name << " " << body.shape.name;
      }
    }
  }
}

// The head of this machine only slides, whatever its table does: in the machine's frame it never turns.
TEST(Replay, WhereAxesMoveTheTableTheMachineStandsInItsOwnFrame) {
  const auto machine = machine::load_machine("five-axis");
  const auto as_built = sim::as_described(machine);
  const auto moments = wobble(machine, as_built, 9);
  const Replay replay = make_replay(machine, as_built, moments);
  ASSERT_EQ(replay.X_WO.size(), 9u);
  const auto R_OT = [&](std::size_t k) {
    return Eigen::Matrix3d(replay.X_WO[k].linear().transpose() * moments[k].configuration.X_WT.linear());
  };
  double turned_W = 0;
  for (std::size_t k = 1; k < 9; ++k) {
    EXPECT_LT(angle_between(R_OT(0), R_OT(k)), 1e-6) << k;
    turned_W = std::max(turned_W, angle_between(replay.X_WO[0].linear(), replay.X_WO[k].linear()));
  }
  EXPECT_GT(turned_W, 0.01);
}

TEST(Replay, KeysAreThinnedAndHoldTheLastInstant) {
  const auto machine = machine::load_machine("hexapod");
  const auto as_built = sim::as_described(machine);
  const auto moments = wobble(machine, as_built, 25);
  const Replay replay = make_replay(machine, as_built, moments, 10);
  EXPECT_EQ(replay.key_times.size(), 10u);
  EXPECT_EQ(replay.key_times.front(), 0);
  EXPECT_EQ(replay.key_times.back(), moments.back().time);
  EXPECT_TRUE(make_replay(machine, as_built, {}).bodies.empty());
}

}  // namespace
}  // namespace understudy::rehearsal
