#include "sim/deposition/lone_strand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/deposition/bead_section.h"
#include "tests/sim/deposition/laying.h"

namespace understudy::sim {
namespace {

constexpr double kDiameter = 0.48e-3, kHigh = 10e-3;  // [m], of a strand, of the tip that lays it
const double kArea = std::numbers::pi / 4 * kDiameter * kDiameter;

// Draws strands of that diameter from place to place, a line of the program each.
class Drawing {
 public:
  void strand(const Vec3& from, const Vec3& to, double area = kArea) {
    ++line;
    laying.observe(at(time += 1, from, filament, line));
    const double length = (to - from).norm();
    const int steps = std::max(1, static_cast<int>(std::lround(length / 10e-6)));
    for (int i = 1; i <= steps; ++i) {
      filament += area * length / steps / kFilamentArea;
      laying.observe(at(time += 1e-3, from + double(i) / steps * (to - from), filament, line));
    }
  }
  std::vector<Bead> beads_of(int wanted) {
    laying.observer().finish();
    std::vector<Bead> found;
    const BeadIndex& all = laying.workpiece().beads();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all.bead(i).line == wanted) found.push_back(all.bead(i));
    return found;
  }
  double widest(int wanted) {
    double width = 0;
    for (const Bead& b : beads_of(wanted)) width = std::max(width, static_cast<double>(b.width));
    return width;
  }

  Laying laying{printer()};
  double time = 0, filament = 0;
  int line = 0;
};

// The nozzle passes 0.15 mm above a strand: on a plate that would press 0.48 mm flat to 1.22 mm. The strand
// has nothing beside it to press against, so what is laid stays as it leaves the nozzle, to within 3 %, by
// which areas may differ within an element.
TEST(LoneStrand, AStrandAcrossAnotherInAirIsNotPressedWide) {
  Drawing drawing;
  drawing.strand({-5e-3, 0, kHigh}, {5e-3, 0, kHigh});
  drawing.strand({0, -5e-3, kHigh + 0.15e-3}, {0, 5e-3, kHigh + 0.15e-3});
  EXPECT_NEAR(drawing.widest(1), kDiameter, 0.03 * kDiameter);
  EXPECT_NEAR(drawing.widest(2), kDiameter, 0.03 * kDiameter);
  for (const Bead& b : drawing.beads_of(2))
    EXPECT_NEAR(static_cast<double>(b.from_W[2] + 0.5F * b.height), kHigh + 0.15e-3, 1e-6)
        << "its top is where the tip was";
  EXPECT_GT(drawing.laying.summary().deposited_volume, 0) << "it sticks all the same";
}

// Where strands lie side by side there is a floor, and a line on it is pressed as on a table.
TEST(LoneStrand, OnAFloorOfStrandsALineIsPressed) {
  Drawing drawing;
  for (int row = -3; row <= 3; ++row) {
    const double y = row * 0.9 * kDiameter;
    drawing.strand({-5e-3, y, kHigh}, {5e-3, y, kHigh});
  }
  drawing.strand({-4e-3, 0, kHigh + 0.15e-3}, {4e-3, 0, kHigh + 0.15e-3});
  EXPECT_NEAR(drawing.widest(8), bead_width(kArea, 0.15e-3), 0.05 * bead_width(kArea, 0.15e-3));
}

// 7 um of path with 0.006 mm3, which the extruder's lag leaves at a line's end, is a drop of 0.23 mm and no
// ball of 1.07 mm, the diameter of a strand of that volume and length.
TEST(LoneStrand, TheTailOfALineIsNoThickerThanTheLine) {
  Drawing drawing;
  drawing.strand({-5e-3, 0, kHigh}, {0, 0, kHigh});
  const int tail = drawing.line;
  drawing.filament += 0.0063e-9 / kFilamentArea;
  drawing.laying.observe(at(drawing.time += 1e-3, {7e-6, 0, kHigh}, drawing.filament, tail));
  ASSERT_LT(std::cbrt(6 * 0.0063e-9 / std::numbers::pi), kDiameter);
  EXPECT_LT(drawing.widest(tail), 1.1 * std::sqrt(1.2) * kDiameter);
}

TEST(LoneStrand, ACarrierIsAloneUnlessOthersAreAsHighOnBothSides) {
  const auto round = [](double y, double z) {
    Bead b;
    b.from_W = {-5e-3F, static_cast<float>(y), static_cast<float>(z)};
    b.to_W = {5e-3F, static_cast<float>(y), static_cast<float>(z)};
    b.width = b.height = static_cast<float>(kDiameter);
    return b;
  };
  const Pose tip = make_pose(Mat3::Identity(), Vec3(0, 0, kHigh + 0.5 * kDiameter + 0.1e-3));
  const auto carrier = [&](const std::vector<Bead>& beads, const Pose& X_WT) {
    Workpiece workpiece(nullptr);
    for (const Bead& b : beads) workpiece.add(b);
    const auto below = workpiece.below(X_WT);
    EXPECT_TRUE(below && below->body == Workpiece::Body::bead);
    return carrier_width(workpiece, X_WT, *below, beads.size());
  };
  const double width = static_cast<double>(static_cast<float>(kDiameter));
  EXPECT_EQ(carrier({round(0, kHigh)}, tip), width);
  EXPECT_EQ(carrier({round(0, kHigh), round(kDiameter, kHigh)}, tip), width) << "one side only";
  EXPECT_EQ(carrier({round(0, kHigh), round(kDiameter, kHigh), round(-kDiameter, kHigh - 0.2e-3)}, tip),
            width)
      << "lower than the strand by more than a fifth of it";
  EXPECT_TRUE(std::isinf(carrier({round(0, kHigh), round(kDiameter, kHigh), round(-kDiameter, kHigh)}, tip)));

  Bead upright = round(0, kHigh);
  upright.from_W = {0, 0, 0};
  upright.to_W = {0, 0, static_cast<float>(kHigh)};
  EXPECT_EQ(carrier({upright}, tip), width) << "its end is below";
}

}  // namespace
}  // namespace understudy::sim
