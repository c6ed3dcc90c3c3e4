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

/// A short print on the table, its results in `out` beside it.
class Verify : public testing::Test {
 protected:
  Verify() : program_(folder_.write("it's a line.gcode", kLine)) {
    const Outcome done =
        understudy("rehearse \"" + program_ + "\" --engine quasistatic --gap-control off --no-pictures " +
                   "--as-printed " + out() + "/part.stl --tip-tolerance 5 --out " + out());
    EXPECT_LE(done.status, 1) << done.err;
  }
  std::string out() const { return folder_ / "out"; }
  static constexpr const char* kLine =
      "G21 G90 M83\nM104 S200\nG0 X-3 Y0 Z1\nG1 Z0.15 F600\nG1 X3 E0.2 F300\nG0 Z2\n";

  Folder folder_;
  std::string program_;
};

TEST_F(Verify, EqualInputsGiveEqualFiles) {
  const Outcome again = understudy("verify " + out());
  EXPECT_EQ(again.status, 0) << again.out << again.err;
  EXPECT_THAT(again.out, HasSubstr("verified: the inputs are those of the record"));
  EXPECT_TRUE(fs::exists(out() + "/part.stl"));
  EXPECT_EQ(folder_.entries(), 2);
}

TEST_F(Verify, AFileThatWasChangedIsNamed) {
  std::string summary = read_file(out() + "/summary.json");
  write_file(out() + "/summary.json", summary + " ");
  const Outcome again = understudy("verify " + out());
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.out, HasSubstr("not verified: summary.json in it was changed"));
}

TEST_F(Verify, AnInputThatWasChangedIsNamed) {
  write_file(program_, std::string(kLine) + "G0 Z3\n");
  const Outcome again = understudy("verify " + out());
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.out, HasSubstr("it's a line.gcode was changed"));
}

// A result that somebody made up, with a manifest that fits.
TEST_F(Verify, AResultThatTheRunDoesNotGiveIsTold) {
  std::string trace = read_file(out() + "/trace.csv");
  trace.back() = ' ';
  write_file(out() + "/trace.csv", trace);
  ASSERT_EQ(std::system(("cd '" + out() +
                         "' && find . -type f ! -name manifest.sha256 -printf '%P\\0' | sort -z | "
                         "xargs -0 sha256sum > ../m && mv ../m manifest.sha256")
                            .c_str()),
            0);
  const Outcome again = understudy("verify " + out());
  EXPECT_EQ(again.status, 1);
  EXPECT_THAT(again.out, HasSubstr("trace.csv: from byte"));
  EXPECT_THAT(again.out, HasSubstr("1 of its files differ"));
}

TEST_F(Verify, WhatIsNoResultOfRehearseIsBadInput) {
  for (const std::string& folder : {folder_ / "none", folder_.path().string(), program_}) {
    const Outcome outcome = understudy("verify \"" + folder + "\"");
    EXPECT_EQ(outcome.status, 2) << folder;
    EXPECT_EQ(outcome.out, "");
  }
}

}  // namespace
}  // namespace understudy::cli_test
