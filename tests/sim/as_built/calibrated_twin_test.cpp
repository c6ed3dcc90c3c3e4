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

TEST(CalibratedTwin, AManufacturedMachineIsTheSameWhateverTheControllerKnows) {
  const auto drawn = machine::load_machine("hexapod");
  for (const std::uint64_t seed : {1, 2, 3})
    EXPECT_EQ(parameters(make_as_built(calibrated(), "manufactured", seed)),
              parameters(make_as_built(drawn, "manufactured", seed)));
}

TEST(CalibratedTwin, SampledIsWhatIsLeftAboutTheCalibratedGeometry) {
  const auto machine = calibrated();
  const AsBuilt nominal = make_as_built(machine, "nominal", 1),
                sampled = make_as_built(machine, "sampled", 1);
  const double tolerance = machine.tolerances.after_calibration.joint_position;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    EXPECT_EQ(nominal.hexapod.base_joint[i], machine.hexapod().geometry.base_joint[i]);
    // 6 sigma of each coordinate; the calibration moved the joints by 57 sigma.
    EXPECT_LT(
        (sampled.hexapod.base_joint[i] - machine.hexapod().geometry.base_joint[i]).cwiseAbs().maxCoeff(),
        6 * tolerance);
  }
}

TEST(CalibratedTwin, AChainIsManufacturedAboutItsDrawing) {
  const auto drawn = machine::load_machine("arm");
  auto machine = drawn;
  machine.chain().kinematics.design = machine.chain().kinematics.chain;
  machine.chain().kinematics.chain.axes[1].point += Vec3(2e-3, 0, 0);
  machine.calibration.emplace();
  EXPECT_EQ(parameters(make_as_built(machine, "manufactured", 7)),
            parameters(make_as_built(drawn, "manufactured", 7)));
  EXPECT_NE(parameters(make_as_built(machine, "sampled", 7)), parameters(make_as_built(drawn, "sampled", 7)));
}

}  // namespace
}  // namespace understudy::sim
