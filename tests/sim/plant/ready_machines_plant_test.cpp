// Every chain of models/ that prints, in each engine that plays it: the same motion ends at the same tip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/plant/plant.h"

namespace understudy::sim {
namespace {

constexpr double kDuration = 1.0;  // [s]
constexpr double kRest = 0.2;      // [s]

/// Every axis goes from home to a place of its own, by 4 mm or degrees at most and within its range, and
/// rests.
struct Motion {
  explicit Motion(const machine::MachineDescription& machine) : home(machine.chain().kinematics.home) {
    const auto& axes = machine.chain().kinematics.chain.axes;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double most = (axes[i].angle ? from_deg(4) : 4e-3) * (1 - 0.1 * static_cast<double>(i));
      way[i] = std::min(most, 0.5 * (axes[i].upper - home[i]));
      if (way[i] < 0.1 * most) way[i] = std::max(-most, 0.5 * (axes[i].lower - home[i]));
    }
  }
  DriveCommand at(double t) const {
    const double w = std::numbers::pi / kDuration, u = std::min(t, kDuration);
    DriveCommand command;
    for (std::size_t i = 0; i < way.size(); ++i) {
      command.position[i] = home[i] + way[i] * (1 - std::cos(w * u)) / 2;
      command.velocity[i] = way[i] * w * std::sin(w * u) / 2;
    }
    return command;
  }
  kinematics::AxisVector home, way{};
};

Pose end_of(Plant& plant, const Motion& motion) {
  plant.reset(motion.home);
  const int steps = static_cast<int>(std::lround((kDuration + kRest) / plant.timestep()));
  for (int k = 0; k < steps; ++k) plant.step(motion.at(k * plant.timestep()));
  return plant.tool_pose();
}

struct Played {
  const char* machine;
  bool bullet;  ///< and not only mujoco
};

class ReadyMachinesPlant : public testing::TestWithParam<Played> {
 protected:
  const machine::MachineDescription machine_ = machine::load_machine(GetParam().machine);
  const AsBuilt built_ = make_as_built(machine_, "sampled", 5);
  const Motion motion_{machine_};

  // At rest engines differ by how far MuJoCo's constraints give, by a play that carries next to nothing,
  // which one engine leaves where friction holds it, and by rounding: well below the 10 um that are promised
  // of motion.
  void expect_same_end(Plant& peer) const {
    const auto plant = make_quasistatic_plant(machine_, built_);
    const Pose expected = end_of(*plant, motion_), found = end_of(peer, motion_);
    EXPECT_GT((expected.translation() - (machine_.X_WB * machine_.X_BT_home).translation()).norm(), 1e-3);
    EXPECT_LE((found.translation() - expected.translation()).norm(), 10e-6);
    EXPECT_LE(angle_between(found.linear(), expected.linear()), from_deg(0.005));
  }
};

TEST_P(ReadyMachinesPlant, EndsInMujocoWhereItEndsInQuasistatic) {
  expect_same_end(*make_mujoco_plant(machine_, built_));
}

TEST_P(ReadyMachinesPlant, EndsInBulletWhereItEndsInQuasistaticOrIsRefused) {
  if (GetParam().bullet) return expect_same_end(*make_bullet_plant(machine_, built_));
  try {
    static_cast<void>(make_bullet_plant(machine_, built_));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::EndsWith("use mujoco or quasistatic"));
  }
}

INSTANTIATE_TEST_SUITE_P(Models, ReadyMachinesPlant,
                         testing::Values(Played{"trunnion-ac", false}, Played{"trunnion-bc", false},
                                         Played{"head-table", false}, Played{"head-head", true},
                                         Played{"open5x", false}, Played{"tilted-nozzle", true},
                                         Played{"corexy", false}, Played{"delta", false},
                                         Played{"arm-positioner", false}, Played{"arm-rail", true}),
                         [](const auto& one) {
                           std::string name = one.param.machine;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace understudy::sim
