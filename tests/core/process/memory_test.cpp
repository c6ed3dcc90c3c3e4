#include "core/process/memory.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include <gtest/gtest.h>

namespace understudy {
namespace {

TEST(AvailableMemory, IsSomeAndNotMoreThanThereIs) {
  const auto pages = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES));
  EXPECT_GT(available_memory(), 1'000'000u);
  EXPECT_LE(available_memory(), pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)));
}

TEST(AvailableMemory, KeepsToTheLimitOfTheProcess) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const auto used = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    const rlimit limit{used + 50'000'000, used + 50'000'000};
    ::setrlimit(RLIMIT_AS, &limit);
    const std::uint64_t left = available_memory();
    ::_exit(left < 60'000'000 && left > 30'000'000 ? 0 : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace understudy
