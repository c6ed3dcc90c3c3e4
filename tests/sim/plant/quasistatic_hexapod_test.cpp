// The quasistatic hexapod against closed forms: statics, play, deflection, hysteresis.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/error.h"
#include "sim/plant/quasistatic/quasistatic.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/motion.h"

namespace understudy::sim {
namespace {

using kinematics::kStruts;
using Forces = Eigen::Matrix<double, kStruts, 1>;

Forces forces(const kinematics::AxisVector& force) { return Eigen::Map<const Forces>(force.data()); }

Mat6 jacobian_at(const machine::MachineDescription& machine, const Pose& X_BT) {
  Mat6 J;
  EXPECT_EQ(kinematics::jacobian(machine.hexapod().geometry, X_BT, J), kinematics::SolveStatus::ok);
  return J;
}

/// J^T f + W = 0 for point masses fixed to the platform and a force on the tip, in B.
Forces holding_forces(const machine::MachineDescription& machine, const Pose& X_BT, const Vec3& gravity_B,
                      const Vec3& tip_force_B = Vec3::Zero()) {
  Twist wrench = Twist::Zero();
  wrench.head<3>() = tip_force_B;
  const auto add = [&](double mass, const Vec3& p_T) {
    wrench.head<3>() += mass * gravity_B;
    wrench.tail<3>() += (X_BT.linear() * p_T).cross(mass * gravity_B);
  };
  add(machine.hexapod().masses.platform, machine.hexapod().masses.platform_centre_T);
  for (const Vec3& ball : machine.hexapod().geometry.platform_joint) add(machine.hexapod().masses.nut, ball);
  return -jacobian_at(machine, X_BT).transpose().partialPivLu().solve(wrench);
}

/// The closed form above leaves the swing of the motors out.
machine::MachineDescription machine_with_light_motors() {
  auto machine = machine_g4();
  machine.hexapod().masses.motor = 1e-9;
  return machine;
}

AsBuilt with_nut_play(const machine::MachineDescription& machine, double play) {
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.nut_play.fill(play);
  built.ball_play.fill(0);
  return built;
}

Pose tilted(const machine::MachineDescription& machine, double tilt_deg, double azimuth_deg,
            const Vec3& offset = Vec3::Zero()) {
  const double azimuth = from_deg(azimuth_deg);
  Pose X_BT = machine.X_BT_home;
  X_BT.linear() = exp_rotation(from_deg(tilt_deg) * Vec3(std::cos(azimuth), std::sin(azimuth), 0));
  X_BT.translation() += offset;
  return X_BT;
}

TEST(QuasistaticHexapod, StrutsCarryTheWeight) {
  const auto machine = machine_with_light_motors();
  const auto plant = make_quasistatic_plant(machine, with_nut_play(machine, 0));
  for (const double tilt : {0.0, 10.0, 25.0}) {
    const Pose X_BT = tilted(machine, tilt, 50);
    plant->reset(drive_command(machine.hexapod().geometry, X_BT).position);
    const Forces expected = holding_forces(machine, X_BT, Vec3(0, 0, -kGravity));
    EXPECT_LE((forces(plant->drive_force()) - expected).norm(), 1e-6) << tilt;  // motors weigh 10 nN
  }
}

TEST(QuasistaticHexapod, AccelerationTakesForceByNewtonsLaw) {
  auto machine = machine_with_light_motors();
  const auto plant = make_quasistatic_plant(machine, with_nut_play(machine, 0));
  const Vec3 acceleration(1, -0.5, 2);  // [m/s^2]
  plant->reset(drive_command(machine.hexapod().geometry, machine.X_BT_home).position);
  Pose X_BT = machine.X_BT_home;
  for (int k = 0; k < 20; ++k) {
    const double t = k * plant->timestep();
    X_BT.translation() = machine.X_BT_home.translation() + t * t / 2 * acceleration;
    Twist twist = Twist::Zero();
    twist.head<3>() = t * acceleration;
    plant->step(drive_command(machine.hexapod().geometry, X_BT, twist));
  }
  const Forces expected = holding_forces(machine, X_BT, Vec3(0, 0, -kGravity) - acceleration);
  // The commands tell the acceleration half a step late; the struts' own rates change by 1e-3 of it.
  EXPECT_LE((forces(plant->drive_force()) - expected).norm(), 2e-3 * expected.norm());
}

TEST(QuasistaticHexapod, NozzleForceAddsItsStatics) {
  const auto machine = machine_with_light_motors();
  QuasistaticOptions options;
  options.nozzle_force_T = Vec3(0.3, -0.2, 1.5);
  const auto plant = make_quasistatic_plant(machine, with_nut_play(machine, 0), options);
  const Pose X_BT = tilted(machine, 15, 200, Vec3(0.01, 0, -0.01));
  plant->reset(drive_command(machine.hexapod().geometry, X_BT).position);
  const Forces expected =
      holding_forces(machine, X_BT, Vec3(0, 0, -kGravity), X_BT.linear() * options.nozzle_force_T);
  EXPECT_LE((forces(plant->drive_force()) - expected).norm(), 1e-6);
}

TEST(QuasistaticHexapod, MotorsPullAsInTheMujocoPlant) {
  const auto machine = machine_g4();
  const AsBuilt built = make_as_built(machine, "sampled", 2);
  MujocoOptions rigid;
  rigid.play = false;
  QuasistaticOptions options;
  options.play = false;
  const auto peer = make_mujoco_plant(machine, built, rigid);
  const auto plant = make_quasistatic_plant(machine, built, options);
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(0.015, 0.005, -0.02), Vec3(-0.01, -0.015, 0.005)}) {
    const DriveCommand command = drive_command(built.hexapod, tilted(machine, 12, 70, offset));
    peer->reset(command.position);
    plant->reset(command.position);
    const Forces expected = forces(peer->drive_force());
    EXPECT_LE((forces(plant->drive_force()) - expected).cwiseAbs().maxCoeff(),
              0.002 * expected.cwiseAbs().maxCoeff());  // 1 % is promised; the engine's solver gives 1e-4
  }
}

