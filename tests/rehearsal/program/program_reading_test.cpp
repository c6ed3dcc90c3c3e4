#include "rehearsal/program/program_reading.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class ProgramReading : public testing::Test {
 protected:
  ReadProgram read(const std::string& text, bool strict = false) {
    RehearsalRequest request;
    request.program = (folder_ / "p.gcode").string();
    request.machine = "arm";
    request.dialect.strict = strict;
    write_file(request.program, text);
    return read_program(request, machine::load_machine("arm"));
  }
  TemporaryFolder folder_;
};

const std::string kBad =
    "M82\nG1 X10 Y0 Z9 E1 F600\nG1 X1.2.3 Y10 E2\nG1 X30 Y20 E3\nM106 S300\nG1 X40 E4 ; nozzle\n; "
    "layer_height = "
    "0.3\n";

TEST_F(ProgramReading, EachLineThatIsPassedOverIsAFindingOfItsOwn) {
  const ReadProgram bad = read(kBad);
  const std::vector<Finding> findings = findings_of(bad.passed_over);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].kind, "program");
  EXPECT_EQ(findings[0].severity, Severity::error);
  EXPECT_EQ(findings[0].gcode_line, 3);
  EXPECT_EQ(findings[0].last_line, 4);
  EXPECT_NEAR(findings[0].value, 2, 1e-9);
  EXPECT_EQ(findings[0].unit, "mm");
  EXPECT_EQ(
      findings[0].message,
      "line 3 cannot be read: 'X1.2.3': X needs a finite decimal number; passed over, with the moves up to "
      "line 4, because X of line 3 is not known, without 2.000 mm of filament");
  EXPECT_EQ(findings[1].message,
            "line 5 cannot be read: 'S300': the fan's speed is outside 0 to 255; passed over");
  EXPECT_NE(findings[0].about, findings[1].about) << "else one would speak for both";
  EXPECT_EQ(bad.facts.at("layer_height"), "0.3");
}

TEST_F(ProgramReading, StrictRefusesThemAllInOneLine) {
  try {
    read(kBad, true);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.gcode:3:4: 'X1.2.3'"));
    EXPECT_THAT(error.what(), HasSubstr("line 5: 'S300'"));
  }
  EXPECT_THAT(read("G1 X10 F600\n", true).passed_over, IsEmpty());
}

}  // namespace
}  // namespace understudy::rehearsal
