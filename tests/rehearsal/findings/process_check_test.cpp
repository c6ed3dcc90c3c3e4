#include "rehearsal/findings/process_check.h"

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "rehearsal/fixture.h"
#include "tests/geometry/test_solids.h"
#include "tests/temporary_folder.h"
#include "toolpath/gcode/gcode.h"

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& text, const std::string& material = "abs") {
  const auto machine = machine::load_machine("hexapod");
  toolpath::GcodeOptions options;
  options.X_WT_home = machine.X_WB * machine.X_BT_home;
  const auto program = toolpath::parse_gcode(text, "p.gcode", options);
  try {
    check_process(program, machine, machine::load_material(material));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ProcessCheck, ExtrusionBeforeAnyTemperatureNamesTheLine) {
  EXPECT_THAT(refusal("G1 X5 E0.2 F300\n"), HasSubstr("p.gcode:1: extrudes before any nozzle temperature"));
  EXPECT_EQ(refusal("M109 S230\nG1 X5 E0.2 F300\n"), "accepted");
  EXPECT_EQ(refusal("G1 X5 F300\n"), "accepted") << "travel needs no heat";
}

// ABS is solid below 105 C, PLA below 60 C (docs/reference.md#cooling).
TEST(ProcessCheck, ExtrusionOfSolidMaterialNamesTemperatureAndLimit) {
  EXPECT_THAT(
      refusal("M104 S90\nG1 X5 E0.2 F300\n"),
      HasSubstr("p.gcode:2: extrudes at 90.0 C, where abs is solid: its glass transition is at 105.0 C"));
  EXPECT_EQ(refusal("M104 S90\nG1 X5 E0.2 F300\n", "pla"), "accepted");
}

// 1.75 mm filament has 2.405 mm2; five bores of 0.4 mm squared are 4 mm2.
std::vector<Finding> temperatures(const std::string& text) {
  return temperature_findings(toolpath::parse_gcode(text, "p.gcode", {}), machine::load_material("pla"));
}

// PLA is printed at 180 to 240 C.
TEST(ProcessCheck, ANozzleThatIsFortyKelvinTooColdIsAnError) {
  EXPECT_TRUE(temperatures("M109 S180\nG1 X5 E0.2 F300\nM104 S240\nG1 X9 E0.4\nM104 S0\nG1 X0\n").empty());
  const auto cold = temperatures("M109 S160\nG1 X5 E0.2 F300\nM104 S170\nG1 X9 E0.4\n");
  ASSERT_EQ(cold.size(), 1u);
  EXPECT_EQ(cold[0].severity, Severity::error);
  EXPECT_EQ(cold[0].gcode_line, 2);
  EXPECT_EQ(cold[0].last_line, 4);
  EXPECT_NEAR(cold[0].value, 160, 1e-9);
  EXPECT_THAT(cold[0].message,
              HasSubstr("160 C, below the lowest temperature at which pla is printed: 180 C"));
}

TEST(ProcessCheck, AHotNozzleIsAWarning) {
  const auto hot = temperatures("M109 S260\nG1 X5 E0.2 F300\n");
  ASSERT_EQ(hot.size(), 1u);
  EXPECT_EQ(hot[0].severity, Severity::warning);
}

TEST(ProcessCheck, AnAbsurdFlowNamesTheBead) {
  EXPECT_THAT(refusal("M104 S230\nG1 X10 E20 F300\n"), HasSubstr("a bead of 4.81 mm2, more than 4.00 mm2"));
  EXPECT_EQ(refusal("M104 S230\nG1 X10 E16 F300\n"), "accepted");
}

TEST(ProcessCheck, APrimeAtAStandstillIsNoBead) {
  EXPECT_EQ(refusal("M104 S230\nG1 E30 F300\nG1 X10 E31\n"), "accepted");
  EXPECT_THAT(refusal("M104 S230\nG1 E130 F300\n"), HasSubstr("more than 100 mm"));
}

TEST(ProcessCheck, WhatARetractionTookBackIsNotCountedTwice) {
  EXPECT_EQ(refusal("M104 S230\nG1 E10 F300\nG1 E2\nG1 X2 E10.1\n"), "accepted");
}

TEST(ProcessCheck, FilamentDrawnOutOfTheHotEndIsRefused) {
  EXPECT_THAT(refusal("M104 S230\nG1 X10 E1 F300\nG1 X20 E-59\n"),
              HasSubstr("p.gcode:3: 60.00 mm of filament are drawn back, more than 50 mm"));
}

struct Mended {
  toolpath::Program program;
  std::vector<Finding> findings;
};

Mended mended(const std::string& text) {
  const auto machine = machine::load_machine("hexapod");
  toolpath::GcodeOptions options;
  options.X_WT_home = machine.X_WB * machine.X_BT_home;
  Mended result{toolpath::parse_gcode(text, "p.gcode", options), {}};
  result.findings = mend_process(result.program, machine, machine::load_material("abs"));
  return result;
}

std::vector<double> filament_mm(const toolpath::Program& program) {
  std::vector<double> all;
  for (const toolpath::Step& step : program.steps)
    if (toolpath::moves(step)) all.push_back(std::round(1e6 * to_mm(step.filament)) / 1e6);
  return all;
}

// 20 mm of filament on 10 mm are a bead of 4.81 mm2.
TEST(MendProcess, OneThickBeadIsAFindingAndTheOthersStay) {
  const Mended m = mended("M104 S230\nM83\nG1 X10 E1 F300\nG1 X20 E20\nG1 X30 E1\n");
  ASSERT_EQ(m.findings.size(), 1u);
  EXPECT_EQ(m.findings[0].kind, "program");
  EXPECT_EQ(m.findings[0].severity, Severity::error);
  EXPECT_EQ(m.findings[0].gcode_line, 4);
  EXPECT_NEAR(m.findings[0].value, 20 * 2.405 / 10, 0.001);
  EXPECT_NEAR(m.findings[0].limit, 4, 1e-9);
  EXPECT_EQ(m.findings[0].unit, "mm2");
  EXPECT_THAT(m.findings[0].message, testing::EndsWith("; simulated without this filament"));
  EXPECT_EQ(filament_mm(m.program), (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(m.program.steps[2].kind, toolpath::StepKind::move);
}

TEST(MendProcess, WhatWasDrawnBackIsStillPushedBack) {
  const Mended m = mended("M104 S230\nM83\nG1 X10 E1 F300\nG1 E-2\nG1 X20 E22\nG1 X30 E1\n");
  EXPECT_EQ(m.findings.size(), 1u);
  EXPECT_EQ(filament_mm(m.program), (std::vector<double>{1, -2, 2, 1}));
}

TEST(MendProcess, OfALongRetractionOnlyWhatTheHotEndHoldsIsMade) {
  const Mended m = mended("M104 S230\nM83\nG1 X10 E1 F300\nG1 E-60\nG1 E60\nG1 X20 E1\n");
  ASSERT_EQ(m.findings.size(), 1u);
  EXPECT_EQ(m.findings[0].gcode_line, 4);
  EXPECT_EQ(filament_mm(m.program), (std::vector<double>{1, -50, 50, 1}));
}

TEST(MendProcess, SolidFilamentIsNotFed) {
  const Mended m =
      mended("M104 S230\nM83\nG1 X10 E1 F300\nM104 S90\nG1 X20 E1\nG1 X30 E1\nM104 S230\nG1 X40 E1\n");
  ASSERT_EQ(m.findings.size(), 1u);
  EXPECT_EQ(m.findings[0].gcode_line, 5);
  EXPECT_EQ(m.findings[0].last_line, 6);
  EXPECT_EQ(m.findings[0].unit, "C");
  EXPECT_EQ(filament_mm(m.program), (std::vector<double>{1, 0, 0, 1}));
}

TEST(MendProcess, WhatLeavesNothingOrIsEverywhereIsRefusedAsAWhole) {
  EXPECT_THROW(mended("M104 S230\nG1 X10 E20 F300\n"), InputError);
  EXPECT_THROW(mended("G1 X5 E0.2 F300\n"), InputError) << "no temperature";
  std::string text = "M104 S230\nM83\nG1 X1 E.01 F300\n";
  for (int i = 0; i <= static_cast<int>(kMostFaults); ++i)
    text += "G1 X" + std::to_string(i % 2) + " E9\n" + std::string(9, '\n');
  EXPECT_THROW(mended(text), InputError);
  EXPECT_THAT(
      refusal("M104 S230\nM83\nG1 X9 E1 F300\nG1 X19 E20\n\n\n\n\nG1 X29 E30\n"),
      HasSubstr("p.gcode:4: feeds 20.000 mm of filament over 10.000 mm: a bead of 4.81 mm2, more than "
                "4.00 mm2 (5 bores of 0.4 mm wide and high); line 9: feeds 30.000 mm"));
}

class Fixture : public testing::Test {
 protected:
  std::string refusal_of_box(const Vec3& low, const Vec3& high) {
    const geometry::Triangles box = geometry::box(low, high);
    const geometry::Mesh mesh(box.vertices, box.triangles);
    std::ofstream(path_, std::ios::binary) << geometry::write_stl(mesh, "box");
    try {
      read_fixture(path_.string(), machine::load_machine("hexapod"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "fixture.stl";
};

TEST_F(Fixture, StandsOnTheTable) {
  EXPECT_EQ(refusal_of_box({-0.01, -0.01, 0}, {0.01, 0.01, 0.02}), "accepted");
  EXPECT_THAT(refusal_of_box({-0.01, -0.01, -0.003}, {0.01, 0.01, 0.02}),
              HasSubstr("reaches 3.000 mm below the table's top"));
}

// The hexapod's home tip is 50 mm above the table.
TEST_F(Fixture, DoesNotStandWhereTheMachineIsAtHome) {
  EXPECT_THAT(refusal_of_box({-0.01, -0.01, 0}, {0.01, 0.01, 0.06}),
              HasSubstr("stands where the nozzle of hexapod is at home"));
}

}  // namespace
}  // namespace understudy::rehearsal
