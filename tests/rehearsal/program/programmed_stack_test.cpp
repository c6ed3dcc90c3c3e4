#include "rehearsal/program/programmed_stack.h"

#include <gtest/gtest.h>

#include "rehearsal/program/programmed_areas.h"
#include "tests/rehearsal/program/printer.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace {

TEST(ProgrammedStack, GrowsByTheHeightOfEachBead) {
  ProgrammedStack stack(printer(), nullptr);
  const Vec3 above(5e-3, 0, 0.5e-3);
  EXPECT_NEAR(stack.gap(above, Mat3::Identity()), 0.5e-3, 1e-9) << "the table";
  stack.add(Vec3(0, 0, 0.2e-3), Vec3(10e-3, 0, 0.2e-3), Vec3::UnitZ(), 0.2e-3, 0.1e-6, 1);
  stack.move(5e-3);
  EXPECT_NEAR(stack.gap(above, Mat3::Identity()), 0.3e-3, 1e-9);
  EXPECT_NEAR(stack.gap(above + Vec3(0, 1e-3, 0), Mat3::Identity()), 0.5e-3, 1e-9) << "beside it";
}

TEST(ProgrammedStack, WhatWasLaidLastIsUnderTheNozzle) {
  ProgrammedStack stack(printer(), nullptr);
  stack.add(Vec3(0, 0, 0.2e-3), Vec3(1e-3, 0, 0.2e-3), Vec3::UnitZ(), 0.2e-3, 0.1e-6, 1);
  stack.move(0.5e-3);
  EXPECT_NEAR(stack.gap(Vec3(0.5e-3, 0, 0.2e-3), Mat3::Identity()), 0.2e-3, 1e-9);
}

TEST(ProgrammedStack, LinesThatPrintAreLaidInOrderOnWhatWasLaidBefore) {
  const machine::MachineDescription machine = printer();
  const toolpath::Program program = toolpath::parse_gcode(
      "M83\nG1 F600\nG0 X0 Y0 Z0.2\nG1 X20 E2\nG0 X0 Y0 Z0.4\nG1 X20 E2\nG1 E-1\nG0 Z9\n", "p", {});
  std::vector<int> lines;
  std::vector<double> gaps;
  lay_program(program, machine, nullptr, programmed_areas(program, machine),
              [&](const ProgrammedLine& laid, const ProgrammedStack& stack) {
                lines.push_back(laid.line);
                gaps.push_back(stack.gap(0.5 * (laid.from_W + laid.to_W), laid.R));
                EXPECT_NEAR(laid.length, 20e-3, 1e-12);
                EXPECT_NEAR(laid.area, 0.1e-6, 1e-12) << "2 mm3 on 20 mm";
                return gaps.back();
              });
  ASSERT_EQ(lines, (std::vector<int>{4, 6}));
  EXPECT_NEAR(gaps[0], 0.2e-3, 1e-9);
  EXPECT_NEAR(gaps[1], 0.2e-3, 1e-9);
}

}  // namespace
}  // namespace understudy::rehearsal
