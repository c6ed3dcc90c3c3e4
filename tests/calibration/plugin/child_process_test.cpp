// What a plug-in may do to us: nothing but fail, within its time, with a reason.
#include "calibration/plugin/child_process.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibration/plugin/box.h"
#include "tests/calibration/plugin/script.h"

namespace understudy::calibration {
namespace {

using ::testing::HasSubstr;

ProcessRun run(const std::string& text, const std::string& input = "in\n", const ProcessLimits& limits = {}) {
  return run_process(Script(text).command(), input, limits);
}

/// Where the numbers that a script writes are those of its processes here.
void outside_the_box() { ::setenv("UNDERSTUDY_PLUGIN_BOX", "off", 1); }

/// Kill 0 finds a process or a zombie.
bool alive(pid_t pid) { return ::kill(pid, 0) == 0; }

/// The number that a script wrote; the process must be gone soon after its group was killed.
void expect_gone(const std::string& number) {
  const pid_t pid = std::stoi(number);
  for (int tries = 0; tries < 200 && alive(pid); ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_FALSE(alive(pid)) << pid;
}

TEST(ChildProcess, AnswersWhatItReads) {
  const ProcessRun good = run("cat; echo aside >&2", "one line\n");
  EXPECT_TRUE(good.ok) << good.failure;
  EXPECT_EQ(good.output, "one line\n");
  EXPECT_EQ(good.error_output, "aside\n");
}

// A pipe holds 64 KiB: both ends must be served at once or both wait for ever.
TEST(ChildProcess, MayWriteWhileItReads) {
  const std::string much(900'000, 'x');
  const ProcessRun echo = run("cat", much);
  EXPECT_TRUE(echo.ok) << echo.failure;
  EXPECT_EQ(echo.output, much);
}

TEST(ChildProcess, MayLeaveItsInputUnread) {
  const ProcessRun deaf = run("exec <&-; echo answer; sleep 0.1", std::string(900'000, 'x'));
  EXPECT_TRUE(deaf.ok) << deaf.failure;
  EXPECT_EQ(deaf.output, "answer\n");
}

TEST(ChildProcess, WhatBeginsASessionOfItsOwnIsKilledToo) {
  outside_the_box();
  const ProcessRun run_away = run("setsid sh -c 'echo $$; exec sleep 100' &\nsleep 0.3");
  EXPECT_TRUE(run_away.ok) << run_away.failure;
  expect_gone(run_away.output);
}

// proc(5): the sixth field is the session. A terminal belongs to one session.
TEST(ChildProcess, HasNoTerminalOfOurs) {
  outside_the_box();
  EXPECT_NE(run("cut -d ' ' -f 6 /proc/self/stat").output, std::to_string(::getsid(0)) + "\n");
}

/// Whether `sleep SECONDS` runs anywhere: in the box, processes have numbers of their own.
bool sleeps(const std::string& seconds) {
  const std::string words = std::string("sleep") + '\0' + seconds + '\0';
  for (const auto& process : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(process.path() / "cmdline", std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();  // which does not throw where a process is gone
    if (text.str() == words) return true;
  }
  return false;
}

TEST(ChildProcess, DiesWithUsWhereThereIsABox) {
  if (!has_box()) GTEST_SKIP() << "bubblewrap is not installed, or may make no namespaces here";
  const std::string seconds = std::to_string(100'000 + ::getpid());
  const Script script("sleep " + seconds + " & setsid sleep " + seconds);
  const pid_t us = ::fork();
  if (us == 0) {
    run_process(script.command(), "");
    ::_exit(0);
  }
  const auto becomes = [&](bool running) {
    for (int tries = 0; tries < 200 && sleeps(seconds) != running; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return sleeps(seconds) == running;
  };
  EXPECT_TRUE(becomes(true));
  ::kill(us, SIGKILL);
  ::waitpid(us, nullptr, 0);
  EXPECT_TRUE(becomes(false));
}

TEST(ChildProcess, ThatHangsIsKilledWithAllItStarted) {
  outside_the_box();
  const auto start = std::chrono::steady_clock::now();
  const ProcessRun hung = run("sleep 100 & echo $!\nsleep 100", "", {.time = 0.3});
  EXPECT_FALSE(hung.ok);
  EXPECT_THAT(hung.failure, HasSubstr("did not end within 0.3 s"));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  expect_gone(hung.output);
}

TEST(ChildProcess, ThatIgnoresSignalsAndClosesItsStreamsStillEnds) {
  const ProcessRun hung =
      run("trap '' TERM INT HUP\nexec >&- 2>&-\nwhile :; do sleep 1; done", "", {.time = 0.3});
  EXPECT_THAT(hung.failure, HasSubstr("did not end within"));
}

TEST(ChildProcess, ThatFloodsIsStoppedAtTheLimit) {
  const ProcessRun flood = run("yes", "", {.output = 100'000});
  EXPECT_THAT(flood.failure, HasSubstr("more than 100000 bytes to standard output"));
  EXPECT_LE(flood.output.size(), 100'001u);
  const ProcessRun aside = run("yes >&2", "", {.error_output = 5000});
  EXPECT_THAT(aside.failure, HasSubstr("more than 5000 bytes to standard error"));
  EXPECT_LT(aside.failure.size(), 250u) << "quotes a little of it only";
}

TEST(ChildProcess, ThatCrashesIsToldWithItsLastWords) {
  EXPECT_THAT(run("echo 'no such matrix' >&2; exit 3").failure,
              ::testing::AllOf(HasSubstr("status 3"), HasSubstr("\"no such matrix\"")));
  EXPECT_THAT(run("kill -SEGV $$").failure, HasSubstr("signal 11"));
  EXPECT_THAT(run_process("/nowhere/at-all", "").failure, HasSubstr("not found"));
}

// What it leaves behind holds the pipes open: that must not keep us.
TEST(ChildProcess, LeavesNoProcessBehind) {
  outside_the_box();
  const ProcessRun left = run("sleep 100 & echo $!", "");
  EXPECT_TRUE(left.ok) << left.failure;
  EXPECT_LT(left.seconds, 5);
  expect_gone(left.output);
}

TEST(ChildProcess, BrokenPipesAreNoSignalToUs) {
  for (int n = 0; n < 20; ++n) EXPECT_TRUE(run("exit 0", std::string(500'000, 'x')).ok);
  sigset_t pending;
  sigpending(&pending);
  EXPECT_FALSE(sigismember(&pending, SIGPIPE));
}

TEST(ChildProcess, TellsTheShareOfItsTimeThatIsUsed) {
  double last = 0;
  std::string said;
  ProcessLimits limits;
  limits.time = 10;
  const ProcessRun run = run_process("sleep 0.5", "", limits, [&](double share, const std::string& what) {
    EXPECT_GE(share, last);
    last = share;
    said = what;
  });
  EXPECT_EQ(said, "the plug-in, 10 s at most");
  // Told every 20 ms of half a second, and never more than the whole run.
  EXPECT_GE(last, 0.045);
  EXPECT_LE(last, run.seconds / limits.time);
}

}  // namespace
}  // namespace understudy::calibration
