#include "core/file/run_journal.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {

class RunJournalTest : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::filesystem::path path = folder_ / "journal";
};

TEST_F(RunJournalTest, AnswersOfAKilledRunStandToTheLastBit) {
  {
    RunJournal journal(path, "sweep 3");
    EXPECT_FALSE(journal.confirm({1}));
    journal.add(2, {0.1, std::nan(""), -HUGE_VAL, 1.0 / 3});
  }
  RunJournal again(path, "sweep 3");
  EXPECT_TRUE(again.confirm({1}));
  EXPECT_FALSE(again.find(1));
  ASSERT_TRUE(again.find(2));
  const auto answer = *again.find(2);
  ASSERT_EQ(answer.size(), 4u);
  EXPECT_EQ(answer[0], 0.1);
  EXPECT_TRUE(std::isnan(answer[1]));
  EXPECT_EQ(answer[2], -HUGE_VAL);
  EXPECT_EQ(answer[3], 1.0 / 3);
}

TEST_F(RunJournalTest, AChangedInputBeginsAnew) {
  {
    RunJournal journal(path, "sweep 3");
    journal.confirm({1});
    journal.add(1, {5});
  }
  RunJournal changed(path, "sweep 3");
  EXPECT_FALSE(changed.confirm({1 + 1e-15}));
  EXPECT_FALSE(changed.find(1));
  changed.add(1, {6});
  RunJournal other(path, "sweep 4");
  EXPECT_FALSE(other.find(1));
}

TEST_F(RunJournalTest, ALineThatWasCutOffDoesNotCount) {
  write_file(path, "understudy.journal/1 s\n0 1\n1 2 3\n2 4.");
  RunJournal journal(path, "s");
  EXPECT_TRUE(journal.find(1));
  EXPECT_FALSE(journal.find(2));
  journal.add(2, {4.5});
  EXPECT_EQ(read_file(path), "understudy.journal/1 s\n0 1\n1 2 3\n2 4.5\n");
}

TEST_F(RunJournalTest, ACompleteStudyLeavesNone) {
  RunJournal journal(path, "s");
  journal.confirm({1});
  journal.remove();
  EXPECT_FALSE(std::filesystem::exists(path));
  RunJournal nowhere({}, "s");
  EXPECT_FALSE(nowhere.confirm({1}));
  EXPECT_TRUE(nowhere.find(0));
  EXPECT_THROW(RunJournal("/no-such-folder/journal", "s"), InputError);
}

TEST_F(RunJournalTest, AFullDiskIsNoBadInput) {
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    RunJournal journal(path, "s");
    const rlimit limit{30, 30};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      for (std::size_t item = 0; item < 100; ++item) journal.add(item, {1, 2, 3});
    } catch (const MachineError& error) {
      ::_exit(std::string(error.what()).find("too large") != std::string::npos ? 0 : 1);
    }
    ::_exit(2);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace understudy
