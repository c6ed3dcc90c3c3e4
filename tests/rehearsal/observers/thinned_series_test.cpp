#include "rehearsal/observers/thinned_series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace understudy::rehearsal {
namespace {

using ::testing::ElementsAre;

ThinnedSeries<int> counted(int to, std::size_t capacity) {
  ThinnedSeries<int> series(capacity);
  for (int i = 0; i < to; ++i) series.add(i);
  return series;
}

TEST(ThinnedSeries, KeepsEveryPointWhileTheyFit) {
  EXPECT_THAT(counted(4, 4).points(), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(counted(4, 4).stride(), 1u);
}

TEST(ThinnedSeries, KeepsEveryOtherOneOfThoseThatDoNotFit) {
  EXPECT_THAT(counted(5, 4).points(), ElementsAre(0, 2, 4));
  EXPECT_THAT(counted(8, 4).points(), ElementsAre(0, 2, 4, 6));
  EXPECT_THAT(counted(17, 4).points(), ElementsAre(0, 8, 16));
  EXPECT_EQ(counted(17, 4).stride(), 8u);
  EXPECT_EQ(counted(17, 4).count(), 17u);
}

TEST(ThinnedSeries, HasRoomForTwoAtLeast) { EXPECT_THAT(counted(3, 0).points(), ElementsAre(0, 2)); }

}  // namespace
}  // namespace understudy::rehearsal
