// Programs with lines that cannot be read or made: what a whole rehearsal says of the rest.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "rehearsal/findings/verdict.h"
#include "rehearsal/rehearse.h"
#include "tests/temporary_folder.h"

namespace understudy::rehearsal {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Pair;

class PassedOverRehearsal : public testing::Test {
 protected:
  RehearsalRequest request(const std::string& text, const char* machine = "five-axis") {
    RehearsalRequest request;
    request.program = (folder_ / "p.gcode").string();
    write_file(request.program, text);
    request.machine = machine;
    request.engine = "quasistatic";
    request.as_built = "nominal";
    request.keep_scene = false;
    return request;
  }
  Record record(const std::string& text, const char* machine = "five-axis") {
    return rehearse(request(text, machine));
  }
  TemporaryFolder folder_;
};

const std::string kHead = "G21\nG90\nM82\nM109 S210\nG0 X0 Y0 Z10\nG1 X0 Y0 Z0.16 F600\n";
const std::string kBead = "G1 X0 Y20 E0.7 F300\n";

TEST_F(PassedOverRehearsal, TheRestIsRehearsedAsIfTheLinesWereNotThere) {
  const Record whole = record(kHead + kBead + "G1 X3\n");  // what is left of the bad one
  EXPECT_TRUE(whole.go);
  EXPECT_THAT(whole.passed_over, testing::IsEmpty());
  const std::string bad = kHead + "M106 S300\n" + kBead + "G1 X3 E90\nG1 X1.2.3 Y30 Z50 E91\nG0 Z60\n";
  const Record rest = record(bad);
  EXPECT_FALSE(rest.go);
  EXPECT_THAT(rest.passed_over, ElementsAre(Pair(7, 7), Pair(10, 11)));
  ASSERT_GE(rest.findings.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(rest.findings[static_cast<std::size_t>(i)].kind, "program");
  EXPECT_EQ(rest.findings[1].unit, "mm2");
  ASSERT_TRUE(whole.gap && rest.gap && whole.print && rest.print);
  EXPECT_EQ(rest.gap->path_mean_mm, whole.gap->path_mean_mm);
  EXPECT_EQ(rest.print->printed_mm, whole.print->printed_mm);
  EXPECT_EQ(rest.print->extruded_mm, whole.print->extruded_mm) << "no filament of lines that are passed over";
  EXPECT_THAT(verdict_sentence(rest), HasSubstr("Line 7 cannot be read"));
  EXPECT_THAT(verdict_sentence(rest),
              EndsWith("All figures are of the program without lines 7 and 10 to 11."));

  RehearsalRequest strict = request(bad);
  strict.dialect.strict = true;
  EXPECT_THROW(rehearse(strict), InputError);
}

// Before, the print ended at the first pose that no axes reach.
TEST_F(PassedOverRehearsal, WhatComesAfterAnUnreachableMoveIsRehearsed) {
  const std::string head = "G21\nG90\nM83\nM109 S210\nG0 X0 Y0 Z10\nG1 X0 Y0 Z0.16 F600\n";
  const Record whole = record(head + "G1 X0 Y20 E0.7 F300\nG1 X0 Y30 E0.35\n", "arm");
  const Record rest = record(head + "G1 X0 Y20 E0.7 F300\nG0 X5000\nG0 X0\nG1 X0 Y30 E0.35\n", "arm");
  EXPECT_FALSE(rest.go);
  EXPECT_THAT(rest.passed_over, ElementsAre(Pair(8, 9)));
  ASSERT_TRUE(whole.print && rest.print);
  EXPECT_NEAR(rest.print->printed_mm, whole.print->printed_mm, 0.02 * whole.print->printed_mm);
  for (const Finding& finding : rest.findings)
    EXPECT_THAT(finding.about, testing::Ne(std::string(kStopped))) << finding.message;
}

TEST_F(PassedOverRehearsal, TheNozzleOfTheRequestIsMounted) {
  const std::string thick =
      "M83\nM109 S210\nG0 X0 Y0 Z10\nG1 X0 Y0 Z0.4 F600\nG1 X0 Y20 E9 F300\nG1 Y21 E1\n";
  RehearsalRequest wide = request(thick + "G1 Y41 E40\n");
  EXPECT_EQ(rehearse(wide).findings.at(0).kind, "program") << "4.8 mm2 of the last bead";
  wide.dialect.nozzle_mm = 0.8;
  for (const Finding& finding : rehearse(wide).findings)
    EXPECT_NE(finding.kind, "program") << finding.message;
}

}  // namespace
}  // namespace understudy::rehearsal
