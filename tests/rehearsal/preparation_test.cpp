#include "rehearsal/preparation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "machine/description.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& word, const machine::MachineDescription& machine) {
  try {
    gap_control_of(word, machine);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Preparation, TheGapIsControlledByAMachineThatCanSeeIt) {
  const auto seeing = machine::load_machine("hexapod"), blind = machine::load_machine("corexy");
  EXPECT_EQ(gap_control_of("", seeing), control::GapControl::start);
  EXPECT_EQ(gap_control_of("continuous", seeing), control::GapControl::continuous);
  EXPECT_EQ(gap_control_of("off", seeing), control::GapControl::off);
  EXPECT_EQ(gap_control_of("", blind), control::GapControl::off);
  EXPECT_THAT(refusal("start", blind), HasSubstr("needs a laser and a microscope; corexy has none: off"));
  EXPECT_THAT(refusal("always", seeing), HasSubstr("one of off, start, continuous"));
}

/// What the slicer says, and what cannot be read, go on to the findings.
TEST(Preparation, FactsAndLinesThatArePassedOverAreKept) {
  const TemporaryFolder folder;
  RehearsalRequest request;
  request.machine = "corexy";
  request.program = (folder / "p.gcode").string();
  request.engine = "quasistatic";
  write_file(
      request.program,
      "; nozzle_diameter = 0.8\nM104 S205\nM83\nG1 X1 Y0 Z0.2 F600\nG1 X2 Q5\n;TYPE:Skirt\nG1 X3 E0.1\n");
  Mended mended;
  const TwinSetup setup = prepare(request, mended);
  EXPECT_EQ(setup.program.steps.back().line, 7);
  EXPECT_EQ(mended.facts.at("nozzle_diameter"), "0.8");
  EXPECT_EQ(mended.features.at(7), "Skirt");
  ASSERT_EQ(mended.passed_over.size(), 1u);
  EXPECT_EQ(mended.passed_over[0].first, 5);
  ASSERT_GE(mended.findings.size(), 2u);  // the line, and the nozzle
  EXPECT_EQ(mended.findings[0].gcode_line, 5);
  EXPECT_THAT(mended.findings.back().message, HasSubstr("sliced for a nozzle of 0.8 mm"));
}

}  // namespace
}  // namespace understudy::rehearsal
