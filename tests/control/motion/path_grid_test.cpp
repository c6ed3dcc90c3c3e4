#include "control/motion/path_grid.h"

#include <cmath>
#include <deque>

#include <gtest/gtest.h>

#include "tests/control/motion/planning_for_test.h"

namespace understudy::control {
namespace {

TEST(PathGrid, TheSlowestAxisLimitsTheSpeed) {
  MotionLimits limits;
  limits.axis_velocity = {0.1, 0.1, 0.03};
  EXPECT_EQ(speed_limit(0.02, {2, -4, 0}, limits, 3), 0.02) << "nothing is too fast";
  EXPECT_DOUBLE_EQ(speed_limit(1, {2, -4, 0}, limits, 3), 0.025);  // 0.1 / 4
  EXPECT_DOUBLE_EQ(speed_limit(1, {2, -4, 3}, limits, 3), 0.01);   // 0.03 / 3
  EXPECT_DOUBLE_EQ(speed_limit(1, {2, -4, 3}, limits, 2), 0.025) << "of a machine of two axes";
}

TEST(PathGrid, ACornerJumpsByAxisAndTheTipAsAVector) {
  PathSegment before, after;
  before.travel = {2, 0, 0}, before.length = 2, before.slope_end = {1, -0.5};
  after.travel = {0, 3, 0}, after.length = 3, after.slope_begin = {0.25, 0.5};
  const ChannelArray jump = corner_jump(before, after, 2);
  EXPECT_DOUBLE_EQ(jump[0], 0.75);
  EXPECT_DOUBLE_EQ(jump[1], 1);
  EXPECT_DOUBLE_EQ(jump[2], std::sqrt(2.0)) << "a right angle";
}

class Pieces : public testing::Test {
 protected:
  std::deque<Piece> pieces_of(double entry_speed, double exit_speed) {
    segment_ = path_.segment(hexapod_.print_to(hexapod_.at({8e-3, 6e-3, 0}), 20e-3, 4), hexapod_.X_WT_home,
                             home(), hexapod_.limits);
    segment_.entry_speed = entry_speed;
    kinematics::AxisVector axes = home();
    EXPECT_EQ(path_.evaluate(segment_, segment_.length, axes, segment_.slope_end),
              kinematics::SolveStatus::ok);
    axes = home();
    EXPECT_EQ(path_.evaluate(segment_, 0, axes, segment_.slope_begin), kinematics::SolveStatus::ok);
    ChannelLimits channels;
    channels.count = path_.channels();
    channels.acceleration.fill(1);
    channels.cycle_time = hexapod_.limits.cycle_time;
    std::deque<Piece> pieces;
    append_pieces(segment_, {9, exit_speed, {}}, path_, {hexapod_.limits, channels}, axes, pieces);
    end_ = axes;
    return pieces;
  }
  kinematics::AxisVector home() const {
    kinematics::AxisVector axes{};
    EXPECT_EQ(hexapod_.mechanism->inverse(hexapod_.machine.X_BT_home, {}, std::span(axes).first(6)),
              kinematics::SolveStatus::ok);
    return axes;
  }

  HexapodForTest hexapod_;
  PathKinematics path_{*hexapod_.mechanism, hexapod_.machine.X_WB};
  PathSegment segment_;
  kinematics::AxisVector end_{};
};

TEST_F(Pieces, CoverTheSegmentWithoutAGap) {
  for (const double entry : {0.0, 5e-3, 20e-3})
    for (const double exit : {0.0, 5e-3, 20e-3}) {
      const std::deque<Piece> pieces = pieces_of(entry, exit);
      double at = 0;
      for (const Piece& piece : pieces) {
        EXPECT_NEAR(piece.begin, at, 1e-15);
        EXPECT_GT(piece.length, 0);
        EXPECT_LE(piece.length, 0.5e-3 + 1e-12);
        EXPECT_EQ(piece.segment, 9u);
        at = piece.begin + piece.length;
      }
      EXPECT_DOUBLE_EQ(at, 10e-3);
    }
  kinematics::AxisVector expected = home();
  ASSERT_EQ(path_.axes(segment_.X_WT_end, expected), kinematics::SolveStatus::ok);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(end_[i], expected[i], 1e-12);
}

TEST_F(Pieces, AreFineOnlyWhereTheSpeedChanges) {
  const std::deque<Piece> steady = pieces_of(20e-3, 20e-3), from_rest = pieces_of(0, 20e-3);
  EXPECT_EQ(steady.size(), 20u);  // 10 mm by 0.5 mm
  // 20 mm/s at 1 m/s^2: 0.2 mm of run-up, in ten pieces and a few that grow.
  EXPECT_LT(from_rest.front().length, 0.03e-3);
  EXPECT_GT(from_rest.back().length, 0.3e-3);
  EXPECT_LT(pieces_of(20e-3, 0).back().length, 0.03e-3);
}

TEST_F(Pieces, OfARestIsOneOfNoLength) {
  PathSegment rest;
  rest.rest = 0.7;
  kinematics::AxisVector axes = home();
  std::deque<Piece> pieces;
  append_pieces(rest, {3, 0, {}}, path_, {hexapod_.limits, {}}, axes, pieces);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].length, 0);
  EXPECT_EQ(pieces[0].rest, 0.7);
  EXPECT_FALSE(pieces[0].corner);
}

}  // namespace
}  // namespace understudy::control
