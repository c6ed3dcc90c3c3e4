// The quasistatic hexapod beside the MuJoCo plant, play 100 um.
#include <gtest/gtest.h>

#include "sim/plant/quasistatic/quasistatic.h"
#include "tests/sim/plant/machine_g4.h"
#include "tests/sim/plant/motion.h"

namespace understudy::sim {
namespace {

constexpr double kAgreement = 10e-6;  // [m]: the figure that the project promises

AsBuilt with_play(const machine::MachineDescription& machine, double total) {
  AsBuilt built = make_as_built(machine, "nominal", 1);
  built.nut_play.fill(total * 2 / 3);
  built.ball_play.fill(total / 3);
  return built;
}

/// Largest distance of the tips while both follow `motion` (time to pose and twist, in B).
template <typename Motion>
double peak_difference(const machine::MachineDescription& machine, const Motion& motion, double duration) {
  const AsBuilt built = with_play(machine, 100e-6);
  const auto peer = make_mujoco_plant(machine, built);
  const auto plant = make_quasistatic_plant(machine, built);
  const auto command = [&](double t) {
    Twist twist = Twist::Zero();
    const Pose X_BT = motion(t, twist);
    return drive_command(built.hexapod, X_BT, twist);
  };
  peer->reset(command(0).position);
  plant->reset(command(0).position);
  const int finer = static_cast<int>(std::lround(plant->timestep() / peer->timestep()));
  double peak = 0;
  for (int k = 0; k < steps_for(*plant, duration); ++k) {
    const double t = k * plant->timestep();
    for (int j = 0; j < finer; ++j) peer->step(command(t + j * peer->timestep()));
    plant->step(command(t));
    peak = std::max(peak, (peer->tool_pose().translation() - plant->tool_pose().translation()).norm());
  }
  return peak;
}

TEST(QuasistaticAgreement, TiltSweepFollowsMujoco) {
  const auto machine = machine_g4();
  const auto sweep = [&](double t, Twist& twist) {
    const double w = std::numbers::pi, tilt = from_deg(27) / 2;
    Pose X_BT = machine.X_BT_home;
    X_BT.linear() = exp_rotation(Vec3(tilt * (1 - std::cos(w * t)), 0, 0));
    twist(3) = tilt * w * std::sin(w * t);
    return X_BT;
  };
  EXPECT_LE(peak_difference(machine, sweep, 2), kAgreement);
}

TEST(QuasistaticAgreement, ZigzagBelowTheBoundFollowsMujoco) {
  const auto machine = machine_g4();
  constexpr double kSpeed = 0.1, kLength = 0.03;  // [m/s], [m]
  const double ramp = kSpeed / kQuasistaticBound, time = kLength / kSpeed + ramp;
  const auto zigzag = [&](double t, Twist& twist) {
    const int leg = static_cast<int>(t / time);
    const double u = t - leg * time, left = time - u;
    double s = kSpeed * (u - ramp / 2), v = kSpeed;
    if (u < ramp) s = kQuasistaticBound * u * u / 2, v = kQuasistaticBound * u;
    if (left < ramp) s = kLength - kQuasistaticBound * left * left / 2, v = kQuasistaticBound * left;
    Pose X_BT = machine.X_BT_home;
    X_BT.translation().x() += leg % 2 == 0 ? s - kLength / 2 : kLength / 2 - s;
    twist(0) = leg % 2 == 0 ? v : -v;
    return X_BT;
  };
  EXPECT_LE(peak_difference(machine, zigzag, 1.2), kAgreement);
}

TEST(QuasistaticAgreement, TiltedCircleMissesOnlyWherePlaysAreCrossed) {
  // Gravity turns loads on this circle. Under way a play differs by as much as MuJoCo from itself at another
  // timestep (64 um); most of the time is outside.
  const auto machine = machine_g4();
  const Circle circle = tilted_circle(machine);
  const auto motion = [&](double t, Twist& twist) {
    twist = circle.twist(t);
    return circle.pose(t);
  };
  EXPECT_LE(peak_difference(machine, motion, 2.5), 100e-6);
}

}  // namespace
}  // namespace understudy::sim
