#include "core/file/output_folder.h"

#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/output_file.h"
#include "core/file/read_file.h"
#include "tests/temporary_folder.h"

namespace understudy {
namespace {
namespace fs = std::filesystem;
using ::testing::HasSubstr;

class OutputFolderTest : public ::testing::Test {
 protected:
  void write_result(const std::string& name) const {
    OutputFolder folder(root_ / "out");
    write_file(folder.path() / "summary.json", name);
    fs::create_directory(folder.path() / "pictures");
    write_file(folder.path() / "pictures" / name, "x");
    folder.commit();
  }
  std::string refusal(const fs::path& target) const {
    try {
      OutputFolder folder(target);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  TemporaryFolder root_;
};

TEST_F(OutputFolderTest, WithoutCommitNothingRemains) {
  {
    OutputFolder folder(root_ / "out");
    write_file(folder.path() / "summary.json", "{}");
    EXPECT_FALSE(fs::exists(root_ / "out"));
  }
  EXPECT_EQ(root_.entries(), 0);
}

TEST_F(OutputFolderTest, CommitReplacesAnOlderResultWhole) {
  write_result("first");
  write_result("second");
  EXPECT_EQ(read_file(root_ / "out" / "summary.json"), "second");
  EXPECT_FALSE(fs::exists(root_ / "out" / "pictures" / "first"));
  EXPECT_TRUE(fs::exists(root_ / "out" / "pictures" / "second"));
  EXPECT_EQ(root_.entries(), 1);
}

TEST_F(OutputFolderTest, WhatAManifestNamesOutsideItsFolderStays) {
  write_result("first");
  fs::create_directory(root_ / "a");
  for (const char* name : {"mine", "a/mine"}) write_file(root_ / name, "a user's");
  const std::string digest = sha256_hex("a user's");
  const std::string manifest = read_file(root_ / "out" / kManifest);
  write_file(root_ / "out" / kManifest, manifest + digest + "  ../mine\n" + digest +
                                            "  pictures/../../a/mine\n" + digest + "  " +
                                            (root_ / "mine").string() + "\n");
  write_result("second");
  EXPECT_EQ(read_file(root_ / "out" / "summary.json"), "second");
  EXPECT_TRUE(fs::exists(root_ / "mine"));
  EXPECT_TRUE(fs::exists(root_ / "a" / "mine"));
}

TEST_F(OutputFolderTest, WhatIsTakenAwayGoesWholeWhileItIsWrittenTo) {
  for (int round = 0; round < 20; ++round) {  // a writer must meet the moment between emptying and removing
    fs::create_directory(root_ / "out.part");
    std::atomic<int> files{0};
    std::atomic<bool> stop{false};
    std::thread writer([&] {
      while (!stop && std::ofstream(root_ / "out.part" / std::to_string(files))) ++files;
    });
    {
      const PartialResult partial(root_ / "out.part");
      while (files < 100) std::this_thread::yield();
    }
    EXPECT_FALSE(fs::exists(root_ / "out.part")) << "round " << round;
    stop = true;
    writer.join();
    fs::remove_all(root_ / "out.part");
  }
}

/// The old result, once exchanged, goes whole: an interrupt that runs out of patience meanwhile waits for
/// that.
TEST_F(OutputFolderTest, WhatIsDoneLastIsDoneBeforeAnInterruptEndsTheProcess) {
  EXPECT_EXIT(
      {
        PartialResult partial(root_ / "out.part");
        std::thread end;
        partial.keep_after([&] {
          end = std::thread([] {
            remove_partial_results();
            std::_Exit(0);
          });
          std::this_thread::sleep_for(std::chrono::milliseconds(200));
          std::ofstream(root_ / "last") << "done";
        });
        end.join();
      },
      testing::ExitedWithCode(0), "");
  EXPECT_TRUE(fs::exists(root_ / "last"));
}

TEST_F(OutputFolderTest, TheManifestIsWhatSha256sumChecks) {
  write_result("first");
  EXPECT_EQ(
      std::system(("cd '" + (root_ / "out").string() + "' && sha256sum --quiet -c manifest.sha256").c_str()),
      0);
}

TEST_F(OutputFolderTest, WhatAUserPutThereStaysAndIsNamed) {
  fs::create_directories(root_ / "photos");
  write_file(root_ / "photos" / "a.jpg", "precious");
  write_file(root_ / "photos" / "summary.json", "{}");
  EXPECT_THAT(refusal(root_ / "photos"), HasSubstr("a.jpg, which no earlier run wrote"));
  EXPECT_EQ(read_file(root_ / "photos" / "a.jpg"), "precious");

  write_result("first");
  write_file(root_ / "out" / "notes.txt", "mine");
  EXPECT_THAT(refusal(root_ / "out"), HasSubstr("notes.txt"));
  fs::remove(root_ / "out" / "notes.txt");
  write_file(root_ / "out" / "summary.json", "with my remarks");
  EXPECT_THAT(refusal(root_ / "out"), HasSubstr("summary.json in it was changed"));
  write_file(root_ / "out" / "summary.json", "first");
  fs::create_directory(root_ / "out" / "more");
  EXPECT_THAT(refusal(root_ / "out"), HasSubstr("more/"));
  fs::remove(root_ / "out" / "more");
  EXPECT_EQ(refusal(root_ / "out"), "accepted");
}

TEST_F(OutputFolderTest, WhatAppearsDuringTheRunStaysAndTheResultIsKeptBesideIt) {
  OutputFolder folder(root_ / "out");
  write_file(folder.path() / "summary.json", "new");
  fs::create_directory(root_ / "out");
  write_file(root_ / "out" / "thesis.tex", "precious");
  try {
    folder.commit();
    FAIL() << "the thesis is gone";
  } catch (const MachineError& error) {
    EXPECT_THAT(error.what(), HasSubstr("thesis.tex"));
    EXPECT_THAT(error.what(), HasSubstr("the result is in"));
  }
  EXPECT_EQ(read_file(root_ / "out" / "thesis.tex"), "precious");
  EXPECT_EQ(read_file(root_ / "out.part" / "summary.json"), "new");
}

TEST_F(OutputFolderTest, ASecondRunIntoTheSameFolderIsRefusedAtOnce) {
  const OutputFolder first(root_ / "out");
  EXPECT_THAT(refusal(root_ / "out"), HasSubstr("another run is writing it"));
  EXPECT_TRUE(fs::exists(first.path()));
}

TEST_F(OutputFolderTest, WhatAKilledRunLeftIsTakenOver) {
  write_result("first");
  const pid_t child = ::fork();
  if (child == 0) {
    OutputFolder folder(root_ / "out");
    write_file(folder.path() / "half", "x");
    ::raise(SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(read_file(root_ / "out" / "summary.json"), "first");
  EXPECT_TRUE(fs::exists(root_ / "out.part" / "half"));
  write_result("second");
  EXPECT_EQ(read_file(root_ / "out" / "summary.json"), "second");
  EXPECT_EQ(root_.entries(), 1);
}

TEST_F(OutputFolderTest, AnOldResultThatLiesBetweenTwoRenamesComesBack) {
  write_result("first");
  fs::rename(root_ / "out", root_ / "out.part.old");
  { const OutputFolder next(root_ / "out"); }
  EXPECT_EQ(read_file(root_ / "out" / "summary.json"), "first");
  EXPECT_EQ(root_.entries(), 1);
}

TEST_F(OutputFolderTest, AnOldResultThatWasLeftAfterTwoRenamesGoes) {
  write_result("first");
  fs::rename(root_ / "out", root_ / "out.part.old");
  write_file(root_ / "out.part.old" / ".understudy-unfinished", "");
  fs::create_directory(root_ / "out.part");
  fs::rename(root_ / "out.part", root_ / "out");
  write_result("second");
  EXPECT_EQ(read_file(root_ / "out" / "summary.json"), "second");
  EXPECT_EQ(root_.entries(), 1);
}

/// Runs `work` in a process that is killed at its n-th stop: it stops before and after each system call.
/// False: it ended before that.
bool killed_at(int n, const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(0);
    ::raise(SIGSTOP);
    work();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  for (int stop = 0; stop < n && WIFSTOPPED(status); ++stop) {
    ::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr);
    ::waitpid(child, &status, 0);
  }
  if (!WIFSTOPPED(status)) return false;
  ::kill(child, SIGKILL);
  ::waitpid(child, &status, 0);
  return true;
}

TEST_F(OutputFolderTest, KilledAtAnySystemCallItLeavesTheOldResultOrTheNew) {
  if (!killed_at(1, [] { ::getppid(); })) GTEST_SKIP() << "this system lets no process be traced";
  write_result("0");
  std::string old_one = "0";
  int stop = 1, kept = 0, replaced = 0;
  for (bool killed = true; killed; stop += 2) {  // after one call is before the next
    const std::string name = std::to_string(stop), next = name + " again";
    killed = killed_at(stop, [&] { write_result(name); });
    const std::string found = read_file(root_ / "out" / "summary.json");
    ASSERT_THAT(found, ::testing::AnyOf(old_one, name)) << "stop " << stop;
    ASSERT_TRUE(fs::exists(root_ / "out" / "pictures" / found)) << "stop " << stop;
    ASSERT_NO_THROW(check_replaceable(root_ / "out")) << "stop " << stop;  // whole, by its manifest
    (found == name ? replaced : kept) += killed;
    ASSERT_NO_THROW(write_result(next)) << "stop " << stop;
    ASSERT_EQ(root_.entries(), 1) << "stop " << stop;
    old_one = next;
  }
  EXPECT_GT(kept, 50);  // from the first call to the exchange, and from there to the end
  EXPECT_GT(replaced, 10);
}

TEST_F(OutputFolderTest, ARunThatWasKilledAfterItsRenameHasWrittenItsResult) {
  write_result("first");
  write_file(root_ / "out" / ".understudy-unfinished", "");
  write_result("second");
  EXPECT_EQ(read_file(root_ / "out" / "summary.json"), "second");
  EXPECT_EQ(root_.entries(), 1);
  EXPECT_FALSE(fs::exists(root_ / "out" / ".understudy-unfinished"));
}

// A folder that came from elsewhere, with a manifest that names what lies beside it.
TEST_F(OutputFolderTest, AStrangersManifestTakesNothingOutsideItsFolder) {
  write_file(root_ / "thesis.tex", "precious");
  write_file(root_ / "notes", "precious");
  fs::create_directory(root_ / "out");
  const std::string digest(64, '0');
  write_file(root_ / "out" / "manifest.sha256", digest + "  ../thesis.tex\n" + digest +
                                                    "  a/../../thesis.tex\n" + digest + "  " +
                                                    (root_ / "notes").string() + "\n");
  EXPECT_NE(refusal(root_ / "out"), "accepted") << "it names nothing of its own";
  write_file(root_ / "out" / "manifest.sha256", digest + "  summary.json\n" + digest + "  ../thesis.tex\n" +
                                                    digest + "  " + (root_ / "notes").string() + "\n");
  write_result("second");
  EXPECT_EQ(read_file(root_ / "thesis.tex"), "precious");
  EXPECT_EQ(read_file(root_ / "notes"), "precious");
}

TEST_F(OutputFolderTest, ARefusalLeavesNothing) {
  fs::create_directory(root_ / "photos");
  write_file(root_ / "photos" / "a.jpg", "precious");
  EXPECT_THROW(OutputFolder(root_ / "photos"), InputError);
  EXPECT_THROW(check_replaceable(root_ / "photos"), InputError);
  EXPECT_NO_THROW(check_replaceable(root_ / "out"));
  EXPECT_EQ(root_.entries(), 1);
}

TEST_F(OutputFolderTest, AFolderOfTheSameNameAsOursThatIsNotStays) {
  fs::create_directory(root_ / "out.part");
  write_file(root_ / "out.part" / "a.jpg", "precious");
  EXPECT_THAT(refusal(root_ / "out"), HasSubstr("in the way"));
  EXPECT_EQ(read_file(root_ / "out.part" / "a.jpg"), "precious");
}

TEST_F(OutputFolderTest, AFolderThatCannotBeMadeIsBadInput) {
  write_file(root_ / "file", "x");
  EXPECT_NE(refusal(root_ / "file" / "out"), "accepted");
  EXPECT_THAT(refusal(root_ / "file"), HasSubstr("it is a file"));
  for (const char* target : {"/proc/understudy", "/", "//", ".", "..", "/.."})
    EXPECT_NE(refusal(target), "accepted") << target;
  EXPECT_THROW(OutputFolder(""), InputError);
}

}  // namespace
}  // namespace understudy
