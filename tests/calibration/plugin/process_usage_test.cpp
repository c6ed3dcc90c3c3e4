#include "calibration/plugin/process_usage.h"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace understudy::calibration {
namespace {

/// A shell at work, killed with its group.
class Shell {
 public:
  explicit Shell(const char* script) {
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const std::array<const char*, 4> words{"/bin/sh", "-c", script, nullptr};
    EXPECT_EQ(posix_spawn(&pid_, words[0], nullptr, &attributes, const_cast<char**>(words.data()), environ),
              0);
    posix_spawnattr_destroy(&attributes);
  }
  ~Shell() {
    ::kill(-pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  pid_t pid() const { return pid_; }

  /// The first usage that is so, within 10 s.
  template <typename Is>
  ProcessUsage until(const Is& is) const {
    ProcessUsage usage = usage_of(pid_);
    for (int tries = 0; tries < 1000 && !is(usage); ++tries) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      usage = usage_of(pid_);
    }
    return usage;
  }

 private:
  pid_t pid_ = -1;
};

TEST(ProcessUsage, CountsChildrenAndTheirChildren) {
  const Shell shell("sleep 20 & sh -c 'sleep 20; :' & wait");
  const ProcessUsage usage = shell.until([](const ProcessUsage& u) { return u.tasks >= 4; });
  EXPECT_EQ(usage.tasks, 4);
  EXPECT_GT(usage.memory, 4u * 100'000) << "a shell has some hundred kilobytes";
  EXPECT_LT(usage.memory, 4u * 100'000'000);
  EXPECT_LT(usage.cpu_time, 1) << "they sleep";
}

TEST(ProcessUsage, CountsTheTimeOfChildrenThatHaveEnded) {
  const Shell shell("sh -c 'i=0; while [ $i -lt 300000 ]; do i=$((i + 1)); done'; sleep 20; :");
  const ProcessUsage usage = shell.until([](const ProcessUsage& u) { return u.cpu_time >= 0.03; });
  EXPECT_GE(usage.cpu_time, 0.03);
  EXPECT_LT(usage.cpu_time, 10);
}

TEST(ProcessUsage, CountsThreadsAndWhatTheyAdd) {
  const int before = usage_of(::getpid()).tasks;
  std::atomic<bool> done = false;
  std::thread other([&] {
    while (!done) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  EXPECT_EQ(usage_of(::getpid()).tasks, before + 1);
  done = true;
  other.join();
  const std::string held(50'000'000, 'x');
  EXPECT_GT(usage_of(::getpid()).memory, held.size());
}

TEST(ProcessUsage, OfNoProcessIsNothing) {
  const ProcessUsage usage = usage_of(-5);
  EXPECT_EQ(usage.tasks, 0);
  EXPECT_EQ(usage.memory, 0u);
}

}  // namespace
}  // namespace understudy::calibration
