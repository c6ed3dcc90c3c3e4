#include "control/registration/register_part.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "control/registration/moved_program.h"
#include "tests/control/gap/bead_program.h"
#include "tests/geometry/test_solids.h"

namespace understudy::control {
namespace {

using ::testing::HasSubstr;

const PartTolerance kTolerance{0.2e-3, 2e-3, 0};
constexpr double kTop = 20e-3;  // [m]

std::shared_ptr<const geometry::Mesh> slab() {
  const auto box = geometry::box({-20e-3, -20e-3, 0}, {20e-3, 20e-3, kTop});
  return std::make_shared<geometry::Mesh>(box.vertices, box.triangles);
}

/// Its mounting is known to nothing, so that what the sensor's drawing leaves does not hide what is tested.
machine::MachineDescription sure_machine() {
  machine::MachineDescription machine = hexapod();
  machine.tolerances.mounting.reset();
  return machine;
}

RegistrationTask slab_task(const machine::MachineDescription& machine) {
  RegistrationTask task;
  task.part = slab();
  task.tolerance = kTolerance;
  task.place_sigma = 3e-6;
  const ProbingCheck check(machine, *task.part, largest_shift(*task.part, kTolerance));
  task.places = choose_places(*task.part, kTolerance, check, {}, 12);
  task.wanted = 9;
  return task;
}

/// The slab's top where it truly is: 0.3 mm low, and leaning.
const Vec3 kNormal = Vec3(3e-3, -2e-3, 1).normalized();
GapRigOptions leaning() {
  GapRigOptions options;
  options.world = plane_through(Vec3(0, 0, kTop - 0.3e-3), kNormal);
  return options;
}

TEST(RegisterPart, FindsASlabThatLeansAndEndsAtHome) {
  const auto machine = sure_machine();
  GapRig rig(machine, leaning());
  double least = 1;
  const Registration found = register_part(slab_task(machine), machine, rig.port());
  ASSERT_TRUE(found.good()) << found.refused << found.stop.why;
  EXPECT_EQ(found.measured(), 9);
  EXPECT_EQ(found.fit->seen, 3);
  // Where the top is found, against the plane that was drawn by the rig.
  for (const Vec3& corner : {Vec3(-18e-3, -18e-3, kTop), Vec3(18e-3, -18e-3, kTop), Vec3(0, 18e-3, kTop)}) {
    const double off = kNormal.dot(found.fit->X_W * corner - Vec3(0, 0, kTop - 0.3e-3));
    EXPECT_NEAR(off, 0, 15e-6);  // readings to 3 um each, at arms of 18 mm
  }
  for (const auto& setpoint : rig.port().history())
    least = std::min(least, rig.gap_at(rig.commanded(setpoint.position)));
  EXPECT_GT(least, 0.08e-3) << "never touches";
  EXPECT_LT((rig.commanded_now().translation() - (machine.X_WB * machine.X_BT_home).translation()).norm(),
            1e-6);
  EXPECT_GT(found.duration, 5);
}

TEST(RegisterPart, APlaceThatFailsIsReplacedAndNamed) {
  const auto machine = sure_machine();
  GapRig rig(machine, leaning());
  const RegistrationTask task = slab_task(machine);
  const Vec3 dark = task.places[2].p_W;
  rig.set_frame_fault([&](const Pose& X_WT, Image& image) {
    if ((X_WT.translation() - dark).head<2>().norm() < 1e-3)
      std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const Registration found = register_part(task, machine, rig.port());
  EXPECT_TRUE(found.good()) << found.refused;
  EXPECT_EQ(found.measured(), 9);
  ASSERT_EQ(found.places.size(), 10u);
  int failed = 0;
  for (const auto& place : found.places) {
    if (place.measured) continue;
    ++failed;
    EXPECT_EQ(place.place.p_W, dark);
    EXPECT_THAT(place.why, HasSubstr("no dot"));
  }
  EXPECT_EQ(failed, 1);
}

TEST(RegisterPart, FewerThanSixReadingsAreNoPose) {
  const auto machine = sure_machine();
  GapRig rig(machine, leaning());
  rig.set_frame_fault([&](const Pose& X_WT, Image& image) {
    if (X_WT.translation().head<2>().maxCoeff() > 0)
      std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{12});
    return true;
  });
  const Registration found = register_part(slab_task(machine), machine, rig.port());
  EXPECT_FALSE(found.good());
  EXPECT_LT(found.measured(), 6);
  EXPECT_THAT(found.refused, HasSubstr("at least 6"));
  EXPECT_THAT(found.refused, HasSubstr("no dot"));
}

// A drum lies where the slab should: no pose of the slab explains it.
TEST(RegisterPart, AnotherPartIsRefused) {
  const auto machine = sure_machine();
  GapRigOptions options;
  options.world = cylinder_around(Vec3(0, 0, kTop - 300e-3), Vec3::UnitY(), 300e-3);
  GapRig rig(machine, options);
  const Registration found = register_part(slab_task(machine), machine, rig.port());
  EXPECT_FALSE(found.good());
  EXPECT_THAT(found.refused, HasSubstr("do not fit the drawn part"));
}

TEST(RegisterPart, AFaultOfTheMachineEndsIt) {
  const auto machine = sure_machine();
  GapRig rig(machine, leaning());
  rig.port().inject_fault(machine::Fault::drive, 6.0);
  const Registration found = register_part(slab_task(machine), machine, rig.port());
  EXPECT_FALSE(found.good());
  EXPECT_TRUE(static_cast<bool>(found.stop));
  EXPECT_EQ(found.stop.fault, machine::Fault::drive);
}

// A sensor whose mounting is uncertain gives an error that all places share, as large as its calibration
// says.
TEST(RegisterPart, WhatTheMountingLeavesIsSharedByAllPlaces) {
  const auto machine = hexapod();
  const Eigen::VectorXd once = common_errors(machine, {}, 0.13e-3, 1);
  EXPECT_EQ(once.size(), machine::kMountingFreedoms);
  EXPECT_NEAR(once.norm(), 159e-6, 3e-6);  // docs/gap-sensor-calibration.md: 159 um as drawn
  EXPECT_EQ(common_errors(sure_machine(), {}, 0.13e-3, 1).size(), 0);
}

}  // namespace
}  // namespace understudy::control
