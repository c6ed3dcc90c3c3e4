#include "rehearsal/observers/flow_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace {

constexpr double kSpeed = 10e-3;  // [m/s]

// Filament of 1 mm2; 5 mm of path take 1 mm of it.
machine::MachineDescription printer(double lag) {
  machine::MachineDescription machine;
  machine.tool.filament_diameter = std::sqrt(4 / std::numbers::pi) * 1e-3;
  machine.tool.flat_diameter = 1e-3;
  machine.process.extruder_lag = lag;
  machine.gap.accepted_min = 0.1e-3;
  machine.gap.accepted_max = machine.gap.aim = 0.3e-3;
  return machine;
}

std::vector<FlowStretch> watch(const machine::MachineDescription& machine) {
  const auto program = toolpath::parse_gcode("G1 X0 Y0 Z0.2 F600\nG1 X20 E4\n", "p", {});
  FlowWatch flow(program, machine);
  sim::DepositionOptions options;
  options.laid = [&](const sim::LaidBead& bead) { flow.add(bead); };
  sim::DepositionObserver deposition(machine, std::make_shared<sim::Workpiece>(nullptr), options);
  for (int k = 0; k <= 1000; ++k) {
    sim::Snapshot s;
    s.time = k * 2e-3;
    s.X_WT.translation() = Vec3(kSpeed * s.time, 0, 0.2e-3);
    s.filament = 0.2 * kSpeed * s.time;
    s.line = 2;
    deposition.observe(s);
  }
  deposition.finish();
  return flow.stretches();
}

TEST(FlowWatch, FlowAsProgrammedIsNoFinding) { EXPECT_TRUE(watch(printer(0)).empty()); }

// From rest the flow is 1 - exp(-t / lag) of what is asked: below 0.8 until lag ln 5.
TEST(FlowWatch, ALaggingExtruderLaysTooLittleAfterTheStart) {
  constexpr double kLag = 0.2;
  const auto stretches = watch(printer(kLag));
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_EQ(stretches[0].line, 2);
  EXPECT_NEAR(stretches[0].length, kSpeed * kLag * std::log(5), 0.15e-3) << "to within an element";
  EXPECT_LT(stretches[0].ratio, 0.1);
  // Missing until then: lag (1 - 1/5); an element more or less at the end has a fifth of its length missing.
  EXPECT_NEAR(stretches[0].amount, -0.8 * kSpeed * kLag, 0.2 * 0.15e-3);
  // What was missing at the start still pressed when the drive stopped, and stays at the end: the flow's
  // deficit is the lag's worth of path, whatever the length of the element it ends up in.
  EXPECT_GT(stretches[1].ratio, 1);
  EXPECT_NEAR(stretches[1].amount, kSpeed * kLag, 0.05 * kSpeed * kLag);
}

}  // namespace
}  // namespace understudy::rehearsal
