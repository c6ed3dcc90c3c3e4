// A guard that counts nothing would pass every test.
#include "tests/guard/cycle_guard.h"

#include <fstream>
#include <iostream>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include <gtest/gtest.h>

#include "core/frames.h"

namespace understudy {
namespace {

TEST(CycleGuard, CountsAllocationsHoweverTheyAreMade) {
  EXPECT_EQ(calls_of([] {}), Calls{});
  std::unique_ptr<int> kept;
  EXPECT_EQ(calls_of([&] { kept = std::make_unique<int>(1); }).allocations, 1) << *kept;
  Eigen::VectorXd vector;
  EXPECT_EQ(calls_of([&] { vector.resize(20); }).allocations, 1) << vector.size();
  std::vector<int> numbers;
  EXPECT_EQ(calls_of([&] { numbers.resize(100); }).allocations, 1) << numbers.size();
  void* volatile plain = nullptr;  // clang drops an allocation that nobody looks at
  EXPECT_EQ(calls_of([&] { plain = std::calloc(3, 7); }).allocations, 1);
  EXPECT_EQ(calls_of([&] { plain = std::realloc(plain, 4096); }).allocations, 1);
  std::free(plain);
  struct alignas(64) Wide {
    double values[8];
  };
  std::unique_ptr<Wide> wide;
  EXPECT_EQ(calls_of([&] { wide = std::make_unique<Wide>(); }).allocations, 1) << wide->values[0];
}

TEST(CycleGuard, CountsLocks) {
  if (!counts_locks_and_io()) GTEST_SKIP() << "a sanitizer stands in front of the C library";
  std::mutex mutex;
  EXPECT_EQ(calls_of([&] { const std::lock_guard lock(mutex); }), (Calls{0, 1, 0}));
  std::shared_mutex shared;
  EXPECT_EQ(calls_of([&] { const std::shared_lock lock(shared); }), (Calls{0, 1, 0}));
  EXPECT_EQ(calls_of([&] { const std::unique_lock lock(shared); }), (Calls{0, 1, 0}));
}

TEST(CycleGuard, CountsInputAndOutputOfStreamsAsWell) {
  if (!counts_locks_and_io()) GTEST_SKIP() << "a sanitizer stands in front of the C library";
  EXPECT_GE(calls_of([] { std::cout << "a line of the guard's own test" << std::endl; }).io, 1);
  EXPECT_GE(calls_of([] { std::ofstream("/dev/null") << "text"; }).io, 2);  // opened and written
  EXPECT_GE(calls_of([] {
              int number = 0;
              std::ifstream("/dev/zero") >> number;
            }).io,
            2);
}

}  // namespace
}  // namespace understudy
