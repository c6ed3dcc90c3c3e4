#include "core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/interrupt.h"

namespace understudy {
namespace {

TEST(InParallel, DoesEachJobOnceAndCountsThem) {
  for (const int threads : {0, 1, 3, 8}) {
    std::vector<int> runs(100, 0);
    std::vector<std::size_t> finished;
    in_parallel(
        runs.size(), threads, [&](std::size_t i) { ++runs[i]; },
        [&](std::size_t, std::size_t n) { finished.push_back(n); });
    EXPECT_EQ(std::count(runs.begin(), runs.end(), 1), 100) << threads << " threads";
    ASSERT_EQ(finished.size(), 100u);
    EXPECT_TRUE(std::is_sorted(finished.begin(), finished.end()));
    EXPECT_EQ(finished.back(), 100u);
  }
  in_parallel(0, 4, [](std::size_t) { FAIL() << "there is no job"; });
}

TEST(InParallel, GivesEachThreadAWorkerOfItsOwn) {
  std::atomic<int> workers{0};
  std::vector<int> by(40, -1);
  in_parallel_with(by.size(), 3, [&] {
    const int number = workers++;
    return IndexedWork([&by, number](std::size_t i) { by[i] = number; });
  });
  EXPECT_LE(workers, 3);
  EXPECT_TRUE(std::all_of(by.begin(), by.end(), [&](int n) { return n >= 0 && n < workers; }));
}

TEST(InParallel, ThrowsWhatTheFirstJobInOrderThrew) {
  std::atomic<int> begun{0};
  const auto fail = [&](std::size_t i) {
    ++begun;
    if (i >= 3) throw std::runtime_error(std::to_string(i));
  };
  for (const int threads : {1, 4}) {
    begun = 0;
    try {
      in_parallel(1000, threads, fail);
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), std::string("3"));
    }
    EXPECT_LT(begun, 20) << "after a failure no further job begins";
  }
}

TEST(InParallel, StopsAtAnInterrupt) {
  set_interrupted(true);
  EXPECT_THROW(in_parallel(5, 2, [](std::size_t) { FAIL() << "a job ran"; }), Interrupted);
  set_interrupted(false);
}

TEST(HardwareThreads, AreOneAtLeast) { EXPECT_GE(hardware_threads(), 1); }

}  // namespace
}  // namespace understudy
