#include "studies/calibration/plant_session.h"

#include <cmath>

#include <gtest/gtest.h>

#include "calibration/machine/strut_sides.h"
#include "calibration/pose_choice.h"
#include "core/error.h"
#include "core/units.h"
#include "tests/shipped_hexapod.h"

namespace understudy::studies {
namespace {

using kinematics::StrutLengths;

std::vector<double> lengths_at(const machine::MachineDescription& machine, const Pose& X_BT) {
  std::vector<double> axes(6);
  if (machine.make_mechanism()->inverse(X_BT, {}, axes) != kinematics::SolveStatus::ok)
    throw std::logic_error("out of reach");
  return axes;
}

/// Where the geometry has the tool when its struts are so much longer than commanded.
Pose forward_at(const machine::MachineDescription& machine, const kinematics::HexapodGeometry& geometry,
                const std::vector<double>& axes, const StrutLengths& longer, const Pose& near) {
  StrutLengths lengths;
  for (std::size_t i = 0; i < 6; ++i)
    lengths[i] =
        axes[i] - machine.hexapod().geometry.length_offset[i] + geometry.length_offset[i] + longer[i];
  const auto reached = kinematics::forward(geometry, lengths, near);
  EXPECT_EQ(reached.status, kinematics::SolveStatus::ok);
  return machine.X_WB * reached.X_BT;
}

StrutLengths alike(double by) {
  StrutLengths lengths;
  lengths.fill(by);
  return lengths;
}

double apart(const Pose& a, const Pose& b) { return (a.translation() - b.translation()).norm(); }

std::vector<Pose> some_poses(const machine::MachineDescription& machine, std::size_t count) {
  Random random(4, "session poses");
  return calibration::random_reachable_poses(*machine.make_mechanism(),
                                             calibration::reference_region(machine.X_BT_home), count, random);
}

SessionOptions ideal() {
  SessionOptions options;
  options.gravity = options.play = options.microsteps = false;
  return options;
}

// 1e-9: the chord steps of the plant end at 1e-12 of a strut's length.
TEST(PlantSession, WithoutPlayGravityAndStepsThePoseIsThatOfForwardKinematics) {
  const auto machine = hexapod();
  sim::AsBuilt built = sim::make_as_built(machine, "manufactured", 5);
  built.drives = {};
  PlantSession session(machine, built, ideal());
  for (const Pose& X_BT : some_poses(machine, 5)) {
    const auto axes = lengths_at(machine, X_BT);
    EXPECT_LT(apart(session.visit(axes), forward_at(machine, built.hexapod, axes, {}, X_BT)), 1e-9);
  }
}

// At home every strut of the hanging platform pulls: each is longer by half of its play.
TEST(PlantSession, PulledStrutsAreLongerByHalfTheirPlay) {
  const auto machine = hexapod();
  SessionOptions options = ideal();
  options.gravity = options.play = true;
  PlantSession session(machine, sim::as_described(machine), options);
  const auto axes = lengths_at(machine, machine.X_BT_home);
  // The ball's play acts along the joints' connection, off the screw by asin(dev / distance): 1.003.
  const double play = 50e-6 + 1.003 * 25e-6;
  const Pose expected =
      forward_at(machine, machine.hexapod().geometry, axes, alike(play / 2), machine.X_BT_home);
  const Pose found = session.visit(axes);
  EXPECT_GT(apart(found, machine.X_WB * machine.X_BT_home), 30e-6);
  EXPECT_LT(apart(found, expected), 0.1e-6);
}

// Six struts alike carry platform and nuts: each m g / (6 n_z), n the slope of its length.
TEST(PlantSession, StrutsSagByTheirLoadOverTheStiffnessOfTheirDrives) {
  auto machine = hexapod();
  machine.hexapod().masses.motor = 0;
  constexpr double kStiffness = 1e5;  // [N/m]
  for (std::size_t i = 0; i < 6; ++i) machine.drives[i].stiffness = kStiffness;
  SessionOptions options = ideal();
  options.gravity = true;
  PlantSession session(machine, sim::as_described(machine), options);
  const auto axes = lengths_at(machine, machine.X_BT_home);
  Mat6 J;
  ASSERT_EQ(kinematics::jacobian(machine.hexapod().geometry, machine.X_BT_home, J),
            kinematics::SolveStatus::ok);
  const auto& masses = machine.hexapod().masses;
  const double force = (masses.platform + 6 * masses.nut) * kGravity / (6 * std::abs(J(0, 2)));
  const Pose expected =
      forward_at(machine, machine.hexapod().geometry, axes, alike(force / kStiffness), machine.X_BT_home);
  const Pose found = session.visit(axes);
  EXPECT_GT(apart(found, machine.X_WB * machine.X_BT_home), 5e-6);
  EXPECT_LT(apart(found, expected), 0.01 * apart(found, machine.X_WB * machine.X_BT_home));
}

TEST(PlantSession, DrivesStopAtWholeMicrosteps) {
  const auto machine = hexapod();
  SessionOptions options = ideal();
  options.microsteps = true;
  PlantSession session(machine, sim::as_described(machine), options);
  const double step = machine.drives[0].step();
  EXPECT_NEAR(step, 1.5875e-3 / 3200, 1e-15);
  const Pose X_BT = some_poses(machine, 1)[0];
  const auto axes = lengths_at(machine, X_BT);
  StrutLengths off;
  for (std::size_t i = 0; i < 6; ++i) {
    const double displacement = axes[i] - 170e-3;
    off[i] = step * std::round(displacement / step) - displacement;
  }
  EXPECT_LT(apart(session.visit(axes), forward_at(machine, machine.hexapod().geometry, axes, off, X_BT)),
            1e-9);
}

TEST(PlantSession, ScrewsGrowWhileTheSessionLasts) {
  const auto machine = hexapod();
  SessionOptions options = ideal();
  options.growth = 50e-6;
  options.warming_time = 4;
  PlantSession session(machine, sim::as_described(machine), options);
  const auto axes = lengths_at(machine, machine.X_BT_home);
  for (int n = 0; n < 12; ++n) {
    const Pose found = session.visit(axes);
    const double grown = 50e-6 * (1 - std::exp(-session.now() / 4));
    // Straight lines of a tenth of the time constant stay within 0.1^2 / 8 of the exponential; a step is 2
    // ms.
    EXPECT_LT(
        apart(found, forward_at(machine, machine.hexapod().geometry, axes, alike(grown), machine.X_BT_home)),
        0.2e-6)
        << session.now();
  }
  EXPECT_GT(session.now(), 4);
}

// What the controller reckons of loads decides the side that the plant finds: wherever it says one.
TEST(PlantSession, PlaysRestWhereTheControllerSaysTheyDo) {
  const auto machine = hexapod();
  SessionOptions options = ideal();
  options.gravity = options.play = true;
  PlantSession session(machine, sim::as_described(machine), options);
  const auto& geometry = machine.hexapod().geometry;
  int told = 0, pushed = 0;
  for (const Pose& X_BT : some_poses(machine, 40)) {
    const auto sides = calibration::resting_sides(machine, geometry, {}, X_BT);
    StrutLengths longer;
    bool known = true;
    for (std::size_t i = 0; i < 6; ++i) {
      known = known && sides[i] != calibration::Approach::unknown;
      pushed += sides[i] == calibration::Approach::lengthening;
      longer[i] = -0.5 * 75.1e-6 * static_cast<double>(sides[i]);
    }
    if (!known) continue;
    ++told;
    const auto axes = lengths_at(machine, X_BT);
    EXPECT_LT(apart(session.visit(axes), forward_at(machine, geometry, axes, longer, X_BT)), 1e-6);
  }
  EXPECT_GT(told, 15);
  EXPECT_GT(pushed, 20);
}

TEST(PlantSession, MujocoRestsWhereTheQuasistaticPlantDoes) {
  const auto machine = hexapod();
  const sim::AsBuilt built = sim::make_as_built(machine, "manufactured", 3);
  SessionOptions options;
  PlantSession quasistatic(machine, built, options);
  options.engine = "mujoco";
  PlantSession mujoco(machine, built, options);
  const auto axes = lengths_at(machine, machine.X_BT_home);
  // The compliance of the engine's constraints (docs/engine-agreement.md).
  EXPECT_LT(apart(quasistatic.visit(axes), mujoco.visit(axes)), 2e-6);
}

TEST(PlantSession, RefusesWhatCannotBeDrivenTo) {
  const auto machine = hexapod();
  PlantSession session(machine, sim::as_described(machine), {});
  EXPECT_THROW(session.visit(std::vector<double>(6, 0.3)), InputError);
  SessionOptions unknown;
  unknown.engine = "steam";
  EXPECT_THROW(PlantSession(machine, sim::as_described(machine), unknown), InputError);
}

}  // namespace
}  // namespace understudy::studies
