#include "calibration/plugin/box.h"

#include <cstdlib>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/plugin/child_process.h"

namespace understudy::calibration {
namespace {

using ::testing::ElementsAre;

TEST(Box, TheShellIsWhatItRuns) {
  const std::vector<std::string> words = boxed("echo 'a b'", {});
  ASSERT_GE(words.size(), 3u);
  EXPECT_THAT(std::vector(words.end() - 3, words.end()), ElementsAre("/bin/sh", "-c", "echo 'a b'"));
}

TEST(Box, EveryRunHasAMarkOfItsOwn) { EXPECT_NE(next_run_mark(), next_run_mark()); }

TEST(Box, WhereItIsThereIsNoNetworkAndNothingToWriteOn) {
  if (!has_box()) GTEST_SKIP() << "bubblewrap is not installed, or may make no namespaces here";
  const ProcessRun run = run_process(
      "grep -c : /proc/net/dev; touch \"$HOME/x\" /usr/x /dev/x /run/x 2>/dev/null && echo written; "
      "echo kept > \"$TMPDIR/x\" && cat \"$TMPDIR/x\"",
      "");
  EXPECT_TRUE(run.ok) << run.failure;
  EXPECT_THAT(run.output, testing::AllOf(testing::StartsWith("1\n"), testing::HasSubstr("kept"),
                                         testing::Not(testing::HasSubstr("written"))));
}

TEST(Box, WhereItIsItsFoldersAreOfLimitedSizeAndItsProgramsWithoutPrivileges) {
  if (!has_box()) GTEST_SKIP() << "bubblewrap is not installed, or may make no namespaces here";
  const ProcessRun run = run_process(
      "for folder in /tmp /dev/shm; do head -c 5000000 /dev/zero > $folder/x || echo full; done 2>/dev/null; "
      "ls -A /run; grep CapEff /proc/self/status; unshare -U true 2>/dev/null && echo unshared",
      "", {.own_folders = 3'000'000});
  EXPECT_EQ(run.output, "full\nfull\nCapEff:\t0000000000000000\n");
}

TEST(Box, NothingGainsPrivilegesWithItOrWithout) {
  const std::string look = "grep NoNewPrivs /proc/self/status";
  EXPECT_EQ(run_process(look, "").output, "NoNewPrivs:\t1\n");
  ::setenv("UNDERSTUDY_PLUGIN_BOX", "off", 1);
  EXPECT_EQ(run_process(look, "").output, "NoNewPrivs:\t1\n");
  ::unsetenv("UNDERSTUDY_PLUGIN_BOX");
}

TEST(Box, IsLeftOutOnRequest) {
  ::setenv("UNDERSTUDY_PLUGIN_BOX", "off", 1);
  EXPECT_FALSE(has_box());
  EXPECT_THAT(boxed("true", {}), testing::Not(testing::Contains(testing::HasSubstr("bwrap"))));
  ::unsetenv("UNDERSTUDY_PLUGIN_BOX");
}

}  // namespace
}  // namespace understudy::calibration
