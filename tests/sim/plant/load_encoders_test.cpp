#include "sim/plant/load_encoders.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr machine::LoadEncoderCounts kCounts{1e-6, 1e-5};  // [m], [rad]

// The lengths are those of the machine as built, not of the drawing.
TEST(LoadEncoders, OfStrutsReadTheBuiltLengthsInWholeCounts) {
  const auto machine = machine::load_machine("hexapod");
  const AsBuilt built = make_as_built(machine, "manufactured", TruthSeeds(7));
  const LoadEncoders encoders(machine, built, kCounts);
  ASSERT_TRUE(encoders.present());
  Pose X_BT = machine.X_BT_home;
  X_BT.translation() += Vec3(4e-3, -7e-3, 3e-3);
  kinematics::AxisVector read{};
  ASSERT_TRUE(encoders.read(machine.X_WB * X_BT, {}, read));
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    // Song 2015, equation 4: the screw's axis passes the base joint at the distance dev.
    const double apart = (X_BT * built.hexapod.platform_joint[i] - built.hexapod.base_joint[i]).norm(),
                 length = std::sqrt(apart * apart - std::pow(built.hexapod.deviation, 2));
    EXPECT_NEAR(read[i], length, 0.51 * kCounts.length) << i;
    EXPECT_NEAR(std::remainder(read[i], kCounts.length), 0, 1e-12) << i;
  }
}

// The pose of known axes of the built chain is read back as these axes.
TEST(LoadEncoders, OfAChainReadTheAxesThatMakeThePose) {
  for (const char* name : {"arm", "five-axis"}) {
    const auto machine = machine::load_machine(name);
    const AsBuilt built = make_as_built(machine, "manufactured", TruthSeeds(3));
    const LoadEncoders encoders(machine, built, kCounts);
    ASSERT_TRUE(encoders.present()) << name;
    const auto mechanism = machine.make_mechanism();
    const int count = mechanism->axis_count();
    std::vector<double> home(static_cast<std::size_t>(count));
    ASSERT_EQ(mechanism->inverse(machine.X_BT_home, {}, home), kinematics::SolveStatus::ok);
    Random random(1, "load encoders");
    kinematics::AxisVector truth{}, near{}, read{};
    for (std::size_t i = 0; i < home.size(); ++i) {
      truth[i] = home[i] + random.uniform(-0.02, 0.02);
      near[i] = truth[i] + 1e-3;  // by the drives: zeros and plays of a bad machine
    }
    kinematics::ChainJacobian columns;
    const Pose X_BT = kinematics::forward(built.chain, std::span(truth).first(home.size()), columns);
    ASSERT_TRUE(encoders.read(machine.X_WB * X_BT, near, read)) << name;
    for (std::size_t i = 0; i < home.size(); ++i)
      EXPECT_NEAR(read[i], truth[i], 0.51 * kCounts.of(built.chain.axes[i].angle) + 1e-9) << name << i;
  }
}

TEST(LoadEncoders, ArePresentOnlyWhereEveryAxisHasOne) {
  const auto machine = machine::load_machine("five-axis");
  const AsBuilt built = as_described(machine);
  EXPECT_FALSE(LoadEncoders(machine, built, {1e-6, 0}).present());
  EXPECT_FALSE(LoadEncoders(machine, built, {0, 1e-5}).present());
  EXPECT_TRUE(LoadEncoders(machine, built, kCounts).present());
}

}  // namespace
}  // namespace understudy::sim
