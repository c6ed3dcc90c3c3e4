// `--quiet` and `--json` of the commands that give a verdict or an answer.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/line_in_air.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

class OutputOptions : public testing::Test {
 protected:
  void SetUp() override {
    write_line_in_air(folder_);
    folder_.write("c.yaml", "name: c\nscenarios: [s.yaml]\nseeds: 1-3\n");
  }
  std::string at(const std::string& name) const { return folder_ / name; }

  /// Of a command with --json: one document and nothing beside it, the same as the file says.
  json document(const std::string& words, const std::string& file = "") const {
    const Outcome told = understudy(words + " --json");
    EXPECT_LE(told.status, 1) << told.err;
    EXPECT_EQ(told.err, "");
    if (!file.empty()) {
      EXPECT_EQ(told.out, read_file(at(file)));
    }
    return json::parse(told.out, nullptr, false);
  }
  std::string quiet(const std::string& words) const {
    const Outcome told = understudy(words + " --quiet");
    EXPECT_LE(told.status, 1) << told.err;
    EXPECT_EQ(told.err, "");
    return told.out;
  }

  Folder folder_;
};

TEST_F(OutputOptions, Sweep) {
  const std::string words = "sweep " + at("s.yaml") + " --samples 3 --out " + at("sweep");
  const json told = document(words, "sweep/sweep.json");
  EXPECT_EQ(told["schema"], "understudy.sweep/1");
  ASSERT_EQ(told["runs"].size(), 3U);
  EXPECT_EQ(told["runs"][2]["seed"], 3);
  const int go = told["go"]["count"];
  EXPECT_DOUBLE_EQ(told["go"]["fraction"], go / 3.);
  // The line is in air, where no machine starts. Clopper and Pearson 1934: of none of 3 up to 1 -
  // 0.025^(1/3).
  EXPECT_EQ(go, 0);
  EXPECT_NEAR(told["go"]["high"], 0.7076, 1e-4);
  EXPECT_EQ(quiet(words), "verdict go: " + std::to_string(go) + " of 3\n");
}

TEST_F(OutputOptions, Campaign) {
  const json told = document("campaign " + at("c.yaml") + " --workers 1 --out " + at("c"), "c/campaign.json");
  EXPECT_TRUE(told.is_object());
  EXPECT_EQ(quiet("campaign " + at("c.yaml") + " --workers 1 --out " + at("d")),
            at("d/table.csv\n") + at("d/campaign.html\n") + at("d/runs.sqlite\n"));
  EXPECT_EQ(
      document("campaign " + at("c.yaml") + " --only 1 --out " + at("one"), "one/summary.json")["schema"],
      "understudy.rehearsal/1");
}

class ExtendedOutputOptions : public OutputOptions {};

TEST_F(ExtendedOutputOptions, Register) {
  const std::string words = "register --fixture bottle --as-built nominal -o " + at("pose.yaml");
  const json told = document(words);
  EXPECT_EQ(told["schema"], "understudy.rehearsal/1");
  EXPECT_EQ(told["verdict"], "go");
  EXPECT_TRUE(told.contains("registration"));
  EXPECT_TRUE(fs::exists(at("pose.yaml")));
  EXPECT_EQ(quiet(words), "bottle on hexapod: found\n");
}

TEST_F(OutputOptions, GapSensor) {
  ASSERT_EQ(understudy("sample-gaps --seed 5 -o " + at("gaps")).status, 0);
  const std::string words = "calibrate gap-sensor " + at("gaps/table.csv") + " -o " + at("m.yaml");
  const json told = document(words);
  EXPECT_EQ(told["schema"], "understudy.gap-sensor/1");
  EXPECT_EQ(told["machine"], "hexapod");
  EXPECT_GT(told["mounting"].size(), 10U);
  for (const json& freedom : told["mounting"])
    EXPECT_LE(freedom["sigma"], 1.01 * freedom["tolerance"].get<double>());
  EXPECT_TRUE(fs::exists(at("m.yaml")));
  EXPECT_EQ(quiet(words), "machine: " + at("m.yaml") + "\n");
}

TEST_F(OutputOptions, Benchmark) {
  const std::string words =
      "benchmark calibration --trials 2 --poses 12 --disturbances none --estimators robust --out " + at("b");
  EXPECT_TRUE(document(words, "b/benchmark.json").is_object());
  EXPECT_EQ(quiet(words), at("b/benchmark.json\n") + at("b/report.html\n"));
}

TEST_F(OutputOptions, Workspace) {
  const std::string words = "workspace --machine hexapod --step 20 --out " + at("w");
  EXPECT_TRUE(document(words, "w/workspace.json").is_object());
  EXPECT_EQ(quiet(words), at("w/workspace.json\n") + at("w/workspace.png\n"));
}

TEST_F(OutputOptions, ErrorsComeOnStandardErrorWhateverIsAsked) {
  for (const std::string command : {"sweep none.yaml", "campaign none.yaml", "benchmark gap --machine none",
                                    "calibrate gap-sensor none.csv -o m.yaml"}) {
    const Outcome told = understudy(command + " --json --quiet");
    EXPECT_EQ(told.status, 2) << command;
    EXPECT_EQ(told.out, "") << command;
    EXPECT_THAT(told.err, HasSubstr("none")) << command;
  }
}

}  // namespace
}  // namespace understudy::cli_test
