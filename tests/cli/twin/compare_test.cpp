#include <algorithm>
#include <filesystem>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A short print on the table, twice: on the machine as drawn, and on one as built.
class Compare : public testing::Test {
 protected:
  Compare() : program_(folder_.write("line.gcode", kLine)) {
    for (const auto& [name, as_built] : {std::pair("a", "nominal"), {"b", "sampled"}}) {
      const Outcome done =
          understudy("rehearse " + program_ + " --engine quasistatic --gap-control off --no-pictures " +
                     "--as-built " + as_built + " --seed 5 --out " + (folder_ / name));
      EXPECT_LE(done.status, 1) << done.err;
    }
  }
  Outcome compare(const std::string& a, const std::string& b, const std::string& options = "") const {
    return understudy("compare " + (folder_ / a) + " " + (folder_ / b) + " " + options);
  }
  static constexpr const char* kLine =
      "G21 G90 M83\nM104 S200\nG0 X-3 Y0 Z1\nG1 Z0.15 F600\nG1 X3 E0.2 F300\nG0 Z2\n";

  Folder folder_;
  std::string program_;
};

TEST_F(Compare, TellsWhatDiffersAndIsGoodUnlessAskedToFail) {
  const Outcome told = compare("a", "b");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, testing::ContainsRegex("--as-built +nominal +sampled"));
  EXPECT_THAT(told.out, HasSubstr("accuracy.tip_max_um"));
  EXPECT_THAT(told.out, HasSubstr("Curves differ: trace.csv: from byte"));
  EXPECT_EQ(compare("a", "b", "--fail-on-change").status, 1);
}

TEST_F(Compare, ACopyIsTheSameAndDoesNotFail) {
  fs::copy(folder_ / "a", folder_ / "copy", fs::copy_options::recursive);
  const Outcome told = compare("a", "copy", "--fail-on-change");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("The results are the same; all inputs are the same"));
}

TEST_F(Compare, OneDocumentOnStandardOutputAndInTheFolder) {
  const Outcome told = compare("a", "b", "--json --out " + (folder_ / "changes"));
  EXPECT_EQ(told.status, 0) << told.err;
  const auto json = nlohmann::json::parse(told.out);
  EXPECT_EQ(json.at("schema"), "understudy.comparison/1");
  EXPECT_EQ(json.at("differs"), true);
  EXPECT_EQ(read_file(folder_ / "changes/compare.json"), told.out);
  const std::string page = read_file(folder_ / "changes/compare.html");
  EXPECT_THAT(page, HasSubstr("<polyline"));
  EXPECT_THAT(page, HasSubstr("Two rehearsals: A a, B b"));
}

TEST_F(Compare, WhatIsNoPairOfResultsIsBadInputAndWritesNothing) {
  const std::string out = folder_ / "changes";
  fs::create_directory(folder_ / "empty");
  fs::create_directory_symlink(folder_ / "a", folder_ / "link");
  fs::copy(folder_ / "a", folder_ / "cut", fs::copy_options::recursive);
  fs::remove(folder_ / "cut/trace.csv");
  const auto refusal = [&](const std::string& a, const std::string& b) {
    const Outcome refused = compare(a, b, "--out " + out);
    EXPECT_EQ(refused.status, 2) << a << " " << b;
    EXPECT_EQ(refused.out, "");
    EXPECT_FALSE(fs::exists(out));
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
    return refused.err;
  };
  EXPECT_THAT(refusal("a", "none"), HasSubstr("none is no folder"));
  EXPECT_THAT(refusal("a", "empty"), HasSubstr("summary.json"));
  EXPECT_THAT(refusal("line.gcode", "a"), HasSubstr("is no folder"));
  EXPECT_THAT(refusal("a", "a"), HasSubstr("the same folder"));
  EXPECT_THAT(refusal("a", "link"), HasSubstr("the same folder"));
  EXPECT_THAT(refusal("a", "cut"), HasSubstr("trace.csv: it is missing"));
}

TEST_F(Compare, ResultsThatAreComparedAreNotWrittenOver) {
  const Outcome refused = compare("a", "b", "--out " + (folder_ / "a"));
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("is one of the results that are compared"));
  EXPECT_TRUE(fs::exists(folder_ / "a/summary.json"));
}

}  // namespace
}  // namespace understudy::cli_test
