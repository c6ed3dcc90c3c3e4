// Open chains in MuJoCo against closed forms.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "sim/plant/mujoco/mjcf.h"
#include "sim/plant/mujoco/mujoco_engine.h"
#include "sim/plant/plant.h"
#include "tests/sim/plant/small_chains.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;

constexpr double kPi = std::numbers::pi;

std::unique_ptr<Plant> nominal_plant(const machine::MachineDescription& machine, bool play = true) {
  MujocoOptions options;
  options.play = play;
  return make_mujoco_plant(machine, make_as_built(machine, "nominal", 1), options);
}

Pose pose_of(const machine::MachineDescription& machine, const AxisVector& axes) {
  const auto& chain = machine.chain().kinematics.chain;
  return machine.X_WB *
         kinematics::forward(chain, std::span(axes).first(static_cast<std::size_t>(chain.size())));
}

TEST(MujocoChain, TwoLinksAreHeldByTheMomentsOfStatics) {
  for (const auto& [q1, q2] : {std::pair{0.0, 0.0}, std::pair{0.4, -0.9}, std::pair{-1.0, 0.3}}) {
    const auto machine = two_links(q1, q2);
    const auto plant = nominal_plant(machine);
    plant->step(hold(home_of(machine)));
    const double lower = 1.5 * kGravity * 0.1 * std::cos(q1 + q2);
    const double upper = kGravity * (3.0 * 0.12 + 1.5 * 0.3) * std::cos(q1) + lower;
    // What gravity asks for, the drive gives against it; at rest to the constraint's 1e-4 (impedance 0.9999).
    EXPECT_NEAR(plant->drive_force()[0], -upper, 1e-3 * upper);
    EXPECT_NEAR(plant->drive_force()[1], -lower, 1e-3 * std::abs(lower) + 1e-9);
  }
}

TEST(MujocoChain, BothIntegratingAndQuasistaticPlantCountDriveForcesTheSameWay) {
  const auto machine = two_links(0.4, -0.9);
  const auto mujoco = nominal_plant(machine);
  const auto quasistatic = make_quasistatic_plant(machine, make_as_built(machine, "nominal", 1));
  mujoco->step(hold(home_of(machine)));
  quasistatic->step(hold(home_of(machine)));
  for (const std::size_t i : {0, 1})
    EXPECT_NEAR(mujoco->drive_force()[i] / quasistatic->drive_force()[i], 1, 1e-3);
}

class ShippedChain : public testing::TestWithParam<const char*> {
 protected:
  machine::MachineDescription machine_ = machine::load_machine(GetParam());
};

// A drive gives way by (1 - d) / d f / (M k), k = 1 / (2 dt)^2 (MuJoCo, "solver parameters"): with d = 0.9999
// and f / M = 20 rad/s^2, an arm that falls, 2 nrad at 0.5 ms; over six joints and 0.6 m of arm.
TEST_P(ShippedChain, WithoutPlayTheToolRestsWhereKinematicsPutsIt) {
  const auto plant = nominal_plant(machine_, false);
  Random random(71, "rest");
  const auto& axes = machine_.chain().kinematics.chain.axes;
  for (int pose = 0; pose < 5; ++pose) {
    AxisVector at = home_of(machine_);
    for (std::size_t i = 0; i < axes.size(); ++i)
      at[i] += random.uniform(-1, 1) * (axes[i].angle ? from_deg(15) : from_mm(20));
    plant->reset(at);
    const Pose X = pose_of(machine_, at);
    EXPECT_LT((plant->tool_pose().translation() - X.translation()).norm(), 10e-9);
    EXPECT_LT(angle_between(plant->tool_pose().linear(), X.linear()), 15e-9);
    for (std::size_t i = 0; i < axes.size(); ++i) EXPECT_NEAR(plant->displacement()[i], at[i], 5e-9);
  }
}

