// A calibration changes what the controller knows, not the machine that stands there.
#include <gtest/gtest.h>

#include "core/units.h"
#include "sim/as_built/as_built.h"
#include "sim/as_built/as_built_file.h"

namespace understudy::sim {
namespace {

/// As load_machine() leaves a calibrated hexapod.
machine::MachineDescription calibrated() {
  auto machine = machine::load_machine("hexapod");
  for (auto& b : machine.hexapod().geometry.base_joint) b += Vec3(1e-3, -2e-3, 0.5e-3);
  machine.calibration.emplace();
  return machine;
}

std::string parameters(const AsBuilt& built) {
  AsBuilt anonymous = built;
  anonymous.source.clear();
  return write_as_built(anonymous);
}

TEST(CalibratedTwin, TheBuiltMachineIsTheSameWhateverTheControllerKnows) {
  const auto drawn = machine::load_machine("hexapod");
  for (const char* set : {"nominal", "sampled", "manufactured"})
    for (const std::uint64_t seed : {1u, 2u, 3u})
      EXPECT_EQ(parameters(make_as_built(calibrated(), set, seed)),
                parameters(make_as_built(drawn, set, seed)))
          << set;
}

TEST(CalibratedTwin, ABuiltChainIsTheSameWhateverTheControllerKnows) {
  const auto drawn = machine::load_machine("arm");
  auto machine = drawn;
  machine.chain().kinematics.design = machine.chain().kinematics.chain;
  machine.chain().kinematics.chain.axes[1].point += Vec3(2e-3, 0, 0);
  machine.calibration.emplace();
  for (const char* set : {"nominal", "sampled", "manufactured"})
    EXPECT_EQ(parameters(make_as_built(machine, set, 7)), parameters(make_as_built(drawn, set, 7))) << set;
}

TEST(CalibratedTwin, AsDescribedItHasTheCalibratedGeometry) {
  const auto machine = calibrated();
  const AsBuilt described = as_described(machine);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i)
    EXPECT_EQ(described.hexapod.base_joint[i], machine.hexapod().geometry.base_joint[i]);
}

}  // namespace
}  // namespace understudy::sim
