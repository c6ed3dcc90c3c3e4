#include "machine/pose_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "core/random_vector.h"
#include "core/units.h"

namespace understudy::machine {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;

/// About home, a tenth of them out of reach or no pose at all.
std::vector<Pose> poses_about_home(const MachineDescription& machine, std::size_t count) {
  Random random(1, "pose table");
  std::vector<Pose> poses;
  for (std::size_t n = 0; n < count; ++n) {
    const Vec3 turn = uniform_vec3(random, 0.3);
    const double far = n % 20 == 3 ? 5.0 : 0.05;  // [m]
    const Vec3 way = uniform_vec3(random, far);
    Pose X = machine.X_BT_home * make_pose(exp_rotation(turn), way);
    if (n % 20 == 7) X.linear()(1, 2) = std::numeric_limits<double>::quiet_NaN();
    poses.push_back(X);
  }
  return poses;
}

class PoseTable : public testing::TestWithParam<std::string> {};

// The single call is the reference, to the bit: what a table prints does not depend on its length.
TEST_P(PoseTable, RowsAreThoseOfSingleCalls) {
  const MachineDescription machine = load_machine(GetParam());
  const auto mechanism = machine.make_mechanism();
  const std::vector<Pose> poses = poses_about_home(machine, 203);
  const std::vector<SolvedAxes> solved = solve_axes(machine, poses);
  ASSERT_EQ(solved.size(), poses.size());
  std::vector<AxisVector> axes;
  int ok = 0;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    AxisVector expected{};
    ASSERT_EQ(solved[n].status, mechanism->inverse(poses[n], {}, expected)) << n;
    if (solved[n].status != SolveStatus::ok) continue;
    EXPECT_EQ(solved[n].axes, expected) << n;
    axes.push_back(expected);
    ++ok;
  }
  EXPECT_GT(ok, 100);
  const std::vector<SolvedPose> back = solve_poses(machine, axes);
  ASSERT_EQ(back.size(), axes.size());
  for (std::size_t n = 0; n < axes.size(); ++n) {
    Pose expected;
    if (mechanism->forward(axes[n], mechanism->home(), expected) != SolveStatus::ok) continue;
    ASSERT_EQ(back[n].status, SolveStatus::ok) << n;
    EXPECT_EQ(back[n].X_BT.matrix(), expected.matrix()) << n;
  }
}

INSTANTIATE_TEST_SUITE_P(EveryShape, PoseTable,
                         testing::Values("hexapod", "arm", "five-axis", "finishing", "offset-wrist-arm"),
                         [](const auto& name) {
                           std::string word = name.param;
                           std::erase(word, '-');
                           return word;
                         });

TEST(PoseTableOfAHexapod, ScrewsThatTurnAreTakenIntoAccount) {
  MachineDescription machine = load_machine("hexapod");
  machine.hexapod().screw_rotation = ScrewRotation::compensated;
  const std::vector<Pose> poses{machine.X_BT_home * make_pose(exp_rotation({0, 0, 0.2}), Vec3(0.01, 0, 0))};
  const std::vector<SolvedAxes> solved = solve_axes(machine, poses);
  AxisVector expected{};
  ASSERT_EQ(machine.make_mechanism()->inverse(poses[0], {}, expected), SolveStatus::ok);
  EXPECT_EQ(solved[0].axes, expected);
  const std::vector<AxisVector> axes{expected};
  const std::vector<SolvedPose> back = solve_poses(machine, axes);
  ASSERT_EQ(back[0].status, SolveStatus::ok);
  // Lengths are solved to 1e-13 m; the condition number is below 10.
  EXPECT_LE((back[0].X_BT.translation() - poses[0].translation()).norm(), 1e-11);
}

// Turned and tilted so far that Newton's method from home stops before a singular pose.
TEST(PoseTableOfAHexapod, FarRowsAreSolvedWhereHomeAloneIsNoSeed) {
  const MachineDescription machine = load_machine("hexapod");
  const auto mechanism = machine.make_mechanism();
  Random random(2, "far rows");
  std::vector<Pose> poses;
  std::vector<AxisVector> far;
  for (int n = 0; n < 40'000; ++n) {
    const Vec3 turn(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), random.uniform(-1.2, 1.2));
    const Vec3 way = uniform_vec3(random, 0.1);
    const Pose X = machine.X_BT_home * make_pose(exp_rotation(turn), way);
    AxisVector axes{};
    Pose near;
    if (mechanism->inverse(X, {}, axes) != SolveStatus::ok ||
        mechanism->forward(axes, mechanism->home(), near) == SolveStatus::ok)
      continue;
    poses.push_back(X);
    far.push_back(axes);
  }
  ASSERT_FALSE(far.empty());
  const std::vector<SolvedPose> solved = solve_poses(machine, far);
  int right = 0;
  for (std::size_t n = 0; n < far.size(); ++n)
    right += solved[n].status == SolveStatus::ok &&
             (solved[n].X_BT.translation() - poses[n].translation()).norm() <= 1e-9;
  EXPECT_GT(right, 0) << far.size() << " rows";
}

}  // namespace
}  // namespace understudy::machine