// docs/reference.md#mujoco, arm: tip error 0.5 um at 0.5 ms.
TEST_P(ShippedChain, FollowsAMovingCommandWithinAMicrometre) {
  const auto plant = nominal_plant(machine_, false);
  const AxisVector home = home_of(machine_);
  const auto& axes = machine_.chain().kinematics.chain.axes;
  const double rate = 2 * kPi;  // [rad/s]
  // Speeds up to 25 mm/s and 15 deg/s, all axes at once, from rest.
  const auto command_at = [&](double t) {
    DriveCommand command;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double amplitude = axes[i].angle ? from_deg(2.4) : from_mm(4);
      command.position[i] = home[i] + amplitude * (1 - std::cos(rate * t));
      command.velocity[i] = amplitude * rate * std::sin(rate * t);
    }
    return command;
  };
  const double dt = plant->timestep();
  double worst = 0;
  for (int k = 0; k < 2000; ++k) {
    plant->step(command_at(k * dt));
    const Pose X = pose_of(machine_, command_at((k + 1) * dt).position);
    worst = std::max(worst, (plant->tool_pose().translation() - X.translation()).norm());
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(worst, 0);
}

// The bodies of the MJCF against the screws: tip and work as other programs see them.
TEST_P(ShippedChain, SitesOfTheModelAreWhereKinematicsPutsToolAndWork) {
  const AsBuilt built = make_as_built(machine_, "manufactured", 4);
  const auto model = load_model(write_mjcf(machine_, built, machine_.X_WB * machine_.X_BT_home));
  const auto data = make_data(*model);
  Random random(72, "sites");
  for (int pose = 0; pose < 20; ++pose) {
    std::vector<double> q;
    for (const auto& axis : built.chain.axes) {
      q.push_back(random.uniform(-1, 1) * (axis.angle ? 1.0 : 0.1));
      data->qpos[model->jnt_qposadr[find_id(*model, mjOBJ_JOINT, axis.name)]] = q.back();
    }
    mj_kinematics(model.get(), data.get());
    const auto site = [&](const char* name) {
      const int id = find_id(*model, mjOBJ_SITE, name);
      return make_pose(
          Mat3(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->site_xmat + 9 * id)),
          Vec3(Eigen::Map<const Vec3>(data->site_xpos + 3 * id)));
    };
    const Pose X_ST = site("work").inverse() * site("tip");
    const Pose X = kinematics::forward(built.chain, q);
    // The file's numbers have all digits; what is left is rounding along six joints of half a metre.
    EXPECT_LT((X_ST.translation() - X.translation()).norm(), 1e-14);
    EXPECT_LT((X_ST.linear() - X.linear()).norm(), 1e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(Machines, ShippedChain, testing::Values("arm", "five-axis", "finishing"),
                         [](const auto& one) {
                           std::string name = one.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

// docs/reference.md#five-axis-printer: seen from the table the tool is at Rz(C) Ry(B) (X, Y, Z), B about a
// line 30 mm below its top.
TEST(MujocoChain, ATurnedTableCarriesTheWork) {
  const auto machine = machine::load_machine("five-axis");
  const auto plant = nominal_plant(machine, false);
  AxisVector at = home_of(machine);  // x, y, z, b, c
  at[0] = from_mm(20);
  at[4] = kPi / 2;
  plant->reset(at);
  EXPECT_LT((plant->tool_pose().translation() - Vec3(0, 0.020, at[2])).norm(), 5e-9);
  EXPECT_LT(angle_between(plant->tool_pose().linear(), exp_rotation(Vec3(0, 0, kPi / 2))), 5e-9);
  at[0] = at[4] = 0;
  at[3] = from_deg(30);
  plant->reset(at);
  const double height = at[2] + 0.030;
  EXPECT_NEAR(plant->tool_pose().translation().x(), height * std::sin(from_deg(30)), 5e-9);
  EXPECT_NEAR(plant->tool_pose().translation().z(), height * std::cos(from_deg(30)) - 0.030, 5e-9);
}

/// One axis with play, driven slowly there and back; where its load rests after each.
struct Loop {
  double forth = 0, back = 0;
};
Loop reversal(const machine::MachineDescription& machine, double speed) {
  const auto plant = nominal_plant(machine);
  const Vec3 axis = machine.chain().kinematics.chain.axes[0].direction;
  const double target = machine.chain().kinematics.home[0];
  const auto load = [&] {  // the load's own turn, from the tool
    const Mat3 R = plant->tool_pose().linear();
    return Vec3(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)).dot(axis) / 2;
  };
  const double way = 10e-3;  // [rad]
  DriveCommand command;
  const auto go = [&](double from, double to) {
    const double direction = to > from ? 1 : -1;
    for (double q = from; direction * (to - q) > 0; q += direction * speed * plant->timestep()) {
      command.position[0] = q;
      command.velocity[0] = direction * speed;
      plant->step(command);
    }
    command = hold({to});
    for (int k = 0; k < 1000; ++k) plant->step(command);
  };
  go(target, target + way);
  go(target + way, target);
  Loop loop;
  loop.back = std::asin(load()) - target;
  go(target, target - way);
  go(target - way, target);
  loop.forth = std::asin(load()) - target;
  return loop;
}

// Nothing but its inertia acts on the load: it runs on when the drive stops, and the grease (2 N s/m at the
// scale of 0.1 m) lets it coast for speed I / D = 1.15 b, just beyond the play. So it rests at the stop
// ahead; a blow of the 15 % that are left, at a stop that gives back some 5 % of them, stays within 3 % of b.
TEST(MujocoChain, AnAxisWithoutLoadRestsWhereItsMotionHasCarriedIt) {
  const double b = 1e-3;
  SmallAxis axis{true, Vec3::UnitZ(), {0, 0, 0}, 0.1, {0.1, 0, 0}, 1e-3};  // I / D = 0.1 s
  axis.play = b;
  const Loop loop = reversal(small_chain({axis}, {0.3, 0, 0}), 11.5e-3);
  EXPECT_NEAR(loop.forth, b / 2, 0.03 * b);
  EXPECT_NEAR(loop.back, -b / 2, 0.03 * b);
}

// Below friction the load stays where it is within the play, whichever way the drive goes.
TEST(MujocoChain, AnAxisWithFrictionAndNoLoadStaysInThePlaceThatItHasInItsPlay) {
  SmallAxis axis{true, Vec3::UnitZ(), {0, 0, 0}, 1.0, {0.1, 0, 0}, 1e-2};
  axis.play = 1e-3;
  axis.friction = 2.0;  // 10 mrad/s within a step of 0.5 ms take I v / dt = 0.4 N m
  const Loop loop = reversal(small_chain({axis}, {0.3, 0, 0}), 10e-3);
  EXPECT_NEAR(loop.forth, 0, 0.01 * axis.play);
  EXPECT_NEAR(loop.back, 0, 0.01 * axis.play);
}

TEST(MujocoChain, ALoadedAxisStaysOnItsSide) {
  const double b = 1e-3;
  SmallAxis axis{true, Vec3::UnitY(), {0, 0, 0}, 1.0, {0.1, 0, 0}, 1e-2};
  axis.play = b;
  axis.friction = 0.01;  // gravity's 0.98 N m is above it
  const Loop loop = reversal(small_chain({axis}, {0.3, 0, 0}), 10e-3);
  EXPECT_NEAR(loop.forth, b / 2, 0.001 * b);  // a positive turn lowers it
  EXPECT_NEAR(loop.back, b / 2, 0.001 * b);
}

TEST(MujocoChain, AnAxisZeroShiftsWhatTheDriveReadsNotWhereItIs) {
  const auto machine = two_links(0.4, -0.9);
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.axis_zero[1] = 2e-3;
  const auto plant = make_mujoco_plant(machine, built);
  AxisVector truth = home_of(machine);
  EXPECT_NEAR(plant->displacement()[1], truth[1], 5e-9);
  truth[1] += 2e-3;
  EXPECT_LT((plant->tool_pose().translation() - pose_of(machine, truth).translation()).norm(), 5e-9);
}

}  // namespace
}  // namespace understudy::sim
