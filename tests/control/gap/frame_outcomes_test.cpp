#include "control/gap/frame_outcomes.h"

#include <gtest/gtest.h>

namespace understudy::control {
namespace {

TEST(FrameOutcomes, AreBlindFromMoreThanHalfOn) {
  FrameOutcomes frames;
  EXPECT_FALSE(frames.blind());
  for (int i = 0; i < 12; ++i) frames.add(GapStop::no_dot);
  EXPECT_EQ(frames.missed(), 12);
  EXPECT_FALSE(frames.blind());
  frames.add(GapStop::no_dot);
  EXPECT_TRUE(frames.blind());
}

TEST(FrameOutcomes, ForgetWhatIsOlderThanTheLastOnes) {
  FrameOutcomes frames;
  for (int i = 0; i < 20; ++i) frames.add(GapStop::saturated);
  for (int i = 0; i < FrameOutcomes::kFrames; ++i) frames.add(GapStop::none);
  EXPECT_EQ(frames.missed(), 0);
}

TEST(FrameOutcomes, NameTheReasonThatMostHad) {
  FrameOutcomes frames;
  for (int i = 0; i < 7; ++i) frames.add(GapStop::saturated);
  for (int i = 0; i < 9; ++i) frames.add(GapStop::partly_hidden);
  EXPECT_EQ(frames.reason(), GapStop::partly_hidden);
}

}  // namespace
}  // namespace understudy::control
