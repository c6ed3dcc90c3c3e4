#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/file/read_file.h"
#include "tests/cli/program_run.h"

namespace understudy::cli_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(FaultsCommand, TheCommandOfARunRepeatsItsAnswer) {
  const Folder folder;
  const Outcome outcome = understudy("benchmark faults --runs 4 --seed 2 --out " + (folder / "out"));
  ASSERT_TRUE(outcome.status == 0 || outcome.status == 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("4 runs of 2 prints, seed 2\n"));
  EXPECT_EQ(folder.entries(), 1) << "no journal is left";
  const json value = json::parse(read_file(folder.path() / "out" / "faults.json"));
  ASSERT_EQ(value["runs"].size(), 4u);
  bool silent = false;
  for (const json& run : value["runs"]) {
    const std::string answer = run["answer"], command = run["command"];
    silent = silent || answer == "go, spoilt";
    if (run["number"] != 3) continue;  // one fault is enough
    const std::string start = "understudy ", end = " --out replay";
    ASSERT_EQ(command.substr(0, start.size()), start);
    ASSERT_THAT(command, ::testing::EndsWith(end));
    const Outcome again =
        understudy(command.substr(start.size(), command.size() - start.size() - end.size()) + " --out " +
                   (folder / "again"));
    EXPECT_EQ(again.status, answer.starts_with("go") ? 0 : 1) << command << again.err;
    const json summary = json::parse(read_file(folder.path() / "again" / "summary.json"));
    EXPECT_EQ(summary["provenance"]["faults"].size(), 1u) << command;
  }
  EXPECT_EQ(outcome.status, silent ? 1 : 0);
}

TEST(FaultsCommand, RefusesBadInputInOneLineAndWritesNothing) {
  const Folder folder;
  const auto refused = [&](const std::string& words, const std::string& expected) {
    const Outcome outcome = understudy(words + " --out " + (folder / "out"));
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_THAT(outcome.err, HasSubstr(expected)) << words;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  };
  refused("benchmark faults --runs 0", "--runs 0 is outside 1..1000000");
  refused("benchmark faults --machine finishing", "does not print");
  refused("benchmark faults --machine nowhere", "nowhere");
  const std::string program = folder.write("empty.gcode", "G21\nG90\nG0 X0 Y0 Z50\n");
  refused("rehearse " + program + " --fault '{fault: stal, axis: l1, at_s: 1, for_s: 1}'",
          "did you mean 'stall'?");
  refused("rehearse " + program + " --fault '{fault: stall, axis: x, at_s: 1, for_s: 1}'",
          "axis 'x' is not one of");
  EXPECT_EQ(folder.entries(), 1) << "the program";
}

}  // namespace
}  // namespace understudy::cli_test
