#include "core/progress_meter.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace understudy {
namespace {

/// Of a task that goes evenly through `seconds`, told every `every` seconds: what is shown, and when.
std::vector<std::pair<double, std::string>> shown_of(ProgressPace::To to, double seconds, double every) {
  ProgressPace pace(to, 100);
  std::vector<std::pair<double, std::string>> shown;
  for (int i = 0; i * every <= seconds; ++i)
    if (const auto text = pace.update(i * every / seconds, "printing", 100 + i * every))
      shown.emplace_back(i * every, *text);
  return shown;
}

TEST(ProgressMeter, AnEvenTaskIsAsLongAsItSays) {
  ProgressMeter meter(1000);
  meter.update(0.25, "printing", 1010);
  EXPECT_DOUBLE_EQ(*meter.rate(), 0.025);
  EXPECT_DOUBLE_EQ(*meter.left(), 30);
  EXPECT_EQ(meter.text(), " 25 % printing, 2.5 %/s, 0:30 left");
}

TEST(ProgressMeter, RateCountsWhatTheTaskCountsInTheUnitOfTimeThatFits) {
  ProgressMeter fast(0, {"machines", 200});
  fast.update(0.5, "machine 100 of 200", 20);
  EXPECT_EQ(fast.text(), " 50 % machine 100 of 200, 5.0 machines/s, 0:20 left");
  ProgressMeter slow(0, {"machines", 200});
  slow.update(0.01, "machine 2 of 200", 30);  // 4 a minute: 198 take 49.5 minutes
  EXPECT_EQ(slow.text(), "  1 % machine 2 of 200, 4.0 machines/min, 49:30 left");
  ProgressMeter slowest(0, {"machines", 10});
  slowest.update(0.1, "machine 1 of 10", 1800);  // 2 an hour
  EXPECT_EQ(slowest.text(), " 10 % machine 1 of 10, 2.0 machines/h, 4:30:00 left");
}

TEST(ProgressMeter, SaysNothingOfRateBeforeWorkWasSeen) {
  ProgressMeter meter(0);
  EXPECT_FALSE(meter.rate());
  meter.update(0, "reading", 5);
  EXPECT_FALSE(meter.rate());
  EXPECT_FALSE(meter.left());
  EXPECT_EQ(meter.text(), "  0 % reading");
}

TEST(ProgressMeter, WhatAnEarlierRunHasDoneIsNoRate) {
  ProgressMeter meter(0, {"machines", 100});
  for (int i = 1; i <= 60; ++i) meter.update(i / 100., "resumed", 0.005 * i);
  EXPECT_FALSE(meter.rate());
  meter.update(0.61, "machine 61 of 100", 10.3);  // one machine in ten seconds; 39 are left
  EXPECT_NEAR(*meter.left(), 390, 1e-6);
}

TEST(ProgressMeter, FollowsATaskThatSlowsDown) {
  ProgressMeter meter(0);
  double share = 0;
  for (int second = 1; second <= 10; ++second) meter.update(share += 0.05, "fast", second);
  for (int second = 11; second <= 60; ++second) meter.update(share += 0.001, "slow", second);
  EXPECT_NEAR(*meter.rate(), 0.001, 1e-9);
}

TEST(ProgressMeter, ASmallerShareBeginsANewTask) {
  ProgressMeter meter(0);
  meter.update(1, "first", 100);
  meter.update(0, "second", 101);
  EXPECT_FALSE(meter.rate());
  meter.update(0.1, "second", 111);
  EXPECT_NEAR(*meter.left(), 90, 1e-9);
}

TEST(ProgressMeter, ADoneTaskHasNothingLeft) {
  ProgressMeter meter(0);
  meter.update(1.5, "done", 10);
  EXPECT_EQ(meter.text(), "100 % done, 10.0 %/s, 0:00 left");
}

TEST(ProgressPace, APipeGetsALineEveryTenSecondsAndNoneOfAShortTask) {
  const auto shown = shown_of(ProgressPace::To::pipe, 45, 0.5);
  ASSERT_EQ(shown.size(), 4U);
  for (std::size_t i = 0; i < shown.size(); ++i)
    EXPECT_DOUBLE_EQ(shown[i].first, 10. * static_cast<double>(i + 1));
  EXPECT_EQ(shown[0].second, " 22 % printing, 2.2 %/s, 0:35 left");
  EXPECT_TRUE(shown_of(ProgressPace::To::pipe, 9.5, 0.5).empty());
}

TEST(ProgressPace, APipeIsToldTooThatNothingHasMovedSinceTheLastLine) {
  ProgressPace pace(ProgressPace::To::pipe, 0);
  EXPECT_TRUE(pace.update(0.5, "solving", 10));
  EXPECT_TRUE(pace.update(0.5, "solving", 20));
}

TEST(ProgressPace, ATerminalIsRewrittenAtMostTenTimesASecond) {
  const auto shown = shown_of(ProgressPace::To::terminal, 10, 0.01);
  EXPECT_GT(shown.size(), 90U);
  EXPECT_LE(shown.size(), 101U);
  EXPECT_DOUBLE_EQ(shown.front().first, 0);
}

TEST(ProgressPace, ATerminalIsNotRewrittenWithTheSame) {
  ProgressPace pace(ProgressPace::To::terminal, 0);
  EXPECT_TRUE(pace.update(0, "reading", 0));
  EXPECT_FALSE(pace.update(0, "reading", 5));
}

}  // namespace
}  // namespace understudy