TEST(QuasistaticHexapod, PlayShiftsTheTipByTheInverseJacobian) {
  const auto machine = machine_g4();
  const double play = 100e-6;
  const auto plant = make_quasistatic_plant(machine, with_nut_play(machine, play));
  for (const double tilt : {0.0, 15.0, 25.0}) {
    const Pose X_BT = tilted(machine, tilt, 30, Vec3(0.004, 0, -0.01));
    plant->reset(drive_command(machine.hexapod().geometry, X_BT).position);
    // A strut that pulls is drawn long.
    const Forces gap = -play / 2 * forces(plant->drive_force()).cwiseSign();
    const Twist shift = jacobian_at(machine, X_BT).partialPivLu().solve(gap);
    const Vec3 tip = (machine.X_WB.inverse() * plant->tool_pose()).translation() - X_BT.translation();
    // Second order in the play over the platform's radius: 50 um * 50 um * 36 / 29 mm.
    EXPECT_LE((tip - shift.head<3>()).norm(), 3e-6 * shift.head<3>().norm() / 50e-6) << tilt;
    EXPECT_LE(plant->closure_error(), 1e-12);
  }
}

TEST(QuasistaticHexapod, PushingStrutsAreShort) {
  const auto machine = machine_g4();
  QuasistaticOptions options;
  options.nozzle_force_T = Vec3(0, 0, 40);  // more than four times the weight, on the axis
  const auto plant = make_quasistatic_plant(machine, with_nut_play(machine, 100e-6), options);
  EXPECT_GT(forces(plant->drive_force()).minCoeff(), 0);
  EXPECT_GT(plant->tool_pose().translation().z(), (machine.X_WB * machine.X_BT_home).translation().z());
}

TEST(QuasistaticHexapod, NutHangsOnItsOwnUntilTheRodLiftsIt) {
  // The rod pushes with less than the nut weighs: the ball's play is used up, the nut still hangs.
  auto machine = machine_with_light_motors();
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.nut_play.fill(60e-6);
  built.ball_play.fill(30e-6);
  machine.hexapod().masses.nut = 0.1;
  const double weight = machine.hexapod().masses.platform + 6 * machine.hexapod().masses.nut;
  QuasistaticOptions options;
  // The platform is lifted with half of what the six nut bodies (half of nut and rod each) weigh.
  options.nozzle_force_T = Vec3(0, 0, kGravity * (weight - 0.5 * 6 * 0.05));
  QuasistaticSampler sampler(machine, built, options);
  for (std::size_t i = 0; i < kStruts; ++i)
    EXPECT_NEAR(sampler.gap()[i], 30e-6 - 15e-6, 0.1e-6);  // nut long, ball short (told in strut length)
}

