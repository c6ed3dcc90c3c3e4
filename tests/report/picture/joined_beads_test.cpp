#include "report/picture/joined_beads.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/frames.h"

namespace understudy::report {
namespace {

sim::Bead bead(const Vec3& from, const Vec3& to, double width = 0.4e-3) {
  sim::Bead b;
  for (int i = 0; i < 3; ++i) {
    b.from_W[static_cast<std::size_t>(i)] = static_cast<float>(from[i]);
    b.to_W[static_cast<std::size_t>(i)] = static_cast<float>(to[i]);
  }
  b.width = static_cast<float>(width);
  b.height = 0.15e-3f;
  return b;
}

Vec3 at(const std::array<float, 3>& p) { return Vec3(p[0], p[1], p[2]); }

double distance(const Vec3& p, const sim::Bead& piece) {
  const Vec3 a = at(piece.from_W), way = at(piece.to_W) - a;
  return (p - a - std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0) * way).norm();
}

TEST(JoinedBeads, AStraightLineIsOnePiece) {
  sim::BeadIndex beads;
  for (int i = 0; i < 50; ++i) beads.add(bead(Vec3(1e-3 * i, 0, 0), Vec3(1e-3 * (i + 1), 0, 0)));
  const auto pieces = joined_beads(beads);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_NEAR(at(pieces[0].to_W).x(), 50e-3, 1e-8);
}

// A line over a bottle of 31 mm: its chord of 5 mm would run 0.2 mm below the glass.
TEST(JoinedBeads, AnArcStaysWhereItWasLaid) {
  sim::BeadIndex beads;
  const auto point = [](int i) {
    const double a = std::numbers::pi * i / 400;
    return Vec3(15.5e-3 * std::sin(a), 0, 15.5e-3 * std::cos(a));
  };
  for (int i = 0; i < 200; ++i) beads.add(bead(point(i), point(i + 1)));
  const auto pieces = joined_beads(beads);
  EXPECT_LT(pieces.size(), 100u);
  for (int i = 0; i <= 200; ++i) {
    double nearest = HUGE_VAL;
    for (const sim::Bead& piece : pieces) nearest = std::min(nearest, distance(point(i), piece));
    EXPECT_LT(nearest, 1.01 * kJoinedOff) << i;
  }
}

TEST(JoinedBeads, OtherWidthsGapsAndTimesBeginAnew) {
  sim::BeadIndex beads;
  beads.add(bead(Vec3(0, 0, 0), Vec3(1e-3, 0, 0)));
  beads.add(bead(Vec3(1e-3, 0, 0), Vec3(2e-3, 0, 0), 0.8e-3));
  beads.add(bead(Vec3(2.1e-3, 0, 0), Vec3(3e-3, 0, 0), 0.8e-3));
  beads.add(bead(Vec3(3e-3, 0, 0), Vec3(2.5e-3, 0, 0), 0.8e-3));
  EXPECT_EQ(joined_beads(beads).size(), 4u)
      << "the last turns back: its end lies on the piece, its start beyond";
  EXPECT_EQ(joined_beads(beads, -1).size(), 0u);
}

}  // namespace
}  // namespace understudy::report
