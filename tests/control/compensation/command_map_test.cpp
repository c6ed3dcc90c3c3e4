// The identity behind every compensated program: a nominal controller that is told the command sets the
// drives that a calibrated one sets when it is told the goal.
#include "control/compensation/command_map.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/random_vector.h"
#include "core/units.h"

namespace understudy::control {
namespace {

using kinematics::AxisVector;
using kinematics::SolveStatus;
using machine::MachineDescription;

// Newton in the forward kinematics ends below 1e-13 m of strut length; arms turn 1e-12 rad at 0.7 m.
constexpr double kSameDrive = 1e-10;  // [m] or [rad]

MachineDescription hexapod_off_by(double sigma) {
  MachineDescription known = machine::load_machine("hexapod");
  Random random(7, "command map");
  auto& geometry = known.hexapod().geometry;
  for (std::size_t i = 0; i < geometry.base_joint.size(); ++i) {
    geometry.base_joint[i] += sigma * normal_vec3(random);
    geometry.platform_joint[i] += sigma * normal_vec3(random);
    geometry.length_offset[i] += sigma * random.normal();
  }
  return known;
}

MachineDescription arm_off_by(double sigma) {
  MachineDescription known = machine::load_machine("arm");
  Random random(7, "command map");
  auto& kinematics = known.chain().kinematics;
  kinematics.design = kinematics.chain;
  for (auto& axis : kinematics.chain.axes) {
    axis.point += sigma * normal_vec3(random);
    axis.direction = (exp_rotation(sigma * normal_vec3(random)) * axis.direction).normalized();
  }
  return known;
}

void expect_same_drives(const MachineDescription& nominal, const MachineDescription& known) {
  CommandMap map(nominal, known);
  const auto by_nominal = nominal.make_mechanism(), by_known = known.make_mechanism();
  const Pose X_BW = nominal.X_WB.inverse();
  const Vec3 middle =
      nominal.is_chain() ? Vec3(0, 0, 0.05) : Vec3((nominal.X_WB * nominal.X_BT_home).translation());
  AxisVector q_nominal{}, q_known{};
  for (int k = 0; k < 20; ++k) {
    const Pose goal =
        make_pose(exp_rotation(Vec3(0.01 * k, -0.1, 0.02)), Vec3(middle + Vec3(0.001 * k, 0.01, 0)));
    NominalCommand command;
    ASSERT_EQ(map.command(goal, std::nullopt, command), SolveStatus::ok);
    ASSERT_EQ(by_nominal->inverse(X_BW * command.X_WT, q_nominal, q_nominal), SolveStatus::ok);
    ASSERT_EQ(by_known->inverse(X_BW * goal, q_known, q_known), SolveStatus::ok);
    const AxisVector zero_nominal = nominal.drive_zero(), zero_known = known.drive_zero();
    for (int i = 0; i < by_nominal->axis_count(); ++i) {
      const auto a = static_cast<std::size_t>(i);
      EXPECT_NEAR(q_nominal[a] - zero_nominal[a], q_known[a] - zero_known[a], kSameDrive) << "axis " << i;
    }
    EXPECT_GT((command.X_WT.translation() - goal.translation()).norm(), 20e-6) << "the machines differ";
    Pose X_WT;
    ASSERT_EQ(map.tool_at(q_nominal, X_WT), SolveStatus::ok);
    EXPECT_LT((X_WT.translation() - goal.translation()).norm(), kSameDrive);
  }
}

TEST(CommandMap, HexapodsDrivesAreThoseOfACalibratedController) {
  expect_same_drives(machine::load_machine("hexapod"), hexapod_off_by(0.5e-3));
}

TEST(CommandMap, ArmsDrivesAreThoseOfACalibratedController) {
  expect_same_drives(machine::load_machine("arm"), arm_off_by(0.3e-3));
}

TEST(CommandMap, AMachineThatIsAsDrawnIsToldWhatWasAskedFor) {
  const MachineDescription nominal = machine::load_machine("hexapod");
  CommandMap map(nominal, nominal);
  const Pose goal = make_pose(exp_rotation(Vec3(0.1, 0, 0)), Vec3(0.01, 0.02, 0.05));
  NominalCommand command;
  ASSERT_EQ(map.command(goal, std::nullopt, command), SolveStatus::ok);
  EXPECT_TRUE(command.X_WT.isApprox(goal, 1e-11));
}

TEST(CommandMap, AnUprightToolOverATableKeepsItsTurnsAndHasItsTipPutRight) {
  const MachineDescription nominal = machine::load_machine("five-axis");
  MachineDescription known = nominal;
  auto& kinematics = known.chain().kinematics;
  kinematics.design = kinematics.chain;
  for (auto& axis : kinematics.chain.axes)
    axis.direction = (exp_rotation(Vec3(4e-4, -3e-4, 2e-4)) * axis.direction).normalized();
  CommandMap map(nominal, known);
  const Pose goal = make_pose(Mat3(Mat3::Identity()), Vec3(0.02, 0.01, 0.03));
  NominalCommand command;
  ASSERT_EQ(map.command(goal, toolpath::RotaryTurns{}, command), SolveStatus::ok);
  ASSERT_TRUE(command.rotary);
  AxisVector axes{}, rates{};
  ASSERT_EQ(nominal.make_mechanism()->axes_at_turns(
                {command.X_WT.translation(), command.rotary->b, command.rotary->c}, {}, axes, rates),
            SolveStatus::ok);
  Pose X_WT;
  ASSERT_EQ(map.tool_at(axes, X_WT), SolveStatus::ok);
  EXPECT_LT((X_WT.translation() - goal.translation()).norm(), 1e-9);
}

TEST(CommandMap, OutOfReachIsAStatus) {
  const MachineDescription nominal = machine::load_machine("arm");
  CommandMap map(nominal, nominal);
  NominalCommand command;
  EXPECT_NE(map.command(make_pose(Mat3(Mat3::Identity()), Vec3(5, 0, 0)), std::nullopt, command),
            SolveStatus::ok);
}

}  // namespace
}  // namespace understudy::control
