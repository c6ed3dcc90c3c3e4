#include "core/thread_limit.h"

#include <gtest/gtest.h>

#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>

#include "core/parallel.h"

namespace understudy {
namespace {

class ThreadLimit : public testing::Test {
 protected:
  ~ThreadLimit() override { limit_threads(std::numeric_limits<int>::max()); }
};

std::set<std::thread::id> threads_of_jobs(int wanted) {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  in_parallel(100, wanted, [&](std::size_t) {
    std::this_thread::yield();
    const std::lock_guard lock(mutex);
    seen.insert(std::this_thread::get_id());
  });
  return seen;
}

TEST_F(ThreadLimit, OfOneLeavesAllJobsToTheThreadThatAsks) {
  limit_threads(1);
  EXPECT_EQ(thread_limit(), 1);
  EXPECT_EQ(threads_of_jobs(8), std::set{std::this_thread::get_id()});
}

TEST_F(ThreadLimit, BoundsTheThreadsOfJobs) {
  limit_threads(2);
  for (int trial = 0; trial < 50; ++trial) EXPECT_LE(threads_of_jobs(8).size(), 2u);
}

TEST_F(ThreadLimit, IsOneAtLeast) { EXPECT_THROW(limit_threads(0), std::logic_error); }

}  // namespace
}  // namespace understudy
