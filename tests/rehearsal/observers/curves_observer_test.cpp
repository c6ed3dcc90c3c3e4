#include "rehearsal/observers/curves_observer.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/sim/collision/bodies_for_tests.h"

namespace understudy::rehearsal {
namespace {

constexpr int kSnapshots = 10'000;
constexpr double kSpike = 77.5;  // [N], in one snapshot alone

machine::MachineDescription printer() {
  machine::MachineDescription machine;
  machine.tool.filament_diameter = 1.75e-3;
  machine.gap.accepted_max = 0.2e-3;
  return machine;
}

sim::Snapshot at(int k) {
  sim::Snapshot s;
  s.time = 1e-3 * k;
  s.drive_force[0] = std::sin(2e-3 * k) + (k == 4321 ? kSpike : 0);
  s.drive_force[5] = -k;
  s.nozzle_temperature = k < kSnapshots / 2 ? 0 : kCelsiusZero + 210;
  return s;
}

RunCurves observed(std::size_t capacity) {
  sim::DepositionObserver deposition(printer(), std::make_shared<sim::Workpiece>(nullptr));
  CurvesObserver curves(deposition, nullptr, 6, capacity);
  for (int k = 0; k < kSnapshots; ++k) {
    deposition.observe(at(k));
    curves.observe(at(k));
  }
  return curves.take();
}

TEST(CurvesObserver, OfEachStretchTheLeastAndTheMostAreThoseOfItsSnapshots) {
  const RunCurves curves = observed(1000);
  ASSERT_GE(curves.stretches.size(), 500u);
  ASSERT_LE(curves.stretches.size(), 1000u);
  int next = 0;
  for (const CurveStretch& stretch : curves.stretches) {
    const int first = next, last = static_cast<int>(std::lround(1e3 * stretch.end));
    EXPECT_NEAR(stretch.begin, 1e-3 * first, 1e-9);
    double low = 1e9, high = -1e9;
    for (int k = first; k <= last; ++k) {
      low = std::min(low, at(k).drive_force[0]);
      high = std::max(high, at(k).drive_force[0]);
    }
    EXPECT_FLOAT_EQ(stretch.force[0].low, static_cast<float>(low));
    EXPECT_FLOAT_EQ(stretch.force[0].high, static_cast<float>(high));
    EXPECT_FLOAT_EQ(stretch.force[5].low, static_cast<float>(-last));
    EXPECT_EQ(stretch.nozzle_temperature.empty(), last < kSnapshots / 2);
    next = last + 1;
  }
  EXPECT_EQ(next, kSnapshots);
}

TEST(CurvesObserver, AShortRunIsKeptSnapshotBySnapshot) {
  EXPECT_EQ(observed(kSnapshots).stretches.size(), static_cast<std::size_t>(kSnapshots));
}

TEST(CurvesObserver, WhatIsNotMeasuredStaysEmpty) {
  for (const CurveStretch& stretch : observed(100).stretches) {
    EXPECT_TRUE(stretch.interface_temperature.empty());
    EXPECT_TRUE(stretch.nozzle_clearance.empty());
  }
}

// The nozzle comes down to a plate and rises again: its height is its clearance.
TEST(CurvesObserver, ClearanceIsTheHeightAboveAPlate) {
  const auto machine = sim::test::hexapod();
  const auto plate = sim::test::box_mesh(Vec3(0, 0, 45e-3), Vec3(0.06, 0.06, 0.01));
  sim::DepositionObserver deposition(machine, std::make_shared<sim::Workpiece>(plate));
  sim::CollisionObserver collision(machine, sim::test::as_designed(machine), plate, {});
  CurvesObserver curves(deposition, &collision, 6);
  const auto height = [](int k) { return 0.2e-3 + 1e-6 * std::abs(k - 400); };
  for (int k = 0; k <= 800; ++k) {
    sim::Snapshot s;
    s.time = 1e-3 * k;
    s.X_WT.translation() = Vec3(0, 0, 50e-3 + height(k));
    deposition.observe(s);
    collision.observe(s);
    curves.observe(s);
  }
  int seen = 0;
  double least = 1;
  for (const CurveStretch& stretch : curves.take().stretches) {
    if (stretch.nozzle_clearance.empty()) continue;
    ++seen;
    // A look lies within the step of 1 um that leads to its snapshot.
    EXPECT_NEAR(static_cast<double>(stretch.nozzle_clearance.low),
                height(static_cast<int>(std::lround(1e3 * stretch.begin))), 1.01e-6);
    least = std::min(least, static_cast<double>(stretch.nozzle_clearance.low));
  }
  EXPECT_GE(seen, 3);
  EXPECT_FLOAT_EQ(static_cast<float>(least), static_cast<float>(collision.min_nozzle_clearance()));
}

}  // namespace
}  // namespace understudy::rehearsal
