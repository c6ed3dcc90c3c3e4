#include "core/process/memory.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <thread>
#include <vector>

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

double resident_mb() {
  std::uint64_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return 1e-6 * static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

// Small pieces with one between them that stays: without it the allocator keeps them all.
TEST(ReturnFreeMemory, GivesBackWhatAnotherThreadHasFreed) {
#ifdef UNDERSTUDY_SANITIZED
  GTEST_SKIP() << "the sanitizer has an allocator of its own";
#endif
  const double before = resident_mb();
  std::unique_ptr<char[]> stays;
  std::thread([&] {
    std::vector<std::unique_ptr<char[]>> pieces;
    for (int i = 0; i < 100'000; ++i) {
      pieces.push_back(std::make_unique<char[]>(1000));
      pieces.back()[0] = 1;
    }
    stays = std::move(pieces.back());
  }).join();
  const double freed = resident_mb();
  return_free_memory();
  EXPECT_GT(freed, before + 50) << "nothing was kept, so that this test says nothing";
  EXPECT_LT(resident_mb(), before + 10);
}

}  // namespace
}  // namespace understudy
