#include "core/batch_thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <numeric>
#include <set>
#include <stdexcept>

namespace understudy {
namespace {

constexpr std::chrono::milliseconds kWhile{1};

std::vector<int> first(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Works the first numbers off, in batches of seven, and returns on which threads that was.
std::set<std::thread::id> threads_of_work(int count) {
  std::vector<int> seen;
  std::set<std::thread::id> threads;
  BatchThread<int> stage(
      [&](std::vector<int>& batch) {
        seen.insert(seen.end(), batch.begin(), batch.end());
        threads.insert(std::this_thread::get_id());
      },
      7);
  for (int i = 0; i < count; ++i) stage.push(i);
  stage.drain();
  EXPECT_EQ(seen, first(count));
  return threads;
}

TEST(BatchThread, WorksItemsOffInTheirOrderOnOneOtherThread) {
  const auto threads = threads_of_work(1000);
  EXPECT_EQ(threads.size(), 1u);
  EXPECT_FALSE(threads.contains(std::this_thread::get_id()));
}

TEST(BatchThread, ABatchIsAsLargeAsAskedForAndTheLastHoldsTheRest) {
  std::vector<std::size_t> sizes;
  BatchThread<int> stage([&](std::vector<int>& batch) { sizes.push_back(batch.size()); }, 4);
  for (int i = 0; i < 10; ++i) stage.push(i);
  stage.drain();
  EXPECT_EQ(sizes, (std::vector<std::size_t>{4, 4, 2}));
}

// Of batches of one: one at work, two that wait; the fourth must wait for the first to end.
TEST(BatchThread, PushWaitsWhileAsManyBatchesWaitAsMay) {
  std::atomic<bool> may_go = false;
  std::atomic<int> pushed = 0;
  BatchThread<int> stage(
      [&](std::vector<int>&) {
        while (!may_go) std::this_thread::sleep_for(kWhile);
      },
      1, 2);
  std::thread pusher([&] {
    for (int i = 0; i < 8; ++i) {
      stage.push(i);
      ++pushed;
    }
  });
  std::this_thread::sleep_for(50 * kWhile);
  EXPECT_LE(pushed, 3);
  may_go = true;
  pusher.join();
  stage.drain();
  EXPECT_EQ(pushed, 8);
}

void throws_what_the_work_threw_each_time() {
  int worked_off = 0;
  BatchThread<int> stage(
      [&](std::vector<int>& batch) {
        for (const int item : batch) {
          if (item == 5) throw std::out_of_range("five");
          ++worked_off;
        }
      },
      2);
  for (int i = 0; i < 8; ++i) {
    try {
      stage.push(i);
    } catch (const std::out_of_range&) {
      EXPECT_GT(i, 5);  // not before the item was there
    }
  }
  EXPECT_THROW(stage.drain(), std::out_of_range);
  EXPECT_THROW(stage.drain(), std::out_of_range);
  EXPECT_EQ(worked_off, 5);
}

TEST(BatchThread, AfterTheWorkHasThrownNothingIsWorkedOffAnyMore) { throws_what_the_work_threw_each_time(); }

class BatchThreadOfOne : public testing::Test {
 protected:
  BatchThreadOfOne() { limit_threads(1); }
  ~BatchThreadOfOne() override { limit_threads(std::numeric_limits<int>::max()); }
};

TEST_F(BatchThreadOfOne, WorksOnTheCallersThread) {
  EXPECT_EQ(threads_of_work(100), std::set{std::this_thread::get_id()});
}

TEST_F(BatchThreadOfOne, ThrowsAlike) { throws_what_the_work_threw_each_time(); }

}  // namespace
}  // namespace understudy
