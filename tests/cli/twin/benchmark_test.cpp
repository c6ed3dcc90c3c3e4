#include <algorithm>
#include <csignal>
#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kSmall =
    "benchmark calibration --trials 2 --poses 12 --disturbances none,outliers --estimators whitened,robust ";

TEST(BenchmarkCommand, WritesFiguresAndAPageAndRanksTheEntrants) {
  const Folder folder;
  const Outcome outcome =
      understudy(kSmall + "-j 2 --plugin 'echo nonsense' --plugin 'exit 3' --out " + (folder / "out"));
  // Two entrants solved nothing: the answer is no, and all figures are there.
  ASSERT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.err, ::testing::AllOf(HasSubstr("echo nonsense: solved no problem at all"),
                                            HasSubstr("exit 3: solved no problem at all")));
  EXPECT_EQ(folder.entries(), 1);
  EXPECT_THAT(outcome.out, HasSubstr("ranking"));
  EXPECT_THAT(outcome.out, HasSubstr("exit 3: 4 x ended with status 3"));
  const json value = json::parse(read_file(folder.path() / "out" / "benchmark.json"));
  EXPECT_EQ(value["schema"], "understudy.calibration-benchmark/1");
  EXPECT_EQ(value["conditions"].size(), 2u);
  EXPECT_EQ(value["entrants"].size(), 4u);
  EXPECT_EQ(value["conditions"][1]["disturbance"], "outliers");
  EXPECT_EQ(value["conditions"][1]["best"], "robust");
  EXPECT_EQ(value["provenance"]["machine_sha256"].get<std::string>().size(), 64u);
  const std::string page = read_file(folder.path() / "out" / "report.html");
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, ::testing::Not(HasSubstr("http")));
}

TEST(BenchmarkCommand, ChosenEstimatorsThatSolveAreAGoodAnswer) {
  const Folder folder;
  const Outcome outcome = understudy(kSmall + "-j 2 --out " + (folder / "out"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "") << "no progress outside a terminal";
}

TEST(BenchmarkCommand, APlugInThatMayNotRunIsNoAnswer) {
  const Folder folder;
  const std::string script = folder.write("plugin.sh", "#!/bin/sh\n");
  const Outcome outcome = understudy(
      "benchmark calibration --trials 2 --poses 12 --disturbances none --estimators robust --plugin " +
      script + " --out " + (folder / "out"));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("solved no problem at all"));
  EXPECT_THAT(outcome.out, HasSubstr("2 of 2 failed"));
}

// Inside a box of our own that forbids namespaces, as a container may.
TEST(BenchmarkCommand, WarnsWhereAPlugInRunsWithoutABox) {
  const std::string box = "bwrap --dev-bind / / --unshare-user --disable-userns ";
  if (std::system((box + "true 2>/dev/null").c_str()) != 0)
    GTEST_SKIP() << "bubblewrap is not installed, or may make no namespaces here";
  const Folder folder;
  const auto warning = [&](const std::string& prefix) {
    const std::string command =
        prefix + UNDERSTUDY_PROGRAM +
        " benchmark calibration --trials 1 --poses 12 --disturbances none --estimators whitened "
        "--plugin 'exit 3' --out " +
        (folder / "out") + " >/dev/null 2>" + (folder / "err");
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
    const std::string said = read_file(folder.path() / "err");
    return said.substr(0, said.find(':'));
  };
  EXPECT_EQ(warning(box), "warning");
  EXPECT_EQ(warning(box + "--setenv UNDERSTUDY_PLUGIN_BOX off "), "exit 3");
  EXPECT_EQ(warning(""), "exit 3");
}

TEST(BenchmarkCommand, NothingIsLeftWhereItIsInterrupted) {
  const Folder folder;
  Outcome outcome;
  for (const double seconds : {0.7, 2.5, 7.0}) {
    outcome = understudy_interrupted(
        "benchmark calibration --trials 1 --estimators whitened --plugin 'sleep 9' --out " + (folder / "out"),
        seconds);
    EXPECT_EQ(folder.entries(), 0);
    if (!outcome.err.empty()) break;  // else it came before main() could say what a signal means
  }
  EXPECT_EQ(outcome.status, 128 + SIGINT);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted"));
}

TEST(BenchmarkCommand, RefusesBadInputInOneLineAndWritesNothing) {
  const Folder folder;
  const auto refused = [&](const std::string& words, const std::string& expected) {
    const Outcome outcome = understudy("benchmark calibration " + words + " --out " + (folder / "out"));
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(expected)) << words;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  };
  refused("--noise 20:0.2", "does not read like 20um:0.2mrad");
  refused("--noise 20um:0.2mradX", "does not read like");
  refused("--noise nanum:0.2mrad", "outside");
  refused("--estimators robst", "did you mean robust?");
  refused("--disturbances outlier", "did you mean outliers?");
  refused("--poses 0", "outside 1..1000");
  refused("--trials 0", "outside 1..100000");
  refused("--from camera", "poses pixels");
  refused("--machine arm --estimators whitened", "calibrates hexapods");
  refused("--machine arm --from pixels", "hexapod's platform");
  EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace understudy::cli_test
