#include "sim/deposition/unsupported_stretch_recorder.h"

#include <vector>

#include <gtest/gtest.h>

namespace understudy::sim {
namespace {

constexpr double kDiameter = 0.4e-3;

/// An element of 1 mm along x, its tip 20 mm over the table unless said otherwise.
Element element(int number, Adhesion adhesion, bool follows = true, double tip_height = 20e-3) {
  Element e;
  e.bead.adhesion = adhesion;
  e.bead.follows = follows;
  e.bead.length = 1e-3;
  e.bead.volume = 2e-10;
  e.bead.height = e.bead.width = kDiameter;
  e.bead.start_line = e.bead.line = 10 + number;
  e.bead.start_time = number;
  e.bead.time = number + 1;
  e.tip_from_W = Vec3(number * 1e-3, 0, tip_height);
  e.tip_to_W = Vec3((number + 1) * 1e-3, 0, tip_height);
  e.bead.from_W = e.tip_from_W;
  e.bead.to_W = e.tip_to_W;
  e.worst_gap = tip_height + number * 1e-6;
  return e;
}

class UnsupportedStretchRecorderTest : public testing::Test {
 protected:
  const std::vector<UnsupportedStretch>& record(const std::vector<Element>& elements) {
    for (const Element& e : elements) recorder_.add(e, {483, 0.5, 300, false});
    recorder_.finish();
    return recorder_.stretches();
  }
  Workpiece workpiece_{nullptr};
  int done_ = 0;
  UnsupportedStretchRecorder recorder_{workpiece_, 0.05e-3, 0.3e-3,
                                       [this](const UnsupportedStretch&) { ++done_; }};
};

TEST_F(UnsupportedStretchRecorderTest, JoinsConsecutiveElementsOfOneAdhesion) {
  const auto& stretches = record({element(0, Adhesion::sticks, false), element(1, Adhesion::unsupported),
                                  element(2, Adhesion::unsupported), element(3, Adhesion::unsupported),
                                  element(4, Adhesion::sticks)});
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_EQ(done_, 1);
  EXPECT_EQ(stretches[0].line, 11);
  EXPECT_EQ(stretches[0].time, 1);
  EXPECT_NEAR(stretches[0].length, 3e-3, 1e-18);
  EXPECT_NEAR(stretches[0].volume, 6e-10, 1e-24);
  EXPECT_DOUBLE_EQ(stretches[0].worst_gap, 20e-3 + 3e-6);
  EXPECT_EQ(stretches[0].nozzle_temperature, 483);
  EXPECT_EQ(stretches[0].laid_at, (std::vector<double>{1, 2, 3, 4}));
  ASSERT_EQ(stretches[0].path_W.size(), 4u);
  // The middle of the strand is half its diameter below the tip.
  EXPECT_LE((stretches[0].path_W[3] - Vec3(4e-3, 0, 20e-3 - kDiameter / 2)).norm(), 1e-15);
}

TEST_F(UnsupportedStretchRecorderTest, BetweenElementsThatStickItIsHeldAtBothEnds) {
  const auto& stretches = record({element(0, Adhesion::sticks, false), element(1, Adhesion::unsupported),
                                  element(2, Adhesion::fused), element(3, Adhesion::unsupported)});
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_TRUE(stretches[0].held_at_start);
  EXPECT_TRUE(stretches[0].held_at_end);
  EXPECT_TRUE(stretches[1].held_at_start);
  EXPECT_FALSE(stretches[1].held_at_end) << "it ends in the air";
}

TEST_F(UnsupportedStretchRecorderTest, APauseEndsAStretchAndNothingHoldsTheNext) {
  const auto& stretches = record({element(0, Adhesion::sticks, false), element(1, Adhesion::unsupported),
                                  element(2, Adhesion::unsupported, false)});
  ASSERT_EQ(stretches.size(), 2u);
  EXPECT_FALSE(stretches[0].held_at_end);
  EXPECT_FALSE(stretches[1].held_at_start);
}

TEST_F(UnsupportedStretchRecorderTest, AnEndThatTouchesTheTableIsHeld) {
  // The strand's lower side is at 20 um over the table, within the reach of 50 um.
  const auto& stretches = record({element(0, Adhesion::unsupported, false, kDiameter + 20e-6)});
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_TRUE(stretches[0].held_at_start);
  EXPECT_TRUE(stretches[0].held_at_end);
}

TEST_F(UnsupportedStretchRecorderTest, ABuriedStretchKeepsTheDeepestGapAndNoPath) {
  Element shallow = element(0, Adhesion::buried, false), deep = element(1, Adhesion::buried);
  shallow.worst_gap = -0.02e-3;
  deep.worst_gap = -0.05e-3;
  const auto& stretches = record({shallow, deep});
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_EQ(stretches[0].worst_gap, -0.05e-3);
  EXPECT_TRUE(stretches[0].path_W.empty());
}

TEST_F(UnsupportedStretchRecorderTest, IsNoNarrowerThanTheRowThatItGoesOnFrom) {
  Element row = element(0, Adhesion::sticks, false);
  row.bead.width = 0.7e-3;
  EXPECT_EQ(record({row, element(1, Adhesion::unsupported)})[0].width, 0.7e-3);
}

// A bead of 3 mm that hangs is no shorter for the drops in which it begins and ends.
TEST_F(UnsupportedStretchRecorderTest, ADropAtItsEndMakesItNoWider) {
  Element first = element(0, Adhesion::unsupported, false), last = element(4, Adhesion::unsupported);
  for (Element* drop : {&first, &last}) {
    drop->bead.length = 0.1e-3;
    drop->bead.width = 2e-3;
  }
  const auto& stretch = record({first, element(1, Adhesion::unsupported), element(2, Adhesion::unsupported),
                                element(3, Adhesion::unsupported), last})[0];
  EXPECT_NEAR(stretch.width, (3e-3 * kDiameter + 2 * 0.1e-3 * 2e-3) / 3.2e-3, 1e-12);
}

TEST_F(UnsupportedStretchRecorderTest, ADropThatSticksMakesWhatFollowsNoWider) {
  Element drop = element(0, Adhesion::sticks, false);
  drop.bead.width = 3e-3;
  EXPECT_DOUBLE_EQ(record({drop, element(1, Adhesion::unsupported)})[0].width, 2 * kDiameter);
}

}  // namespace
}  // namespace understudy::sim
