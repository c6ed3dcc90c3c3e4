#include "machine/pose_array.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/random_vector.h"
#include "core/units.h"

namespace understudy::machine {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;

/// Poses about home as rows, and as the poses that a single call takes.
struct Rows {
  std::vector<double> numbers;
  std::vector<Pose> X_WT;
};

Rows rows_about_home(const MachineDescription& machine, std::size_t count) {
  Random random(1, "pose array");
  Rows rows;
  for (std::size_t n = 0; n < count; ++n) {
    Vec3 turn = uniform_vec3(random, 0.2);
    const Vec3 way = uniform_vec3(random, 0.04);
    if (machine.mechanism == "delta") turn.setZero();  // its rods keep it upright
    const Pose X = machine.X_WB * machine.X_BT_home * make_pose(exp_rotation(turn), way);
    rows.numbers.resize(kPoseNumbers * (n + 1));
    kinematics::write_pose(X, &rows.numbers[kPoseNumbers * n]);
    rows.X_WT.push_back(X);
  }
  return rows;
}

class PoseArray : public testing::TestWithParam<std::string> {};

TEST_P(PoseArray, RowsAreSolvedAsSingleCallsSolveThem) {
  const MachineDescription machine = load_machine(GetParam());
  const auto mechanism = machine.make_mechanism();
  const auto count = static_cast<std::size_t>(mechanism->axis_count());
  const Rows rows = rows_about_home(machine, 300);
  std::vector<double> axes(count * 300), back(kPoseNumbers * 300);
  std::vector<std::uint8_t> status(300), again(300);
  axes_of_poses(machine, rows.numbers, axes, status, 1);
  poses_of_axes(machine, axes, back, again, 1);
  int solved = 0;
  for (std::size_t n = 0; n < 300; ++n) {
    AxisVector expected{};
    const SolveStatus one =
        mechanism->inverse(machine.X_WB.inverse() * rows.X_WT[n], {}, std::span(expected).first(count));
    ASSERT_EQ(status[n], static_cast<std::uint8_t>(one)) << n;
    if (one != SolveStatus::ok) continue;
    ++solved;
    // The row's quaternion is the pose's rotation to rounding; near a branch an arm turns that into some
    // 1e-12 rad.
    for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(axes[count * n + i], expected[i], 1e-11) << n;
    if (again[n] != 0) continue;
    // Newton's steps end 1e-12 m from the lengths.
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(back[kPoseNumbers * n + k], rows.numbers[kPoseNumbers * n + k], 1e-9) << n;
  }
  EXPECT_GT(solved, 200);
}
INSTANTIATE_TEST_SUITE_P(Machines, PoseArray, testing::Values("hexapod", "arm", "five-axis", "delta"),
                         [](const auto& made) {
                           return made.param == "five-axis" ? "fiveaxis" : made.param;
                         });

TEST(PoseArray, TheNumberOfThreadsChangesNoBit) {
  const MachineDescription machine = load_machine("hexapod");
  const Rows rows = rows_about_home(machine, 40001);
  std::vector<double> one(6 * 40001), three(6 * 40001);
  std::vector<std::uint8_t> status(40001);
  axes_of_poses(machine, rows.numbers, one, status, 1);
  axes_of_poses(machine, rows.numbers, three, status, 3);
  EXPECT_EQ(one, three);
}

TEST(PoseArray, ARowThatIsNoPoseIsNaNAndBadInput) {
  const MachineDescription machine = load_machine("hexapod");
  Rows rows = rows_about_home(machine, 4);
  rows.numbers[kPoseNumbers * 1 + 3] *= 1.001;  // a quaternion of another length
  rows.numbers[kPoseNumbers * 2 + 3] = std::numeric_limits<double>::quiet_NaN();
  rows.numbers[kPoseNumbers * 3] = std::numeric_limits<double>::infinity();
  std::vector<double> axes(24, 1.0);
  std::vector<std::uint8_t> status(4);
  axes_of_poses(machine, rows.numbers, axes, status);
  EXPECT_EQ(status[0], static_cast<std::uint8_t>(SolveStatus::ok));
  for (std::size_t n : {1u, 2u, 3u}) {
    EXPECT_NE(status[n], static_cast<std::uint8_t>(SolveStatus::ok));
    for (std::size_t i = 0; i < 6; ++i) EXPECT_TRUE(std::isnan(axes[6 * n + i]));
  }
  EXPECT_EQ(status[1], static_cast<std::uint8_t>(SolveStatus::bad_input));
  EXPECT_EQ(status[2], static_cast<std::uint8_t>(SolveStatus::bad_input));
}

}  // namespace
}  // namespace understudy::machine
