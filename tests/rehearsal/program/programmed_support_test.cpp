#include "rehearsal/program/programmed_support.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/rehearsal/program/printer.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace {

constexpr int kBelow = 4, kAbove = 6;  // lines of the file

/// A line of 20 mm along x on the table, and from `begin` to 20 mm another 0.13 mm above it [mm].
toolpath::Program two_lines(double begin = 0, double height = 0.26) {
  const std::string text =
      fmt::format("M83\nG1 F600\nG0 X{} Y0 Z0.13\nG1 X20 E1.12\nG0 X0 Y0 Z{}\nG1 X20 E1.12\n", begin, height);
  return toolpath::parse_gcode(text, "p", {});
}

/// In truth, `length` [mm] from x = 5 mm on lay 0.21 mm over what was below; both ends are held.
sim::UnsupportedStretch hanging(double length, int line = kAbove) {
  sim::UnsupportedStretch stretch;
  stretch.line = line;
  stretch.lines = {line, line};
  stretch.length = from_mm(length);
  stretch.volume = stretch.length * 0.056e-6;
  stretch.width = 0.43e-3;
  stretch.worst_gap = 0.21e-3;
  stretch.highest_gap = 0.2e-3;
  stretch.held_at_start = stretch.held_at_end = stretch.on_printed = true;
  const double z = line == kAbove ? 0.3e-3 : 0.2e-3, side = 0.15e-3;
  stretch.path_W = {Vec3(5e-3, side, z), Vec3(5e-3 + stretch.length, side, z)};
  return stretch;
}

std::vector<Finding> findings(const toolpath::Program& program, const sim::UnsupportedStretch& stretch) {
  const machine::MachineDescription machine = printer();
  const ProgrammedLayers layers(program, machine, nullptr);
  return support_findings({program, layers, machine, nullptr}, {stretch});
}

TEST(ProgrammedSupport, IsThePathThatTheProgramLaysOnSomething) {
  const machine::MachineDescription machine = printer();
  const auto support = [&](const toolpath::Program& program, double length) {
    const ProgrammedLayers layers(program, machine, nullptr);
    return programmed_support({program, layers, machine, nullptr}, {hanging(length)}).at(0);
  };
  EXPECT_NEAR(support(two_lines(), 2), 2e-3, 1e-9);
  EXPECT_NEAR(support(two_lines(6), 2), 1e-3, 0.25e-3)
      << "the line below begins in the middle, with a round end";
  EXPECT_EQ(support(two_lines(8), 2), 0) << "0.26 mm over the table";
  EXPECT_EQ(support(two_lines(0, 1.0), 2), 0) << "0.87 mm over the line below";
}

TEST(ProgrammedSupport, WhatHangsThereIsAnErrorBeyondTwoBores) {
  EXPECT_TRUE(findings(two_lines(), hanging(0.79)).empty());
  const auto found = findings(two_lines(), hanging(1.4));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].severity, Severity::error);
  EXPECT_EQ(found[0].kind, "adhesion");
  EXPECT_EQ(found[0].about, kLifted);
  EXPECT_EQ(found[0].gcode_line, kAbove);
  EXPECT_NEAR(found[0].value, 0.21, 1e-12);
  EXPECT_NEAR(found[0].limit, 0.2, 1e-12);
  EXPECT_THAT(found[0].message, testing::HasSubstr("1.40 mm hangs where the program lays it on something"));
}

// Where a drop falls over the first 0.13 mm of a line, 0.92 mm of it are not where they should be.
TEST(ProgrammedSupport, WhereADropFallsNothingLiesEither) {
  const auto after = [](double bare) {
    sim::UnsupportedStretch stretch = hanging(0.79);
    stretch.place_W = Vec3(5e-3, 0, 0.3e-3);
    stretch.bare_before = {from_mm(bare), stretch.place_W - Vec3(from_mm(bare), 0, 0), kAbove};
    return stretch;
  };
  EXPECT_TRUE(findings(two_lines(), after(0.005)).empty());
  const auto found = findings(two_lines(), after(0.13));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].message, testing::HasSubstr("line of 0.92 mm, without a bead for the first 0.13 mm,"));
  EXPECT_TRUE(findings(two_lines(5.3), after(1)).empty()) << "below the bare path there was to be nothing";
}

TEST(ProgrammedSupport, ABridgeOfTheProgramMayHang) {
  EXPECT_TRUE(findings(two_lines(8), hanging(2)).empty());
  EXPECT_TRUE(findings(two_lines(0, 1.0), hanging(2)).empty());
}

// Of a line that is told by its number: the same place is on the table by another.
TEST(ProgrammedSupport, IsThatOfItsOwnLine) {
  EXPECT_EQ(findings(two_lines(0, 1.0), hanging(2, kBelow)).size(), 1u) << "on the table";
}

TEST(ProgrammedSupport, OneThatDoesNotStickIsJudgedElsewhere) {
  sim::UnsupportedStretch loose = hanging(2);
  loose.held_at_start = loose.held_at_end = false;
  EXPECT_TRUE(findings(two_lines(), loose).empty()) << "nothing holds it: Findings says so";
}

}  // namespace
}  // namespace understudy::rehearsal
