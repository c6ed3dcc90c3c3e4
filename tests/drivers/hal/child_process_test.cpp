#include "drivers/hal/child_process.h"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <thread>

#include <gtest/gtest.h>

namespace understudy::drivers {
namespace {

using std::chrono::milliseconds;

TEST(ChildProcess, SpeaksThroughPipesAndEndsWithItsInput) {
  ChildStreams both;
  both.input = both.output = true;
  ChildProcess child({"cat"}, "", both, true);
  ASSERT_EQ(::write(child.input.get(), "word\n", 5), 5);
  pollfd ready{child.output.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&ready, 1, 10000), 1);
  std::array<char, 16> text{};
  EXPECT_EQ(::read(child.output.get(), text.data(), text.size()), 5);
  EXPECT_TRUE(child.running());
  child.end(milliseconds(10000));
  EXPECT_FALSE(child.running());
  EXPECT_EQ(child.status(), 0) << "by itself, not by a signal";
}

TEST(ChildProcess, AProgramThatIsNotThereEndsWith127) {
  ChildProcess child({"no-such-program-anywhere"}, "", {}, true);
  for (int i = 0; i < 1000 && child.running(); ++i) std::this_thread::sleep_for(milliseconds(10));
  EXPECT_EQ(WEXITSTATUS(child.status()), 127);
}

TEST(ChildProcess, OneThatDoesNotEndIsEndedWithItsGroup) {
  ChildProcess child({"sh", "-c", "sleep 1000 & sleep 1000"}, "", {}, true);
  ASSERT_TRUE(child.running());
  child.end(milliseconds(0));
  EXPECT_FALSE(child.running());
  EXPECT_TRUE(WIFSIGNALED(child.status()));
}

TEST(ChildProcess, RunsInTheFolderThatIsAskedFor) {
  EXPECT_EQ(answer_of({"sh", "-c", "cd /; pwd"}, milliseconds(10000)), "/\n");
}

TEST(ChildProcess, AnAnswerThatDoesNotComeIsEmpty) {
  EXPECT_EQ(answer_of({"sleep", "1000"}, milliseconds(50)), "");
  EXPECT_EQ(answer_of({"sh", "-c", "echo no; exit 1"}, milliseconds(10000)), "");
}

}  // namespace
}  // namespace understudy::drivers
