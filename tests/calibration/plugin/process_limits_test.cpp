#include "calibration/plugin/process_limits.h"

#include <signal.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/file/read_file.h"

namespace understudy::calibration {
namespace {

// wait(2): the low byte is the signal of one that was killed, the byte above it the status of one that ended.
constexpr int ended(int status) { return status << 8; }

TEST(ProcessLimits, EachIsNamedWhereItIsExceeded) {
  const ProcessLimits limits{.time = 15, .cores = 4, .memory = 4'000'000'000, .processes = 100};
  EXPECT_EQ(exceeded({100, 60, 4'000'000'000}, limits), "");
  EXPECT_EQ(exceeded({101, 0, 0}, limits), "started more than 100 processes and threads");
  EXPECT_EQ(exceeded({1, 60.01, 0}, limits), "used more than 60 s of CPU time");
  EXPECT_EQ(exceeded({1, 0, 4'000'000'001}, limits), "used more than 4 GB of memory");
}

TEST(ProcessLimits, AreThoseOfThePage) {
  const std::string page = read_file(UNDERSTUDY_SOURCE_DIR "/docs/calibration-plugins.md");
  const ProcessLimits limits;
  const auto row = [&](const std::string& name, const std::string& value) {
    EXPECT_THAT(page, ::testing::HasSubstr(fmt::format("\n| {} | {} |", name, value)));
  };
  row("CPU time", fmt::format("{:g} times `--plugin-timeout`", limits.cores));
  row("memory", fmt::format("{} GB", limits.memory / 1'000'000'000));
  row("processes and threads", std::to_string(limits.processes));
  row("standard output, standard error",
      fmt::format("{} MiB, {} KiB", limits.output >> 20, limits.error_output >> 10));
  row("size of a file", fmt::format("{} MB", limits.file / 1'000'000));
  row("open files", std::to_string(limits.open_files));
  row("temporary files",
      fmt::format("{0} MB in `/tmp`, {0} MB in `/dev/shm`", limits.own_folders / 1'000'000));
}

TEST(ProcessLimits, SignalsOfTheKernelAreNamedByTheirLimit) {
  const ProcessLimits limits{.time = 15, .cores = 4, .file = 250'000'000};
  EXPECT_EQ(told_ending(SIGXCPU, "", limits), "used more than 60 s of CPU time");
  EXPECT_EQ(told_ending(ended(128 + SIGXFSZ), "", limits), "wrote a file of more than 250 MB");
  EXPECT_EQ(told_ending(SIGSEGV, "", limits), "crashed with signal 11 (Segmentation fault)");
  EXPECT_EQ(told_ending(ended(127), "", limits), "the command was not found (status 127)");
  EXPECT_EQ(told_ending(ended(3), "no such matrix", limits), "ended with status 3");
}

TEST(ProcessLimits, AProgramThatSaysWhichLimitItMetIsBelieved) {
  const ProcessLimits limits{.file = 5000, .own_folders = 7'000'000, .open_files = 12};
  const auto told = [&](const char* words) { return told_ending(ended(1), words, limits); };
  EXPECT_EQ(told("Traceback\nMemoryError"), "ended with status 1 at its limit of 4 GB of memory");
  EXPECT_EQ(told_ending(SIGABRT, "what():  std::bad_alloc", limits),
            "crashed with signal 6 (Aborted) at its limit of 4 GB of memory");
  EXPECT_EQ(told("OSError: [Errno 27] File too large"),
            "ended with status 1 at its limit of 5000 bytes of a file");
  EXPECT_EQ(told("write error: No space left on device"),
            "ended with status 1 at its limit of 7 MB of temporary files");
  EXPECT_EQ(told("[Errno 24] Too many open files: 'x'"), "ended with status 1 at its limit of 12 open files");
}

TEST(ProcessLimits, TheLastLineOfATracebackIsWhatIsQuoted) {
  EXPECT_EQ(last_words("Traceback (most recent call last):\n  File \"x\"\nValueError: too few\n\n"),
            "ValueError: too few");
  EXPECT_EQ(last_words("Traceback"), "Traceback");
  EXPECT_EQ(last_words("\nfirst\nsecond\n"), "first");
  EXPECT_EQ(last_words("a\x1b[2Jb"), "a [2Jb");
  EXPECT_EQ(last_words(""), "");
}

}  // namespace
}  // namespace understudy::calibration
