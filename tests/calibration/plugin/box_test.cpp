#include "calibration/plugin/box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/plugin/child_process.h"

namespace understudy::calibration {
namespace {

using ::testing::ElementsAre;

TEST(Box, TheShellIsWhatItRuns) {
  const std::vector<std::string> words = boxed("echo 'a b'");
  ASSERT_GE(words.size(), 3u);
  EXPECT_THAT(std::vector(words.end() - 3, words.end()), ElementsAre("/bin/sh", "-c", "echo 'a b'"));
}

TEST(Box, EveryRunHasAMarkOfItsOwn) { EXPECT_NE(next_run_mark(), next_run_mark()); }

TEST(Box, WhereItIsThereIsNoNetworkAndNothingToWriteOn) {
  if (!has_box()) GTEST_SKIP() << "bubblewrap is not installed, or may make no namespaces here";
  const ProcessRun run = run_process(
      "grep -c : /proc/net/dev; touch \"$HOME/x\" /usr/x 2>/dev/null && echo written; "
      "echo kept > \"$TMPDIR/x\" && cat \"$TMPDIR/x\"",
      "");
  EXPECT_TRUE(run.ok) << run.failure;
  EXPECT_THAT(run.output, testing::AllOf(testing::StartsWith("1\n"), testing::HasSubstr("kept"),
                                         testing::Not(testing::HasSubstr("written"))));
}

}  // namespace
}  // namespace understudy::calibration
