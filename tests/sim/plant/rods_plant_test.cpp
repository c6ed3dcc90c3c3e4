// A tool on rods: where the plants put it and what its drives carry, against closed forms, against energies,
// and one engine against the other.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <gmock/gmock.h>
#include <Eigen/LU>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "sim/plant/quasistatic/quasistatic.h"

namespace understudy::sim {
namespace {

using kinematics::AxisVector;

constexpr double kRadius = 0.1344, kRod = 0.267, kHeight = 0.040;  // [m], of models/delta
constexpr double kAngles[] = {210, 330, 90};

Vec3 tower(int i) {
  return kRadius * Vec3(std::cos(from_deg(kAngles[i])), std::sin(from_deg(kAngles[i])), 0);
}

/// Heights of the carriages' joints, in the words of a firmware.
AxisVector carriages(const Vec3& tip, double rod = kRod) {
  AxisVector h{};
  for (int i = 0; i < 3; ++i)
    h[static_cast<std::size_t>(i)] =
        tip.z() + kHeight + std::sqrt(rod * rod - (tip - tower(i)).head<2>().squaredNorm());
  return h;
}

/// The tip that hangs on rods of these lengths, by Newton's method on the three distances.
Vec3 hanging(const AxisVector& h, const Vec3& rods, Vec3 tip) {
  for (int n = 0; n < 50; ++n) {
    Mat3 slope;
    Vec3 off;
    for (int i = 0; i < 3; ++i) {
      const Vec3 u = tip + Vec3(0, 0, kHeight) - tower(i) - Vec3(0, 0, h[static_cast<std::size_t>(i)]);
      off[i] = u.squaredNorm() - rods[i] * rods[i];
      slope.row(i) = 2 * u.transpose();
    }
    tip -= slope.inverse() * off;
  }
  return tip;
}

struct Rig {
  machine::MachineDescription machine = machine::load_machine("delta");
  AsBuilt built = make_as_built(machine, "nominal", 1);
};

QuasistaticOptions without_play() {
  QuasistaticOptions options;
  options.play = false;
  return options;
}

Vec3 random_tip(Random& random) {
  const double r = 0.1 * std::sqrt(random.uniform(0, 1)), a = random.uniform(0, 6.28);
  return {r * std::cos(a), r * std::sin(a), random.uniform(0, 0.2)};
}

TEST(QuasistaticRods, TipHangsWhereTheCarriagesPutIt) {
  const Rig rig;
  const auto plant = make_quasistatic_plant(rig.machine, rig.built, without_play());
  Random random(81, "rods");
  for (int n = 0; n < 200; ++n) {
    const Vec3 tip = random_tip(random);
    plant->reset(carriages(tip));
    EXPECT_LE((plant->tool_pose().translation() - tip).norm(), 1e-11);
    EXPECT_LE(plant->closure_error(), 1e-12);
  }
}

// What is flat for the controller is a dome or a bowl for the tip.
TEST(QuasistaticRods, RodsHalfAMillimetreTooLongMakeTheDomeOfTheClosedForm) {
  Rig rig;
  const double longer = 0.5e-3;
  for (double& rod : rig.built.chain.rods) rod += longer;
  const auto plant = make_quasistatic_plant(rig.machine, rig.built, without_play());
  const auto height = [&](const Vec3& tip) {
    plant->reset(carriages(tip));
    const Vec3 expected = hanging(carriages(tip), Vec3::Constant(kRod + longer), tip);
    EXPECT_LE((plant->tool_pose().translation() - expected).norm(), 1e-11);
    return plant->tool_pose().translation().z() - tip.z();
  };
  // Over the middle the rods lean all alike.
  const double middle = std::sqrt(kRod * kRod - kRadius * kRadius) -
                        std::sqrt((kRod + longer) * (kRod + longer) - kRadius * kRadius);
  EXPECT_NEAR(height(Vec3::Zero()), middle, 1e-12);
  EXPECT_NEAR(to_mm(middle), -0.578, 0.001);
  const double rim = height(Vec3(0, -0.1, 0));
  EXPECT_GT(std::abs(rim - middle), 0.05e-3);
}

TEST(QuasistaticRods, ShortRodPullsTheTipAsItsSphereSays) {
  Rig rig;
  rig.built.chain.rods[0] -= 0.5e-3;
  rig.built.chain.axes[1].point += Vec3(0, 0, 0.3e-3);  // a tower that stands higher
  const auto plant = make_quasistatic_plant(rig.machine, rig.built, without_play());
  const Vec3 tip(0.03, -0.05, 0.02);
  AxisVector h = carriages(tip);
  plant->reset(h);
  h[1] += 0.3e-3;
  const Vec3 expected = hanging(h, Vec3(kRod - 0.5e-3, kRod, kRod), tip);
  EXPECT_GT((expected - tip).norm(), 0.3e-3);
  EXPECT_LE((plant->tool_pose().translation() - expected).norm(), 1e-11);
}

// Every carriage hangs at the lower end of its play: one play of 100 um lowers its carriage by 50.
TEST(QuasistaticRods, PlayReachesTheTipThroughItsRod) {
  Rig rig;
  rig.built.axis_play = {100e-6, 0, 0};
  const auto plant = make_quasistatic_plant(rig.machine, rig.built);
  for (const Vec3& tip : {Vec3(0, 0, 0.05), Vec3(-0.08, -0.06, 0.01), Vec3(0.1, 0, 0.01)}) {
    plant->reset(carriages(tip));
    AxisVector h = carriages(tip);
    h[0] -= 50e-6;
    EXPECT_LE((plant->tool_pose().translation() - hanging(h, Vec3::Constant(kRod), tip)).norm(), 1e-10);
  }
}

double weight(const Rig& rig) {
  const machine::ChainModel& model = rig.machine.chain();
  return model.rods.carried + 3 * (model.rods.mass + model.links[0].mass);
}

TEST(QuasistaticRods, DrivesCarryAllThatHangsOnThem) {
  const Rig rig;
  const auto plant = make_quasistatic_plant(rig.machine, rig.built, without_play());
  plant->reset(carriages(Vec3(0, 0, 0.05)));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(plant->drive_force()[i], kGravity * weight(rig) / 3, 1e-12);
  plant->reset(carriages(Vec3(0.06, 0.07, 0.05)));
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += plant->drive_force()[i];
  EXPECT_NEAR(sum, kGravity * weight(rig), 1e-12);  // the drives alone push upwards
}

/// Kinetic and potential energy of carriages, rods (thin, by the velocities of their ends) and tool.
double energy(const Rig& rig, const Vec3& tip, const Vec3& v, const Vec3& h, const Vec3& h_rate) {
  const machine::ChainModel& model = rig.machine.chain();
  double sum = model.rods.carried * (0.5 * v.squaredNorm() + kGravity * tip.z());
  for (int i = 0; i < 3; ++i) {
    const Vec3 slide(0, 0, h_rate[i]);
    sum += model.links[0].mass * (0.5 * slide.squaredNorm() + kGravity * h[i]);
    sum += model.rods.mass *
           ((slide.squaredNorm() + slide.dot(v) + v.squaredNorm()) / 6 + kGravity * (h[i] + tip.z()) / 2);
  }
  return sum;
}

TEST(QuasistaticRods, DrivesDoTheWorkThatTheEnergiesGain) {
  const Rig rig;
  QuasistaticSampler sampler(rig.machine, rig.built, without_play());
  Random random(82, "rods");
  for (int n = 0; n < 50; ++n) {
    const Vec3 start = random_tip(random);
    Vec3 h, rate, rate2;
    for (int i = 0; i < 3; ++i) {
      h[i] = carriages(start)[static_cast<std::size_t>(i)];
      rate[i] = random.uniform(-0.2, 0.2);
      rate2[i] = random.uniform(-3, 3);
    }
    const auto axes_at = [&](double t) { return Vec3(h + t * rate + t * t / 2 * rate2); };
    const auto tip_at = [&](double t) {
      const Vec3 q = axes_at(t);
      return hanging({q[0], q[1], q[2]}, Vec3::Constant(kRod), start);
    };
    constexpr double dt = 1e-4;  // [s]
    const auto energy_at = [&](double t) {
      const Vec3 v = (tip_at(t + dt) - tip_at(t - dt)) / (2 * dt);
      return energy(rig, tip_at(t), v, axes_at(t), rate + t * rate2);
    };
    PathSample sample;
    for (int i = 0; i < 3; ++i) {
      const auto s = static_cast<std::size_t>(i);
      sample.position[s] = h[i], sample.velocity[s] = rate[i], sample.acceleration[s] = rate2[i];
    }
    Pose X_WT;
    ASSERT_EQ(sampler.sample(sample, X_WT), kinematics::SolveStatus::ok);
    double power = 0;
    for (int i = 0; i < 3; ++i) power += sampler.drive_force()[static_cast<std::size_t>(i)] * rate[i];
    EXPECT_NEAR(power, (energy_at(dt) - energy_at(-dt)) / (2 * dt), 2e-6) << n;
  }
}

TEST(QuasistaticRods, CarriagesThatTearTheRodsApartAreAFailure) {
  const Rig rig;
  const auto plant = make_quasistatic_plant(rig.machine, rig.built, without_play());
  AxisVector h = carriages(Vec3::Zero());
  h[2] += 0.5;
  EXPECT_THROW(plant->reset(h), MachineError);
}

/// A circle of 60 mm at 50 mm/s, from rest.
DriveCommand circle(double t) {
  constexpr double kCircle = 0.06, kRate = 0.05 / kCircle, kRamp = 0.3;
  const auto tip = [](double time) {
    const double turn = kRate * (time < kRamp ? time * time / (2 * kRamp) : time - kRamp / 2);
    return Vec3(kCircle * std::cos(turn), kCircle * std::sin(turn), 0.01 + 0.02 * std::sin(turn));
  };
  constexpr double h = 1e-5;
  const AxisVector now = carriages(tip(t)), ahead = carriages(tip(t + h)), behind = carriages(tip(t - h));
  DriveCommand command;
  command.position = now;
  if (t > h)
    for (std::size_t i = 0; i < 3; ++i) command.velocity[i] = (ahead[i] - behind[i]) / (2 * h);
  return command;
}

TEST(MujocoRods, FollowsTheQuasistaticTip) {
  Rig rig;
  rig.built = make_as_built(rig.machine, "manufactured", 3);
  rig.built.drives = {};
  const auto peer = make_mujoco_plant(rig.machine, rig.built);
  const auto plant = make_quasistatic_plant(rig.machine, rig.built);
  peer->reset(circle(0).position);
  plant->reset(circle(0).position);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(peer->drive_force()[i], plant->drive_force()[i], 1e-3) << i;
  const int finer = static_cast<int>(std::lround(plant->timestep() / peer->timestep()));
  double peak = 0, closure = 0;
  for (int k = 0; k < 750; ++k) {
    const double t = k * plant->timestep();
    for (int j = 0; j < finer; ++j) peer->step(circle(t + j * peer->timestep()));
    plant->step(circle(t));
    peak = std::max(peak, (peer->tool_pose().translation() - plant->tool_pose().translation()).norm());
    closure = std::max(closure, peer->closure_error());
  }
  EXPECT_LE(peak, 10e-6);  // the figure that the project promises for its engines
  EXPECT_LE(closure, 10e-6);
  RecordProperty("peak_um", std::to_string(to_um(peak)));
}

TEST(BulletRods, AreRefusedWithWhatToUse) {
  const Rig rig;
  try {
    static_cast<void>(make_bullet_plant(rig.machine, rig.built));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("rods carry the tool: use mujoco or quasistatic"));
  }
}

}  // namespace
}  // namespace understudy::sim
