#include <algorithm>
#include <csignal>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

json result(const Folder& folder, const std::string& name) {
  return json::parse(read_file(folder.path() / name / "workspace.json"));
}

class EveryMachine : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryMachine, HasAWorkspace) {
  const Folder folder;
  const Outcome outcome =
      understudy("workspace --machine " + GetParam() + " --step 25 --out " + (folder / "out"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "") << "no progress outside a terminal";
  EXPECT_EQ(folder.entries(), 1);
  EXPECT_THAT(outcome.out, HasSubstr("workspace.png"));
  EXPECT_THAT(read_file(folder.path() / "out" / "workspace.png"), StartsWith("\x89PNG"));
  const json w = result(folder, "out");
  EXPECT_EQ(w["schema"], "understudy.workspace/1");
  EXPECT_EQ(w["machine"], GetParam());
  for (const char* key : {"grid", "tilt_deg", "azimuth_deg", "reachable", "binding", "limits", "largest_cube",
                          "largest_box", "margin", "condition", "axes", "provenance"})
    EXPECT_TRUE(w.contains(key)) << key;
  EXPECT_EQ(w["provenance"]["machine_sha256"].get<std::string>().size(), 64u);
  EXPECT_THAT(w["provenance"]["command"].get<std::string>(), HasSubstr("--step 25"));
  const auto cells = w["grid"]["cells"].get<std::vector<int>>();
  EXPECT_EQ(w["grid"]["points"], cells[0] * cells[1] * cells[2]);
  // Home is in the grid's box or near it: a machine that reaches nothing has a wrong frame.
  EXPECT_GT(w["reachable"]["points"], 0);
  double binds = 0;
  for (const auto& limit : w["binding"]) binds += limit["binds_first"].get<double>();
  if (w["reachable"]["fraction"] < 1)
    EXPECT_NEAR(binds, 1, 1e-5) << "shares printed with 6 digits";
  else
    EXPECT_TRUE(w["binding"].empty());
}

INSTANTIATE_TEST_SUITE_P(Workspace, EveryMachine,
                         ::testing::Values("hexapod", "arm", "five-axis", "finishing"),
                         [](const auto& machine) {
                           std::string name = machine.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(SlowWorkspace, TheSameBytesForAnyNumberOfThreads) {
  const Folder folder;
  for (const char* jobs : {"1", "3"})
    ASSERT_EQ(understudy("workspace --tilt 10 --step 5 --out " + (folder / jobs) + " -j " + jobs).status, 0);
  json one = result(folder, "1"), three = result(folder, "3");
  one["provenance"].erase("command"), three["provenance"].erase("command");
  EXPECT_EQ(one.dump(), three.dump());
  EXPECT_EQ(read_file(folder.path() / "1" / "workspace.png"),
            read_file(folder.path() / "3" / "workspace.png"));
}

TEST(SlowWorkspace, TiltCostsTheHexapodItsBallJoints) {
  // docs/reference.md#machine-g4: .55 of the 100 mm cube upright and .10 at 30 degrees about X, which is
  // azimuth -90. The shipped machine has a limit more, the distance of the screws, and is told on a coarse
  // grid: 0.03.
  const Folder folder;
  ASSERT_EQ(understudy("workspace --step 5 --out " + (folder / "upright")).status, 0);
  ASSERT_EQ(understudy("workspace --step 5 --tilt 30 --azimuth -90 --out " + (folder / "tilted")).status, 0);
  const json upright = result(folder, "upright"), tilted = result(folder, "tilted");
  EXPECT_NEAR(upright["reachable"]["fraction"].get<double>(), 0.55, 0.03);
  EXPECT_NEAR(tilted["reachable"]["fraction"].get<double>(), 0.10, 0.03);
  EXPECT_EQ(tilted["tilt_deg"], 30);
  EXPECT_EQ(tilted["azimuth_deg"], json::array({-90}));
}

TEST(SlowWorkspace, AllAzimuthsCanOnlyBeFewerPoints) {
  const Folder folder;
  const std::string words = "workspace --step 10 --tilt 20 ";
  ASSERT_EQ(understudy(words + "--out " + (folder / "one")).status, 0);
  ASSERT_EQ(understudy(words + "--all-azimuths --out " + (folder / "all")).status, 0);
  EXPECT_EQ(result(folder, "all")["azimuth_deg"].size(), 12u);
  EXPECT_LT(result(folder, "all")["reachable"]["points"], result(folder, "one")["reachable"]["points"]);
}

TEST(SlowWorkspace, ABoxWithoutHeightIsASlice) {
  const Folder folder;
  const Outcome outcome =
      understudy("workspace --box -20,20,-10,10,50,50 --step 5 --out " + (folder / "out"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(result(folder, "out")["grid"]["cells"], json::array({8, 4, 1}));
}

TEST(Workspace, RefusesWhatItCannotEvaluateAndWritesNothing) {
  const Folder folder;
  const std::string out = " --out " + (folder / "deep/out");
  const std::vector<std::pair<std::string, std::string>> calls{
      {"--tilt 181", "181"},
      {"--tilt -1", "-1"},
      {"--tilt nan", "nan"},
      {"--azimuth 400", "400"},
      {"--step 0", "--step 0"},
      {"--step -2", "-2"},
      {"--step 0.2", "1.25e+08"},
      {"--box 10,-10,0,10,0,10", "x ends at -10 mm"},
      {"--box 0,10,0,10,0", "--box"},
      {"--box 0,10,0,10,0,ten", "--box"},
      {"--box 0,10,0,10,0,1e9", "1e+09"},
      {"-j 0", "-j 0"},
      {"--machine hexapode", "hexapode"},
  };
  for (const auto& [words, part] : calls) {
    const Outcome outcome = understudy("workspace " + words + out);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << words << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(part)) << words;
    EXPECT_EQ(outcome.out, "") << words;
    EXPECT_EQ(folder.entries(), 0) << words;
  }
}

TEST(Workspace, InterruptedItLeavesNothing) {
  const Folder folder;
  const Outcome outcome = understudy_interrupted("workspace --step 0.3 --out " + (folder / "out"), 0.5);
  EXPECT_EQ(outcome.status, 128 + SIGINT) << outcome.err;
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace understudy::cli_test
