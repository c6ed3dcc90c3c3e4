#include "rehearsal/program/programmed_areas.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace {

// Filament of 1 mm2: E over path is the cross-section in mm2.
std::vector<float> areas_of(const char* text) {
  machine::MachineDescription machine;
  machine.tool.filament_diameter = std::sqrt(4 / std::numbers::pi) * 1e-3;
  return programmed_areas(toolpath::parse_gcode(text, "p", {}), machine);
}

TEST(ProgrammedAreas, AreFilamentOverPathByLine) {
  const auto areas = areas_of("M83\nG1 X0 Y0 Z1 F600\nG1 X10 E2\nG1 Y5 E0.5\n");
  EXPECT_EQ(areas[2], 0);
  EXPECT_NEAR(areas[3], 0.2e-6, 1e-12);
  EXPECT_NEAR(areas[4], 0.1e-6, 1e-12);
}

TEST(ProgrammedAreas, WhatFillsTheNozzleAgainIsNoBead) {
  const auto areas = areas_of("M83\nG1 X0 Y0 Z1 F600\nG1 X10 E2\nG1 E-1\nG1 X20 E1\nG1 X30 E2\n");
  EXPECT_EQ(areas[5], 0);
  EXPECT_NEAR(areas[6], 0.2e-6, 1e-12);
}

}  // namespace
}  // namespace understudy::rehearsal
