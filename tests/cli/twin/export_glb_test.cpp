#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"
#include "tests/cli/twin/exported_print.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ExportGlb : public ExportedPrint {
 protected:
  ExportGlb() : ExportedPrint("glb", "glb") {}
};

TEST_F(ExportGlb, ARehearsalBecomesAFileAndSaysHowItMoves) {
  ASSERT_LE(rehearse(kLine).status, 1);
  const Outcome outcome = run_export(out() + " -o " + exported() + " --slices 10");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("line.glb: "));
  EXPECT_THAT(outcome.out, HasSubstr("beads in 10 slices of "));
  EXPECT_EQ(read_file(exported()).substr(0, 4), "glTF");
  const std::string once = read_file(exported());
  EXPECT_EQ(run_export(out() + " -o " + exported() + " --slices 10").status, 0);
  EXPECT_EQ(read_file(exported()), once) << "the same bytes from the same record";
}

TEST_F(ExportGlb, WithoutBeadsItShowsTheMachineAndSaysSo) {
  ASSERT_LE(rehearse("G21 G90 M83\nG0 X-3 Y0 Z10\nG0 X3 Y0 Z10\n").status, 1);
  const Outcome outcome = run_export(out() + " -o " + exported());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "understudy: note: the record has no beads: the file shows the machine alone\n");
  EXPECT_TRUE(fs::exists(exported()));
}

TEST_F(ExportGlb, WhatIsNoRecordIsRefused) {
  refused(out() + " -o " + exported(),
          "out/report.html: it is not there: name a folder that understudy rehearse");
  ASSERT_LE(rehearse(kLine, "--no-pictures").status, 1);
  refused(out() + " -o " + exported(),
          "out/report.html: it has no replay: rehearse a program that runs, and");
}

TEST_F(ExportGlb, OptionsOutOfRangeAndPlacesThatCannotBeWrittenAreRefused) {
  ASSERT_LE(rehearse(kLine).status, 1);
  refused(out() + " -o " + exported() + " --colour red", "--colour red: gap, width or plain is needed");
  refused(out() + " -o " + exported() + " --slices 0", "0 slices of the beads: 1 to 10000 are possible");
  refused(out() + " -o " + exported() + " --within 0", "a bound of 0 mm: one above 0 is needed");
  refused(out() + " -o " + exported() + " --speed -1", "a speed of -1: one above 0 is needed");
  refused(out() + " -o " + (folder_ / "line.gltf"), "line.gltf: does not end in .glb");
  refused(out() + " -o " + (folder_ / "nowhere/line.glb"), "nowhere");
}

}  // namespace
}  // namespace understudy::cli_test
