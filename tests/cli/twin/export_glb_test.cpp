#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

/// A short print on the table, its results in `out`.
class ExportGlb : public testing::Test {
 protected:
  Outcome rehearse(const std::string& program, const std::string& options = "") const {
    return understudy("rehearse \"" + folder_.write("line.gcode", program) +
                      "\" --engine quasistatic --gap-control off --tip-tolerance 5 --out " + out() + " " +
                      options);
  }
  std::string out() const { return folder_ / "out"; }
  std::string glb() const { return folder_ / "line.glb"; }
  /// Refused by this status, in one line that says this, with nothing written.
  void refused(const std::string& words, int status, const std::string& says) const {
    const Outcome outcome = understudy("export glb " + words);
    EXPECT_EQ(outcome.status, status) << outcome.out << outcome.err;
    EXPECT_THAT(outcome.err, MatchesRegex("understudy: [^\n]*\n"));
    EXPECT_THAT(outcome.err, HasSubstr(says));
    EXPECT_FALSE(fs::exists(glb()));
  }

  static constexpr const char* kLine =
      "G21 G90 M83\nM104 S200\nG0 X-3 Y0 Z1\nG1 Z0.15 F600\nG1 X3 E0.2 F300\nG0 Z2\n";
  Folder folder_;
};

TEST_F(ExportGlb, ARehearsalBecomesAFileAndSaysHowItMoves) {
  ASSERT_LE(rehearse(kLine).status, 1);
  const Outcome outcome = understudy("export glb " + out() + " -o " + glb() + " --slices 10");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("line.glb: "));
  EXPECT_THAT(outcome.out, HasSubstr("beads in 10 slices of "));
  EXPECT_EQ(read_file(glb()).substr(0, 4), "glTF");
  const std::string once = read_file(glb());
  EXPECT_EQ(understudy("export glb " + out() + " -o " + glb() + " --slices 10").status, 0);
  EXPECT_EQ(read_file(glb()), once) << "the same bytes from the same record";
}

TEST_F(ExportGlb, WithoutBeadsItShowsTheMachineAndSaysSo) {
  ASSERT_LE(rehearse("G21 G90 M83\nG0 X-3 Y0 Z10\nG0 X3 Y0 Z10\n").status, 1);
  const Outcome outcome = understudy("export glb " + out() + " -o " + glb());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "understudy: note: the record has no beads: the file shows the machine alone\n");
  EXPECT_TRUE(fs::exists(glb()));
}

TEST_F(ExportGlb, WhatIsNoRecordIsRefused) {
  refused(out() + " -o " + glb(), 2,
          "out/report.html: it is not there: name a folder that understudy rehearse");
  ASSERT_LE(rehearse(kLine, "--no-pictures").status, 1);
  refused(out() + " -o " + glb(), 2, "out/report.html: it has no replay: rehearse a program that runs, and");
}

TEST_F(ExportGlb, OptionsOutOfRangeAndPlacesThatCannotBeWrittenAreRefused) {
  ASSERT_LE(rehearse(kLine).status, 1);
  refused(out() + " -o " + glb() + " --colour red", 2, "--colour red: gap, width or plain is needed");
  refused(out() + " -o " + glb() + " --slices 0", 2, "0 slices of the beads: 1 to 10000 are possible");
  refused(out() + " -o " + glb() + " --within 0", 2, "a bound of 0 mm: one above 0 is needed");
  refused(out() + " -o " + glb() + " --speed -1", 2, "a speed of -1: one above 0 is needed");
  refused(out() + " -o " + (folder_ / "line.gltf"), 2, "line.gltf: does not end in .glb");
  refused(out() + " -o " + (folder_ / "nowhere/line.glb"), 2, "nowhere");
}

}  // namespace
}  // namespace understudy::cli_test
