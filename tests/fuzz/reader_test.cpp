// What counts as a finding.
#include "tests/fuzz/reader.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "core/random.h"
#include "tests/fuzz/gcode_dialects.h"
#include "tests/fuzz/gcode_grammar.h"

namespace understudy::fuzz {
namespace {

TEST(FuzzReader, RefusalsThatNameTheFileAreNoFinding) {
  EXPECT_FALSE(accepts(1, "a.csv", [] { throw InputError({"a.csv", 3, 1}, "x_mm is 'a', not a number"); }));
  EXPECT_TRUE(accepts(1, "a.csv", [] {}));
}

TEST(FuzzReader, RefusalsWithoutFileAndOtherExceptionsAreFindings) {
  EXPECT_THROW(accepts(1, "a.csv", [] { throw InputError("something is wrong"); }), Finding);
  EXPECT_THROW(accepts(1, "a.csv", [] { throw std::out_of_range("map::at"); }), std::out_of_range);
}

TEST(FuzzReader, TimeBeyondWhatTheBytesAllowIsAFinding) {
  EXPECT_THROW(check_time(2 * time_limit(1000), 1000), Finding);
  EXPECT_NO_THROW(check_time(0.5 * time_limit(1000), 1000));
  EXPECT_THROW(check_time(2 * time_limit(1000, 5000), 1000, 5000), Finding);
  EXPECT_NO_THROW(check_time(0.5 * time_limit(1000, 5000), 1000, 5000));
}

TEST(FuzzReader, NumbersThatAreNotFiniteAreFindings) {
  EXPECT_THROW(require_finite(std::numeric_limits<double>::infinity(), "mass"), Finding);
  EXPECT_THROW(require_near(1.1, 1, 0, 0.01, "mass"), Finding);
  EXPECT_NO_THROW(require_near(1.001, 1, 0, 0.01, "mass"));
}

TEST(FuzzReader, AnInputFileHoldsTheLastInputAlone) {
  const InputFile file("x.txt");
  file.fill("a longer one");
  EXPECT_EQ(read_file(file.fill("short")), "short");
}

TEST(FuzzGcode, AStepThatReadsBackAsAnotherIsAFinding) {
  toolpath::GcodeOptions options;
  toolpath::Program program = toolpath::parse_gcode("G1 X1 F100\nG4 P1\n", "a", options);
  EXPECT_NO_THROW(check_program(program, options));
  program.steps[1].X_WT.translation().x() = 2e-3;  // what a dwell does not say
  EXPECT_THROW(check_program(program, options), Finding);
}

TEST(FuzzGrammar, WritesManyKindsOfWordsThatItsReaderAccepts) {
  std::string all;
  Random random(1, "grammar");
  for (const Dialect& dialect : dialects()) {
    std::string of_dialect;
    for (int i = 0; i < 20; ++i) {
      std::vector<std::uint8_t> bytes(2000);
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(256 * random.uniform());
      const std::string text = grammatical_program(bytes, dialect);
      EXPECT_NO_THROW(toolpath::parse_gcode(text, dialect.name, dialect.options)) << text;
      of_dialect += text;
    }
    EXPECT_EQ(of_dialect.find('B') != std::string::npos, dialect.options.rotary.has_value()) << of_dialect;
    all += of_dialect;
  }
  for (const char* word : {"G0", "G1", "G10 L2", "G20", "G28", "G43.4", "G49", "G53", "G92", "G93", "M109",
                           "M83", "M84", "A-", "W0"})
    EXPECT_NE(all.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace understudy::fuzz
