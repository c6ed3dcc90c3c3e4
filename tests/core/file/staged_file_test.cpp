#include "core/file/staged_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {
namespace fs = std::filesystem;

class StagedFileTest : public ::testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) const { std::ofstream(root_ / name) << text; }
  std::string text_in(const std::string& name) const { return read_file(root_ / name); }
  TemporaryFolder root_;
};

/// A process that is gone: its number is free.
pid_t dead_process() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  int status = 0;
  ::waitpid(child, &status, 0);
  return child;
}

TEST_F(StagedFileTest, HasItsNameOnlyAfterCommit) {
  put("a", "old");
  {
    const StagedFile dropped(root_ / "a", "new");
    EXPECT_EQ(text_in("a"), "old");
  }
  EXPECT_EQ(text_in("a"), "old");
  EXPECT_EQ(root_.entries(), 1);
  StagedFile(root_ / "a", "new").commit();
  EXPECT_EQ(text_in("a"), "new");
  EXPECT_EQ(root_.entries(), 1);
}

TEST_F(StagedFileTest, PiecesComeOneAfterTheOther) {
  StagedFile(root_ / "a", [](const AppendPiece& append) {
    for (const char* piece : {"ne", "", "w"}) append(piece);
  }).commit();
  EXPECT_EQ(text_in("a"), "new");
  const auto fails = [](const AppendPiece& append) {
    append("newer");
    throw std::runtime_error("half way");
  };
  EXPECT_THROW(StagedFile(root_ / "a", fails), std::runtime_error);
  EXPECT_EQ(text_in("a"), "new");
  EXPECT_EQ(root_.entries(), 1) << "nothing half-written stays";
}

TEST_F(StagedFileTest, AKilledProcessLeavesTheOldFileAndTheNextWriteRemovesItsRest) {
  put("a", "old");
  const pid_t child = ::fork();
  if (child == 0) {
    const StagedFile file(root_ / "a", "new");
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(text_in("a"), "old");
  EXPECT_EQ(root_.entries(), 2);
  StagedFile(root_ / "a", "newer").commit();
  EXPECT_EQ(text_in("a"), "newer");
  EXPECT_EQ(root_.entries(), 1);
}

TEST_F(StagedFileTest, RemovesNothingThatIsNotItsOwn) {
  const pid_t dead = dead_process();
  const std::string living = fmt::format(".a.part-{}-1", ::getppid()),
                    locked = fmt::format(".a.part-{}-1", dead),
                    of_another = fmt::format(".b.part-{}-1", dead),
                    users[] = {".a.part-notes", fmt::format(".a.part-{}-x", dead), ".a.part-", ".a.part.yaml",
                               fmt::format(".a.part-{}", dead)};
  for (const auto& name : {living, locked, of_another}) put(name, "x");
  for (const auto& name : users) put(name, "x");
  const Descriptor of_another_host(::open((root_ / locked).c_str(), O_RDONLY | O_CLOEXEC));
  ASSERT_EQ(::flock(of_another_host.get(), LOCK_EX), 0);
  StagedFile(root_ / "a", "new").commit();
  for (const auto& name : {living, locked, of_another}) EXPECT_TRUE(fs::exists(root_ / name)) << name;
  for (const auto& name : users) EXPECT_TRUE(fs::exists(root_ / name)) << name;
}

TEST_F(StagedFileTest, AFileThatGrowsTooLargeFailsAndLeavesTheOldOne) {
  put("a", "old");
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{1000, 1000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      StagedFile(root_ / "a", std::string(2000, 'x')).commit();
    } catch (const MachineError& error) {
      ::_exit(std::string(error.what()).find("too large") != std::string::npos ? 0 : 1);
    }
    ::_exit(2);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(text_in("a"), "old");
  EXPECT_EQ(root_.entries(), 1);
}

TEST_F(StagedFileTest, AFolderThatIsGoneIsNoMistakeOfTheUser) {
  fs::create_directory(root_ / "d");
  StagedFile file(root_ / "d" / "a", "new");
  fs::remove_all(root_ / "d");
  EXPECT_THROW(file.commit(), MachineError);
  EXPECT_THROW(StagedFile(root_ / "d" / "a", "new"), MachineError);
  EXPECT_THROW(StagedFile(root_.path(), "new"), MachineError);
  EXPECT_EQ(root_.entries(), 0);
}

TEST_F(StagedFileTest, TheLongestNameCanBeWritten) {
  const std::string name(255, 'n');
  put(name, "old");
  StagedFile(root_ / name, "new").commit();
  EXPECT_EQ(text_in(name), "new");
}

TEST_F(StagedFileTest, LinksStayLinksAlsoWhereTheyLeadToNothingYet) {
  fs::create_directory(root_ / "d");
  fs::create_symlink("d/there", root_ / "middle");
  fs::create_symlink(root_ / "middle", root_ / "link");
  StagedFile(root_ / "link", "first").commit();
  EXPECT_EQ(text_in("d/there"), "first");
  StagedFile(root_ / "link", "second").commit();
  EXPECT_EQ(text_in("d/there"), "second");
  EXPECT_TRUE(fs::is_symlink(root_ / "link"));
  EXPECT_TRUE(fs::is_symlink(root_ / "middle"));
}

TEST_F(StagedFileTest, APipeGetsTheContent) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const Descriptor out(ends[0]);
  {
    const Descriptor in(ends[1]);  // /proc/self/fd/N is a link to what has no name
    StagedFile(fmt::format("/proc/self/fd/{}", in.get()), "text").commit();
  }
  char read[8] = {};
  EXPECT_EQ(::read(out.get(), read, sizeof(read)), 4);
  EXPECT_STREQ(read, "text");
}

TEST(CannotWrite, TellsTheDiskFromTheUser) {
  for (const int error : {ENOSPC, EDQUOT, EIO, EFBIG}) EXPECT_THROW(cannot_write("a", error), MachineError);
  for (const int error : {ENOENT, EACCES, EROFS, EISDIR, ENAMETOOLONG})
    EXPECT_THROW(cannot_write("a", error), InputError);
  EXPECT_THROW(failed_to_write("a", ENOENT), MachineError);
}

}  // namespace
}  // namespace understudy
