#include "rehearsal/run_figures.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

class RunFigures : public testing::Test {
 protected:
  RunFigures() { machine_.tool = {0.4e-3, 1e-3, 1.75e-3, {}}; }
  /// [m^3] of so much filament of 1.75 mm.
  static double volume(double filament_mm) {
    return from_mm(filament_mm) * std::numbers::pi / 4 * 1.75e-3 * 1.75e-3;
  }
  machine::MachineDescription machine_;
};

// 130 mm planned when the machine stopped, 100 mm fed, 12 mm pushed back after retractions; of the 100, a
// blob of 3 mm and 1 mm still in the nozzle.
TEST_F(RunFigures, FilamentFedIsPrintedPurgedAndMissing) {
  TwinRun run;
  run.result.extruded = from_mm(130);
  run.deposition.extruded_volume = volume(100);
  run.result.primed = from_mm(12);
  run.deposition.laid_volume = volume(99);
  run.deposition.standstill_volume = volume(3);
  const PrintFigures print = print_figures(run, machine_);
  EXPECT_NEAR(print.extruded_mm, 100, 1e-9);
  EXPECT_NEAR(print.printed_mm, 96, 1e-9);
  EXPECT_NEAR(print.purged_mm, 3, 1e-9);
  EXPECT_NEAR(print.missing_mm, 1, 1e-9);
  EXPECT_NEAR(print.primed_mm, 12, 1e-9);
}

// A bridge over a hollow of the print hangs; a bead that begins in the air is neither laid on something nor
// held.
TEST_F(RunFigures, WhatHangsBetweenHoldsIsToldFromWhatIsLoose) {
  sim::UnsupportedStretch bridge;
  bridge.length = from_mm(5);
  bridge.volume = volume(0.4);
  bridge.worst_gap = from_mm(4);
  bridge.held_at_start = bridge.held_at_end = bridge.on_printed = true;
  sim::UnsupportedStretch loose = bridge;
  loose.held_at_start = false;
  TwinRun run;
  run.loose = {bridge, loose};
  EXPECT_NEAR(print_figures(run, machine_).spanning_mm, 0.4, 1e-9);
}

// One is drawn thinner; one has 21 % more material than leaves freely, which would be 10 % thicker: 0.48 to
// 0.528.
TEST_F(RunFigures, StrandsAreAsThickAsTheMaterialThatTheyHave) {
  TwinRun run;
  run.strands.resize(3);
  run.strands[0].diameter = run.strands[1].diameter = 0.48e-3;
  run.strands[1].overfeed = 0.21;
  run.strands[2].diameter = 0.45e-3;
  Record record;
  fill_figures(run, nullptr, machine_, record);
  ASSERT_TRUE(record.sag);
  EXPECT_EQ(record.sag->strands, 3);
  EXPECT_NEAR(record.sag->diameter_min_mm, 0.45, 1e-9);
  EXPECT_NEAR(record.sag->diameter_max_mm, 0.528, 1e-9);
}

}  // namespace
}  // namespace understudy::rehearsal
