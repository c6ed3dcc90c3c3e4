// What the struts carry, against statics and Newton's second law.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "sim/plant/plant.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/motion.h"

namespace understudy::sim {
namespace {

using kinematics::kStruts;
using Forces = Eigen::Matrix<double, kStruts, 1>;

Forces forces(const Plant& plant) {
  const kinematics::AxisVector force = plant.drive_force();
  return Eigen::Map<const Forces>(force.data());
}

/// J^T f + W = 0: the strut forces that hold masses, fixed to the platform at points in T, under an apparent
/// gravity in B.
Forces holding_forces(const machine::MachineDescription& machine, const Pose& X_BT, const Vec3& gravity_B) {
  Twist wrench = Twist::Zero();
  const auto add = [&](double mass, const Vec3& p_T) {
    wrench.head<3>() += mass * gravity_B;
    wrench.tail<3>() += (X_BT.linear() * p_T).cross(mass * gravity_B);
  };
  add(machine.hexapod().masses.platform, machine.hexapod().masses.platform_centre_T);
  // A nut and its rod end hang in the ball joint, so their weight is the platform's.
  for (const Vec3& ball : machine.hexapod().geometry.platform_joint) add(machine.hexapod().masses.nut, ball);
  Mat6 J;
  EXPECT_EQ(kinematics::jacobian(machine.hexapod().geometry, X_BT, J), kinematics::SolveStatus::ok);
  return -J.transpose().partialPivLu().solve(wrench);
}

/// G4 whose motors weigh nothing, so that the platform carries all that the struts hold.
machine::MachineDescription machine_with_light_motors() {
  auto machine = machine_g4();
  machine.hexapod().masses.motor = 1e-6;
  return machine;
}

MujocoOptions without_play() {
  MujocoOptions options;
  options.play = false;
  return options;
}

Pose tilted(const machine::MachineDescription& machine, double tilt, double azimuth) {
  Pose X_BT = machine.X_BT_home;
  X_BT.linear() = exp_rotation(tilt * Vec3(std::cos(azimuth), std::sin(azimuth), 0));
  return X_BT;
}

TEST(MujocoForces, StrutsCarryTheWeight) {
  const auto machine = machine_with_light_motors();
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const auto plant = make_mujoco_plant(machine, built, without_play());
  for (const double tilt : {0.0, 10.0, 20.0}) {
    for (const double azimuth : {0.0, 50.0, 200.0}) {
      const Pose X_BT = tilted(machine, from_deg(tilt), from_deg(azimuth));
      plant->reset(drive_command(machine.hexapod().geometry, X_BT).position);
      const Forces expected = holding_forces(machine, X_BT, Vec3(0, 0, -kGravity));
      // 1e-4 of a strut's share: the engine's solver stops at 1e-10 of the cost, and the motors weigh 60 uN.
      EXPECT_LE((forces(*plant) - expected).cwiseAbs().maxCoeff(), 2e-4) << tilt << " " << azimuth;
    }
  }
}

TEST(MujocoForces, HangingStrutsPull) {
  const auto machine = machine_g4();
  const auto plant = make_mujoco_plant(machine, make_as_built(machine, "nominal", 1), {});
  EXPECT_LT(forces(*plant).maxCoeff(), -1);  // each holds a sixth of 10 N
}

TEST(MujocoForces, AccelerationTakesForceByNewtonsLaw) {
  auto machine = machine_with_light_motors();
  machine.hexapod().masses.nut =
      1e-3;  // a strut's swing, which the closed form leaves out, then weighs nothing
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const auto plant = make_mujoco_plant(machine, built, without_play());
  plant->reset(drive_command(machine.hexapod().geometry, machine.X_BT_home).position);
  const Vec3 acceleration(1, -0.5, 2);  // [m/s^2]
  const int steps = steps_for(*plant, 0.05);
  for (int k = 0; k < steps; ++k) {
    const double t = k * plant->timestep();
    Pose X_BT = machine.X_BT_home;
    X_BT.translation() += t * t / 2 * acceleration;
    Twist twist = Twist::Zero();
    twist.head<3>() = t * acceleration;
    plant->step(drive_command(machine.hexapod().geometry, X_BT, twist));
  }
  const double t = (steps - 1) * plant->timestep();
  Pose X_BT = machine.X_BT_home;
  X_BT.translation() += t * t / 2 * acceleration;
  const Forces expected = holding_forces(machine, X_BT, Vec3(0, 0, -kGravity) - acceleration);
  // 0.5 % of the largest force: the swing of six 1 g rods, and the onset 0.05 s before.
  EXPECT_LE((forces(*plant) - expected).cwiseAbs().maxCoeff(), 0.005 * expected.cwiseAbs().maxCoeff());
}

Pose beside_home(const machine::MachineDescription& machine, double tilt, double azimuth, double distance) {
  Pose X_BT = tilted(machine, tilt, azimuth + std::numbers::pi / 2);
  X_BT.translation() += distance * Vec3(std::cos(azimuth), std::sin(azimuth), 0);
  return X_BT;
}

/// Smallest distance of the tip from the machine's axis, at home height, at which statics lets a strut push.
double distance_of_first_reversal(const machine::MachineDescription& machine, double tilt, double azimuth) {
  double distance = 0;
  while (holding_forces(machine, beside_home(machine, tilt, azimuth, distance), Vec3(0, 0, -kGravity))
             .maxCoeff() < 0)
    distance += from_mm(0.02);
  return distance;
}

TEST(MujocoForces, PreloadIsLostAtTheDistanceThatStaticsGives) {
  const auto machine = machine_with_light_motors();
  const AsBuilt built = make_as_built(machine, "nominal", 1);
  const auto plant = make_mujoco_plant(machine, built, without_play());
  for (const double tilt : {0.0, 10.0}) {
    for (const double azimuth : {0.0, 30.0, 60.0, 90.0, 200.0}) {
      const double distance = distance_of_first_reversal(machine, from_deg(tilt), from_deg(azimuth));
      RecordProperty(fmt::format("reversal_mm_tilt_{}_azimuth_{}", tilt, azimuth),
                     fmt::format("{:.2f}", to_mm(distance)));
      const auto largest = [&](double at) {
        plant->reset(drive_command(machine.hexapod().geometry,
                                   beside_home(machine, from_deg(tilt), from_deg(azimuth), at))
                         .position);
        return forces(*plant).maxCoeff();
      };
      // 0.1 mm moves the strut's force by 10 mN, fifty times what the forces are off in StrutsCarryTheWeight.
      EXPECT_LT(largest(distance - from_mm(0.1)), 0) << tilt << " " << azimuth;
      EXPECT_GT(largest(distance + from_mm(0.1)), 0) << tilt << " " << azimuth;
    }
  }
}

}  // namespace
}  // namespace understudy::sim