TEST(QuasistaticHexapod, FrictionHoldsThePlayOverTwiceItsWidth) {
  auto machine = machine_with_light_motors();
  machine.hexapod().masses.nut = 1e-9;  // else its weight widens the loop
  machine.hexapod().play.friction = 0.5;
  QuasistaticSampler sampler(machine, with_nut_play(machine, 100e-6));
  const Mat6 J = jacobian_at(machine, machine.X_BT_home);
  PathSample sample;
  sample.position = drive_command(machine.hexapod().geometry, machine.X_BT_home).position;
  constexpr double kIncrement = 0.01;  // [m/s^2]: 1.7 mN a strut
  // Falls faster and faster until the struts push, and back; the force at which strut 1 changes sides.
  const auto force_at_change = [&](double from, double to) {
    const double sign = to > from ? 1 : -1;
    double before = 0;
    for (double a = from; sign * (to - a) > 0; a += sign * kIncrement) {
      const Forces rates = J.col(2) * -a;
      for (std::size_t i = 0; i < kStruts; ++i) sample.acceleration[i] = rates(static_cast<Eigen::Index>(i));
      Pose X_WT;
      EXPECT_EQ(sampler.sample(sample, X_WT), kinematics::SolveStatus::ok);
      const double gap = sampler.gap()[0];
      if (before * gap < 0) return sampler.drive_force()[0];
      before = gap;
    }
    ADD_FAILURE() << "the play stays where it is";
    return 0.0;
  };
  const double pushed = force_at_change(0, 30), pulled = force_at_change(30, 0);
  EXPECT_NEAR(pushed, 0.5, 0.01);  // five increments, and the play's own change of the pose
  EXPECT_NEAR(pulled, -0.5, 0.01);
}

TEST(QuasistaticHexapod, ElasticDrivesYieldByForceOverStiffness) {
  auto machine = machine_g4();
  for (machine::Drive& drive : machine.drives) drive.stiffness = 2e5, drive.resonance = 200;
  const auto plant = make_quasistatic_plant(machine, with_nut_play(machine, 0));
  const Pose X_BT = tilted(machine, 10, 0);
  const DriveCommand command = drive_command(machine.hexapod().geometry, X_BT);
  plant->reset(command.position);
  const DriveCommand reached =
      drive_command(machine.hexapod().geometry, machine.X_WB.inverse() * plant->tool_pose());
  for (std::size_t i = 0; i < kStruts; ++i) {
    const double yielded = -plant->drive_force()[i] / 2e5;
    EXPECT_NEAR(reached.position[i] - command.position[i], yielded, 1e-9 + 1e-3 * std::abs(yielded));
    EXPECT_NEAR(plant->displacement()[i] - command.position[i], yielded, 1e-9);
  }
}

TEST(QuasistaticHexapod, FallsThroughItsPlayAsABodyFalls) {
  // The drives fall faster than gravity: the platform stays behind by (a - g) t^2 / 2 until it lands.
  auto machine = machine_with_light_motors();
  machine.hexapod().masses.nut = 1e-9;
  const double play = 200e-6;
  const auto plant = make_quasistatic_plant(machine, with_nut_play(machine, play));
  plant->reset(drive_command(machine.hexapod().geometry, machine.X_BT_home).position);
  const double z0 = plant->tool_pose().translation().z();
  constexpr double kFall = 16;  // [m/s^2]
  double lift = 0;
  for (int k = 0; k <= 3; ++k) {
    const double t = k * plant->timestep();
    Pose X_BT = machine.X_BT_home;
    X_BT.translation().z() -= kFall * t * t / 2;
    Twist twist = Twist::Zero();
    twist(2) = -kFall * t;
    plant->step(drive_command(machine.hexapod().geometry, X_BT, twist));
    const double now = t + plant->timestep();
    lift = plant->tool_pose().translation().z() - z0 + kFall * now * now / 2;
  }
  const double t = plant->time();
  // 8 ms: 198 um of 205. Grease (12 N s/m of 1 kg) costs 3 %, the implicit steps of 0.25 ms another 3 %.
  EXPECT_NEAR(lift, (kFall - kGravity) * t * t / 2, 0.08 * 198e-6);
}

}  // namespace
}  // namespace understudy::sim
