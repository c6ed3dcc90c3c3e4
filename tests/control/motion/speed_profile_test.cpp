#include "control/motion/speed_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.h"

namespace understudy::control {
namespace {

ChannelLimits limits_of(int channels, double acceleration, double cycle_time) {
  ChannelLimits limits;
  limits.count = channels;
  limits.acceleration.fill(acceleration);
  limits.cycle_time = cycle_time;
  return limits;
}

Piece straight_piece(double length, double speed_max) {
  Piece piece;
  piece.length = length;
  piece.speed_max = piece.node_speed_max = speed_max;
  piece.slope_begin[0] = piece.slope_end[0] = 1;
  return piece;
}

// A circle run through at s, its x and y as channels: q' = (cos, sin)(s / radius).
std::deque<Piece> circle(double radius, int count, double speed_max) {
  std::deque<Piece> pieces;
  const double step = 2 * std::numbers::pi / count;
  for (int n = 0; n < count; ++n) {
    Piece piece = straight_piece(radius * step, speed_max);
    piece.slope_begin = {std::cos(n * step), std::sin(n * step)};
    piece.slope_end = {std::cos((n + 1) * step), std::sin((n + 1) * step)};
    pieces.push_back(piece);
  }
  return pieces;
}

// |q' u + q'' x| at both ends of each piece, from the result alone.
double worst_acceleration(const std::deque<Piece>& pieces, std::size_t channels) {
  double worst = 0;
  for (const Piece& p : pieces) {
    const double u = (p.end_speed2 - p.node_speed2) / (2 * p.length);
    for (std::size_t i = 0; i < channels; ++i) {
      const double curvature = (p.slope_end[i] - p.slope_begin[i]) / p.length;
      worst = std::max(worst, std::abs(p.slope_begin[i] * u + curvature * p.node_speed2));
      worst = std::max(worst, std::abs(p.slope_end[i] * u + curvature * p.end_speed2));
    }
  }
  return worst;
}

// v^2 = 2 a s from either end, met in the middle.
TEST(SpeedProfile, RestToRestOnALineIsSymmetricAndAtFullAcceleration) {
  std::deque<Piece> pieces;
  for (int n = 0; n < 100; ++n) pieces.push_back(straight_piece(1e-4, 10));
  plan_speeds(pieces, 0, limits_of(1, 2.0, 1e-3));
  for (std::size_t n = 0; n < 100; ++n) {
    const double s = 1e-4 * static_cast<double>(n);
    EXPECT_NEAR(pieces[n].node_speed2, 2 * 2.0 * std::min(s, 0.01 - s), 1e-12);
  }
  EXPECT_EQ(pieces.back().end_speed2, 0);
}

// Where the circle runs along an axis, the other channel has all of a for v^2/r: x = a r. From there, with
// that channel at its bound, u sin(t) + x cos(t)/r = a integrates to x = 2 a r / (1 + cos t), up to t = 45
// degrees. Pieces of half a degree: the chord of the slopes is short by 1e-5, the first piece after t = 0
// costs 1e-3.
TEST(SpeedProfile, CircleIsTakenAtTheClosedFormOfTheTimeOptimum) {
  const double radius = 0.02, a = 1.5;
  auto pieces = circle(radius, 720, 10);
  plan_speeds(pieces, 0, limits_of(2, a, 1e-3));
  // The first and last quarter are for getting up to speed and back.
  for (std::size_t node = 180; node <= 540; node += 15) {
    const std::size_t from_quarter = std::min(node % 180, 180 - node % 180);
    const double t = 2 * std::numbers::pi * static_cast<double>(from_quarter) / 720;
    const double expected = 2 * a * radius / (1 + std::cos(t));
    EXPECT_NEAR(pieces[node].node_speed2, expected, 3e-3 * expected) << "node " << node;
  }
  EXPECT_LE(worst_acceleration(pieces, 2), a * (1 + 1e-9));
}

// q' = 0 and q'' = 50 /m at the first node: whatever u is, 50 x <= a. The other channel leaves u free.
TEST(SpeedProfile, ChannelThatStandsStillBoundsTheSpeedByItsCurvatureAlone) {
  std::deque<Piece> pieces;
  for (int n = 0; n < 50; ++n) {
    Piece piece = straight_piece(1e-4, 10);
    piece.slope_begin[1] = 50 * 1e-4 * n;
    piece.slope_end[1] = 50 * 1e-4 * (n + 1);
    pieces.push_back(piece);
  }
  ChannelLimits limits = limits_of(2, 1e6, 1e-3);
  limits.acceleration[1] = 1;
  plan_speeds(pieces, 100, limits);
  EXPECT_NEAR(pieces[0].node_speed2, 1.0 / 50, 1e-12);
}

TEST(SpeedProfile, RandomPathsStayWithinEveryBound) {
  Random random(41, "profiles");
  for (int trial = 0; trial < 200; ++trial) {
    std::deque<Piece> pieces;
    ChannelArray slope{};
    for (int i = 0; i < 7; ++i) slope[static_cast<std::size_t>(i)] = random.uniform(-1, 1);
    for (int n = 0; n < 60; ++n) {
      Piece piece = straight_piece(std::pow(10, random.uniform(-6, -3)), random.uniform(0.001, 0.3));
      piece.slope_begin = slope;
      for (int i = 0; i < 7; ++i)
        slope[static_cast<std::size_t>(i)] += piece.length * random.uniform(-100, 100);
      piece.slope_end = slope;
      pieces.push_back(piece);
    }
    plan_speeds(pieces, 0, limits_of(7, 1.0, 1e-3));
    ASSERT_LE(worst_acceleration(pieces, 7), 1 + 1e-9) << "trial " << trial;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      ASSERT_LE(std::sqrt(pieces[n].node_speed2), pieces[n].speed_max * (1 + 1e-12));
      ASSERT_TRUE(n == 0 || pieces[n].node_speed2 > 0) << "stands still at " << n << " in trial " << trial;
    }
  }
}

// Path of 10 um pieces with corners of jump 1 at two nodes: a = 1 m/s^2 and T = 1 ms allow 1 mm/s, half of it
// here.
double speed_at_two_corners(double apart) {
  std::deque<Piece> pieces{straight_piece(1e-5, 1), straight_piece(apart, 1), straight_piece(1e-5, 1)};
  for (const std::size_t k : {1u, 2u}) pieces[k].corner = true, pieces[k].jump[0] = 1;
  limit_corners(pieces, limits_of(1, 1.0, 1e-3));
  EXPECT_EQ(pieces[1].node_speed_max, pieces[2].node_speed_max);
  return pieces[1].node_speed_max;
}

TEST(SpeedProfile, CornersOfOneCycleShareWhatOneMayTakeAlone) {
  EXPECT_DOUBLE_EQ(speed_at_two_corners(1e-5), 0.5e-3);   // 20 cycles apart: each for itself
  EXPECT_DOUBLE_EQ(speed_at_two_corners(2e-7), 0.25e-3);  // both in one cycle
}

TEST(SpeedProfile, PiecesAroundACornerLeaveItItsShare) {
  std::deque<Piece> pieces;
  for (int n = 0; n < 20; ++n) pieces.push_back(straight_piece(1e-6, 1));
  pieces[10].corner = true;
  pieces[10].jump[0] = 1;
  const ChannelLimits limits = limits_of(1, 1.0, 1e-3);
  limit_corners(pieces, limits);
  EXPECT_DOUBLE_EQ(pieces[9].used[0], limits.corner_share);
  EXPECT_DOUBLE_EQ(pieces[10].used[0], limits.corner_share);
  EXPECT_EQ(pieces[5].used[0], 0);
  EXPECT_EQ(pieces[15].used[0], 0);
}

TEST(SpeedProfile, CornersOnBothSidesOfAStopAreNotOfOneCycle) {
  std::deque<Piece> pieces{straight_piece(1e-5, 1), straight_piece(1e-7, 1), straight_piece(1e-7, 1),
                           straight_piece(1e-5, 1)};
  for (const std::size_t k : {1u, 3u}) pieces[k].corner = true, pieces[k].jump[0] = 1;
  pieces[2].node_speed_max = 0;
  limit_corners(pieces, limits_of(1, 1.0, 1e-3));
  EXPECT_DOUBLE_EQ(pieces[1].node_speed_max, 0.5e-3);
  EXPECT_DOUBLE_EQ(pieces[3].node_speed_max, 0.5e-3);
  EXPECT_EQ(pieces[2].node_speed_max, 0);
}

std::deque<Piece> with_a_rest(double arrival, double departure) {
  std::deque<Piece> pieces;
  for (int n = 0; n < 21; ++n) pieces.push_back(straight_piece(n == 10 ? 0 : 1e-4, 0.05));
  pieces[10].rest = 0.3;
  pieces[10].node_speed_max = arrival;
  pieces[11].node_speed_max = departure;
  return pieces;
}

// v^2 = v0^2 + 2 a s on either side.
TEST(SpeedProfile, ARestIsMetAndLeftWithTheSpeedsThatItAllows) {
  std::deque<Piece> pieces = with_a_rest(2e-3, 3e-3);
  plan_speeds(pieces, 0, limits_of(1, 1.0, 1e-3));
  EXPECT_NEAR(pieces[9].end_speed2, 4e-6, 1e-12);
  EXPECT_NEAR(pieces[10].node_speed2, 4e-6, 1e-12);
  EXPECT_NEAR(pieces[11].node_speed2, 9e-6, 1e-12);
  EXPECT_NEAR(pieces[8].node_speed2, 4e-6 + 2 * 2e-4, 1e-12);
  EXPECT_NEAR(pieces[12].end_speed2, 9e-6 + 2 * 2e-4, 1e-12);
}

TEST(SpeedProfile, RestBringsTheSpeedToNothingOnBothSides) {
  std::deque<Piece> pieces = with_a_rest(0, 0);
  plan_speeds(pieces, 0, limits_of(1, 1.0, 1e-3));
  EXPECT_EQ(pieces[10].node_speed2, 0);
  EXPECT_EQ(pieces[11].node_speed2, 0);
  EXPECT_EQ(pieces[10].duration(), 0.3);
  EXPECT_GT(pieces[5].node_speed2, 0);
  EXPECT_GT(pieces[15].node_speed2, 0);
}

}  // namespace
}  // namespace understudy::control
