#include <gtest/gtest.h>

#include <cstring>
#include <thread>
#include <vector>

#include "sim/plant/plant.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/motion.h"

namespace understudy::sim {
namespace {

/// Tool poses, drive displacements and forces of a circle with play, as bytes would be compared.
std::vector<double> record(std::uint64_t seed, bool look = true) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "sampled", seed);
  const auto plant = make_mujoco_plant(machine, built, {});
  Circle circle = tilted_circle(machine);
  plant->reset(circle_command(built.hexapod, circle, 0).position);
  std::vector<double> values;
  const int steps = steps_for(*plant, 0.4);
  for (int k = 0; k < steps; ++k) {
    plant->step(circle_command(built.hexapod, circle, k * plant->timestep()));
    if (!look && k + 1 < steps) continue;
    const Pose X_WT = plant->tool_pose();
    values.insert(values.end(), X_WT.data(), X_WT.data() + 16);
    for (const auto& axes : {plant->displacement(), plant->drive_force()})
      values.insert(values.end(), axes.begin(), axes.end());
    values.push_back(plant->closure_error());
  }
  return values;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(MujocoDeterminism, TwoRunsGiveTheSameBits) {
  const auto first = record(1);
  EXPECT_TRUE(same_bits(first, record(1)));
  EXPECT_FALSE(same_bits(first, record(2)));
}

TEST(MujocoDeterminism, TwoThreadsGiveTheBitsOfEachAlone) {
  const auto alone_1 = record(1), alone_2 = record(2);
  std::vector<double> beside_1, beside_2;
  std::thread first([&] { beside_1 = record(1); });
  std::thread second([&] { beside_2 = record(2); });
  first.join();
  second.join();
  EXPECT_TRUE(same_bits(alone_1, beside_1));
  EXPECT_TRUE(same_bits(alone_2, beside_2));
}

TEST(MujocoDeterminism, LookingDoesNotChangeTheRun) {
  const auto watched = record(1, true), unwatched = record(1, false);
  EXPECT_TRUE(
      same_bits({watched.end() - static_cast<std::ptrdiff_t>(unwatched.size()), watched.end()}, unwatched));
}

TEST(MujocoDeterminism, ResetForgetsThePast) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "sampled", 1);
  const auto used = make_mujoco_plant(machine, built, {}), fresh = make_mujoco_plant(machine, built, {});
  const Circle circle = tilted_circle(machine);
  for (auto* plant : {used.get(), fresh.get()})
    plant->reset(circle_command(built.hexapod, circle, 0).position);
  for (int k = 0; k < 200; ++k) used->step(circle_command(built.hexapod, circle, k * used->timestep()));
  used->reset(circle_command(built.hexapod, circle, 0).position);
  EXPECT_TRUE(used->tool_pose().matrix() == fresh->tool_pose().matrix());
  EXPECT_EQ(used->drive_force(), fresh->drive_force());
}

}  // namespace
}  // namespace understudy::sim
