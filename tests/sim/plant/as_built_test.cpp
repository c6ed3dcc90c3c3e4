#include "sim/as_built/as_built.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "tests/sim/plant/machine_g4.h"

namespace understudy::sim {
namespace {

constexpr int kMachines = 400;

/// The 42 errors of a machine [m]: b, a and l_0 of every strut.
std::vector<double> errors(const machine::MachineDescription& machine, const AsBuilt& built) {
  std::vector<double> all;
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      all.push_back(built.hexapod.base_joint[i][axis] - machine.hexapod().geometry.base_joint[i][axis]);
      all.push_back(built.hexapod.platform_joint[i][axis] -
                    machine.hexapod().geometry.platform_joint[i][axis]);
    }
    all.push_back(built.hexapod.length_offset[i] - machine.hexapod().geometry.length_offset[i]);
  }
  return all;
}

TEST(AsBuilt, NominalIsTheDescription) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "nominal", 5);
  for (const double error : errors(machine, built)) EXPECT_EQ(error, 0);
  EXPECT_EQ(built.hexapod.deviation, machine.hexapod().geometry.deviation);
  for (std::size_t i = 0; i < kinematics::kStruts; ++i) {
    EXPECT_EQ(built.nut_play[i], machine.hexapod().play.screw_nut);
    EXPECT_EQ(built.ball_play[i], machine.hexapod().play.ball_joint);
  }
}

TEST(AsBuilt, EqualSeedsGiveEqualMachinesAndOthersDoNot) {
  const auto machine = machine_g4();
  for (const char* set : {"sampled", "manufactured"}) {
    const auto first = errors(machine, make_as_built(machine, set, 7));
    EXPECT_EQ(first, errors(machine, make_as_built(machine, set, 7)));
    EXPECT_NE(first, errors(machine, make_as_built(machine, set, 8)));
  }
}

TEST(AsBuilt, EveryParameterHasItsOwnError) {
  const auto machine = machine_g4();
  auto all = errors(machine, make_as_built(machine, "sampled", 1));
  ASSERT_EQ(all.size(), 42U);
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
  EXPECT_EQ(std::count(all.begin(), all.end(), 0.0), 0);
}

TEST(AsBuilt, ErrorsSpreadAsTheToleranceSetStates) {
  auto machine = machine_g4();
  machine.tolerances.after_calibration = {from_mm(0.1), from_mm(0.07)};
  machine.tolerances.manufactured = {from_mm(0.5), from_mm(0.3)};
  for (const auto& [set, tolerance] : {std::pair{"sampled", machine.tolerances.after_calibration},
                                       std::pair{"manufactured", machine.tolerances.manufactured}}) {
    double joint_sum = 0, joint_square = 0, offset_square = 0;
    for (std::uint64_t seed = 1; seed <= kMachines; ++seed) {
      const auto all = errors(machine, make_as_built(machine, set, seed));
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (k % 7 == 6) {
          offset_square += all[k] * all[k];
        } else {
          joint_sum += all[k];
          joint_square += all[k] * all[k];
        }
      }
    }
    // The standard error of a standard deviation over n draws is sigma / sqrt(2 n); four of them.
    const double joints = 36.0 * kMachines, offsets = 6.0 * kMachines;
    const double joint_sigma = tolerance.joint_position, offset_sigma = tolerance.length_offset;
    EXPECT_NEAR(std::sqrt(joint_square / joints), joint_sigma, 4 * joint_sigma / std::sqrt(2 * joints))
        << set;
    EXPECT_NEAR(joint_sum / joints, 0, 4 * joint_sigma / std::sqrt(joints)) << set;
    EXPECT_NEAR(std::sqrt(offset_square / offsets), offset_sigma, 4 * offset_sigma / std::sqrt(2 * offsets))
        << set;
  }
}

TEST(AsBuilt, AnotherWordIsAnErrorThatListsTheWords) {
  try {
    make_as_built(machine_g4(), "sample", 1);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(testing::HasSubstr("sample"), testing::HasSubstr("nominal"),
                               testing::HasSubstr("sampled"), testing::HasSubstr("manufactured")));
  }
}

}  // namespace
}  // namespace understudy::sim
