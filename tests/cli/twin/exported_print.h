// A rehearsal of a short print, and what exports of it are refused.
#pragma once

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program_run.h"

namespace understudy::cli_test {

/// A short print on the table, its results in `out`; `kind`: of the export, whose file is "line." + `ending`.
class ExportedPrint : public testing::Test {
 protected:
  ExportedPrint(const std::string& kind, const std::string& ending) : kind_(kind), ending_(ending) {}

  Outcome rehearse(const std::string& program, const std::string& options = "") const {
    return understudy("rehearse \"" + folder_.write("line.gcode", program) +
                      "\" --engine quasistatic --gap-control off --tip-tolerance 5 --out " + out() + " " +
                      options);
  }
  std::string out() const { return folder_ / "out"; }
  std::string exported() const { return folder_ / ("line." + ending_); }
  Outcome run_export(const std::string& words) const { return understudy("export " + kind_ + " " + words); }
  /// As bad input, in one line that says this, with nothing written.
  void refused(const std::string& words, const std::string& says) const {
    const Outcome outcome = run_export(words);
    EXPECT_EQ(outcome.status, 2) << outcome.out << outcome.err;
    EXPECT_THAT(outcome.err, testing::MatchesRegex("understudy: [^\n]*\n"));
    EXPECT_THAT(outcome.err, testing::HasSubstr(says));
    EXPECT_FALSE(std::filesystem::exists(exported()));
  }

  static constexpr const char* kLine =
      "G21 G90 M83\nM104 S200\nG0 X-3 Y0 Z1\nG1 Z0.15 F600\nG1 X3 E0.2 F300\nG1 Y1 E0.03\nG1 X-3 E0.2\nG0 "
      "Z2\n";
  Folder folder_;

 private:
  std::string kind_, ending_;
};

}  // namespace understudy::cli_test
