#include "core/process/contained.h"

#include <fcntl.h>
#include <signal.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/interrupt.h"
#include "core/process/pipe.h"
#include "tests/complaint.h"

namespace understudy {
namespace {

using ::testing::StartsWith;
using Work = std::function<std::string()>;

std::string run(const Work& work, const ContainedLimits& limits = {}) {
  return run_contained("reading it", work, limits);
}
std::string refusal(const Work& work, const ContainedLimits& limits = {}) {
  return complaint([&] { run(work, limits); });
}

TEST(Contained, GivesBackWhatTheWorkReturns) {
  const std::string large(3'000'000, 'x');
  EXPECT_EQ(run([&] { return large; }), large);
  EXPECT_EQ(run([] { return std::string("\0a", 2); }), std::string("\0a", 2));
  EXPECT_EQ(run([] { return std::string(); }), "");
}

TEST(Contained, PassesARefusalOn) {
  EXPECT_EQ(refusal([]() -> std::string {
              throw InputError(Place{"m.dae", 3}, "is no mesh");
            }),
            "is no mesh");
}

TEST(Contained, ACrashIsARefusal) {
  EXPECT_THAT(refusal([]() -> std::string {
                ::signal(SIGSEGV, SIG_DFL);  // a sanitizer's handler would report it
                ::raise(SIGSEGV);
                return "";
              }),
              StartsWith("reading it crashed with signal 11 ("));
}

TEST(Contained, WorkWithoutAnEndIsARefusal) {
  EXPECT_EQ(refusal(
                []() -> std::string {
                  std::atomic<long> turns = 0;
                  while (true) ++turns;
                },
                {.seconds = 1}),
            "reading it takes more than 1 s of processor time");
}

TEST(Contained, ALargeAnswerIsARefusal) {
  EXPECT_EQ(refusal([] { return std::string(3'000'000, 'x'); }, {.result = 2'000'000}),
            "reading it makes more than 2 MB");
}

TEST(Contained, MemoryBeyondTheLimitIsARefusal) {
#ifdef UNDERSTUDY_SANITIZED
  GTEST_SKIP() << "a sanitizer maps terabytes";
#endif
  EXPECT_EQ(refusal([] { return std::string(std::vector<char>(600'000'000, 'x').data(), 1); },
                    {.memory = 500'000'000}),
            "reading it needs more than 0.5 GB of memory");
}

TEST(Contained, OpensNoFile) {
#ifdef UNDERSTUDY_SANITIZED
  GTEST_SKIP() << "a sanitizer opens pipes";
#endif
  EXPECT_EQ(run([] { return std::string(::open("/dev/null", O_RDONLY) < 0 ? "refused" : "opened"); }),
            "refused");
}

TEST(Contained, HoldsNothingOpenThatIsNotItsOwn) {
  const Pipe other;
  EXPECT_EQ(run([&] { return std::string(::fcntl(other.write.get(), F_GETFD) < 0 ? "closed" : "open"); }),
            "closed");
}

TEST(Contained, AnInterruptEndsItAtOnce) {
  std::thread user([] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    set_interrupted(true);
  });
  const auto began = std::chrono::steady_clock::now();
  EXPECT_THROW(run([]() -> std::string {
                 std::this_thread::sleep_for(std::chrono::seconds(30));
                 return "";
               }),
               Interrupted);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(10));
  user.join();
  set_interrupted(false);
}

}  // namespace
}  // namespace understudy
