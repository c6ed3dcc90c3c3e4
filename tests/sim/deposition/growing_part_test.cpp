#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "tests/sim/deposition/laying.h"

namespace understudy::sim {
namespace {

constexpr double kLayer = 0.15e-3, kWidth = 0.45e-3;
const double kArea = (kWidth - kLayer) * kLayer + std::numbers::pi / 4 * kLayer * kLayer;
const double kFeed = kArea / kFilamentArea;  // filament per path

/// A straight line from one point of the tip to another, in its own second; filament goes on.
class Printer {
 public:
  explicit Printer(Laying& laying) : laying_(laying) {}

  void line(const Vec3& from, const Vec3& to, const Mat3& R = Mat3::Identity()) {
    travel(from, R);
    const double length = (to - from).norm();
    const int count = std::max(10, static_cast<int>(length / 20e-6));
    for (int k = 1; k <= count; ++k) {
      const double f = static_cast<double>(k) / count;
      step(from + f * (to - from), filament_ + f * length * kFeed, 1.0 / count, R);
    }
    filament_ += length * kFeed;
    ++line_;
  }
  void travel(const Vec3& to, const Mat3& R = Mat3::Identity()) { step(to, filament_, 0.1, R); }
  void wait(double seconds) { time_ += seconds; }
  double temperature = 0, fan = 0;

 private:
  void step(const Vec3& tip, double filament, double duration, const Mat3& R) {
    time_ += duration;
    Snapshot s = at(time_, tip, filament, line_, R);
    s.nozzle_temperature = temperature;
    s.fan = fan;
    laying_.observe(s);
  }
  Laying& laying_;
  double time_ = 0, filament_ = 0;
  int line_ = 1;
};

TEST(GrowingPart, TheSecondLayerLiesOnTheFirst) {
  Laying laying(printer());
  Printer print(laying);
  print.line({0, 0, kLayer}, {20e-3, 0, kLayer});
  print.travel({20e-3, 0, 5e-3});
  print.line({20e-3, 0, 2 * kLayer}, {0, 0, 2 * kLayer});
  const auto summary = laying.summary();
  // Single precision places a bead within 2 nm here.
  EXPECT_NEAR(summary.gap_min, kLayer, 10e-9);
  EXPECT_NEAR(summary.gap_max, kLayer, 10e-9);
  EXPECT_EQ(summary.in_band_fraction, 1);
  EXPECT_NEAR(summary.deposited_volume, summary.extruded_volume, 1e-9 * summary.extruded_volume);
  EXPECT_TRUE(laying.unsupported_stretches().empty());
}

TEST(GrowingPart, ATiltedLayerLiesOnATiltedLayer) {
  const Mat3 R = exp_rotation(Vec3(0, from_deg(35), 0));
  const Vec3 normal = R.col(2), along = R.col(0), start(0, 0, 10e-3);
  // The first layer lies on a slanted plate.
  std::vector<Vec3> corners;
  for (const auto& [u, v] : {std::pair{-0.01, -0.01}, {0.03, -0.01}, {0.03, 0.01}, {-0.01, 0.01}})
    corners.push_back(start + u * along + v * Vec3::UnitY());
  auto plate =
      std::make_shared<geometry::Mesh>(corners, std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}});
  Laying laying(printer(), plate);
  Printer print(laying);
  for (int layer = 1; layer <= 3; ++layer) {
    const Vec3 from = start + layer * kLayer * normal;
    print.line(from, from + 10e-3 * along, R);
    print.travel(from + 10e-3 * along + 5e-3 * normal, R);
  }
  const auto summary = laying.summary();
  EXPECT_NEAR(summary.gap_min, kLayer, 20e-9);
  EXPECT_NEAR(summary.gap_max, kLayer, 20e-9);
  EXPECT_EQ(summary.in_band_fraction, 1);
}

// The nozzle crosses a bead of its own layer: it is pressed into its place there and holds; the gap of that
// stretch says nothing.
TEST(GrowingPart, CrossingABeadOfTheSameLayerFuses) {
  Laying laying(printer());
  Printer print(laying);
  print.line({-5e-3, 0, kLayer}, {5e-3, 0, kLayer});
  print.travel({0, 0, 5e-3});
  print.line({0, -5e-3, kLayer}, {0, 5e-3, kLayer});
  const auto summary = laying.summary();
  EXPECT_TRUE(laying.unsupported_stretches().empty());
  EXPECT_NEAR(summary.gap_min, kLayer, kLayer / 3) << "the rounded flanks of the bead crossed";
  EXPECT_GT(summary.fused_length, kWidth - kLayer);
  EXPECT_LT(summary.fused_length, kWidth + 2 * 20e-6) << "to within a snapshot at either side";
  EXPECT_NEAR(summary.deposited_volume, summary.extruded_volume, 1e-9 * summary.extruded_volume);
}

void plough_through_three_layers(Printer& print) {
  for (int layer = 1; layer <= 3; ++layer) {
    print.line({-5e-3, 0, layer * kLayer}, {5e-3, 0, layer * kLayer});
    print.travel({0, 0, 5e-3});
  }
  print.line({0, -5e-3, kLayer}, {0, 5e-3, kLayer});
}

// Ploughing 0.15 mm deep through printed material is no fusing.
TEST(GrowingPart, DeepInAnEarlierBeadTheNozzleIsBuried) {
  Laying laying(printer());
  Printer print(laying);
  plough_through_three_layers(print);
  ASSERT_EQ(laying.unsupported_stretches().size(), 1u);
  EXPECT_EQ(laying.unsupported_stretches()[0].adhesion, Adhesion::buried);
  EXPECT_NEAR(laying.unsupported_stretches()[0].worst_gap, -2 * kLayer, 20e-9);
}

/// [m], of what was laid on that line or later.
double highest_top(Laying& laying, int line) {
  laying.summary();
  double top = 0;
  for (std::size_t i = 0; i < laying.workpiece().beads().size(); ++i) {
    const Bead bead = laying.workpiece().beads().bead(i);
    if (bead.line < line) continue;
    const auto middle = static_cast<double>(std::max(bead.from_W[2], bead.to_W[2]));
    top = std::max(top, middle + 0.5 * static_cast<double>(bead.height));
  }
  return top;
}

constexpr double kSingle = 5e-9;  // [m]: how beads are kept

TEST(GrowingPart, NothingThatABuriedNozzleFeedsLiesAboveItsOrifice) {
  Laying laying(printer());
  Printer print(laying);
  plough_through_three_layers(print);
  EXPECT_LE(highest_top(laying, 4), kLayer + kSingle);
}

// Too thin to reach up to the nozzle where it begins, it is pressed where it ends.
TEST(GrowingPart, AThinLineWhoseGapClosesStaysBelowTheOrifice) {
  constexpr double kHigh = 0.2e-3, kLow = 0.1e-3, kThin = 0.2;
  Laying laying(printer());
  laying.observe(at(0, {0, 0, kHigh}, 0));
  laying.observe(at(1e-3, {0.1e-3, 0, kLow}, kThin * 0.1e-3 * kFeed));
  laying.summary();
  ASSERT_EQ(laying.workpiece().beads().size(), 1u);
  const Bead bead = laying.workpiece().beads().bead(0);
  EXPECT_LE(static_cast<double>(bead.to_W[2] + bead.height / 2), kLow + kSingle);
}

// A start block purges high over the table and moves on: the thread goes down with the drop.
TEST(GrowingPart, AThreadOutOfADropThatFallsIsInNobodysWay) {
  Laying laying(printer());
  const Vec3 high(0, 0, 15e-3);
  laying.observe(at(0, high, 0));
  laying.observe(at(10, high, 20e-3));
  for (int i = 1; i <= 500; ++i)
    laying.observe(at(10 + 0.01 * i, high + Vec3(i * 0.1e-3, 0, 0), 20e-3 + i * 2e-6));
  const auto summary = laying.summary();
  EXPECT_EQ(laying.workpiece().beads().size(), 0u);
  EXPECT_NEAR(summary.standstill_volume, summary.extruded_volume, 1e-9 * summary.extruded_volume);
  ASSERT_EQ(laying.unsupported_stretches().size(), 1u) << "it is told all the same";
}

// Half of the width over the row below is an overhang that holds; a whole width beside it is none.
TEST(GrowingPart, AnOverhangHoldsByHalfOfItsWidth) {
  for (const double offset : {0.30e-3, 0.60e-3}) {
    Laying laying(printer());
    Printer print(laying);
    for (const double z : {kLayer, 2 * kLayer}) {
      print.line({0, 0, z}, {10e-3, 0, z});
      print.travel({5e-3, 0, 5e-3});
    }
    print.line({0, offset, 3 * kLayer}, {10e-3, offset, 3 * kLayer});
    EXPECT_EQ(laying.unsupported_stretches().empty(), offset < 0.5e-3) << offset;
  }
}

TEST(GrowingPart, AStrandFromOneWallToAnotherIsHeldAtBothEnds) {
  Laying laying(printer());
  Printer print(laying);
  for (int layer = 1; layer <= 20; ++layer)
    for (const double x : {0.0, 8e-3}) {
      print.line({x, -2e-3, layer * kLayer}, {x, 2e-3, layer * kLayer});
      print.travel({x, 0, 6e-3});
    }
  print.line({0, 0, 21 * kLayer}, {8e-3, 0, 21 * kLayer});
  const auto& stretches = laying.unsupported_stretches();
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_EQ(stretches[0].adhesion, Adhesion::unsupported);
  EXPECT_TRUE(stretches[0].held_at_start);
  EXPECT_TRUE(stretches[0].held_at_end);
  // From flank to flank: 8 mm less one width, and what the sides still feel.
  EXPECT_NEAR(stretches[0].length, 8e-3 - kWidth, 0.3e-3);
  EXPECT_NEAR(stretches[0].worst_gap, 21 * kLayer, 20e-9);
}

// A strut of 5 mm drawn straight up from the table is 5 mm long and as thick as what it was fed, not as long
// as its shadow; so is one that leans.
TEST(GrowingPart, AStrandIsAsLongAsItWasDrawnWhicheverWayItRuns) {
  for (const double tilt : {0.0, 30.0}) {
    Laying laying(printer());
    Printer print(laying);
    const Vec3 start(0, 0, kLayer), along(std::sin(from_deg(tilt)), 0, std::cos(from_deg(tilt)));
    print.line(start, start + 5e-3 * along);
    print.travel({0, 0, 20e-3});
    ASSERT_FALSE(laying.unsupported_stretches().empty()) << tilt;
    double length = 0, volume = 0;
    for (const UnsupportedStretch& stretch : laying.unsupported_stretches()) {
      length += stretch.length;
      volume += stretch.volume;
    }
    // Its foot sticks as far as the nozzle is within the accepted 0.2 mm of the table.
    EXPECT_NEAR(length, 5e-3, 0.1e-3) << tilt;
    EXPECT_NEAR(volume / length, kArea, 0.02 * kArea) << tilt;
  }
}

TEST(GrowingPart, AStrandThatEndsInTheAirIsFreeThere) {
  Laying laying(printer());
  Printer print(laying);
  for (int layer = 1; layer <= 20; ++layer) {
    print.line({0, -2e-3, layer * kLayer}, {0, 2e-3, layer * kLayer});
    print.travel({0, 0, 6e-3});
  }
  print.line({0, 0, 21 * kLayer}, {4e-3, 0, 21 * kLayer});
  ASSERT_EQ(laying.unsupported_stretches().size(), 1u);
  EXPECT_TRUE(laying.unsupported_stretches()[0].held_at_start);
  EXPECT_FALSE(laying.unsupported_stretches()[0].held_at_end);
}

// The mean of both temperatures is that of the interface between two like half-spaces.
TEST(GrowingPart, AColdInterfaceDoesNotWeld) {
  constexpr double kGlass = 378.15;  // [K]
  for (const double nozzle : {503.15, 443.15}) {
    DepositionOptions options;
    options.glass_transition = kGlass;
    options.substrate_temperature = [](double, double) { return 298.15; };
    Laying laying(printer(), nullptr, options);
    Printer print(laying);
    print.temperature = nozzle;
    print.line({0, 0, kLayer}, {10e-3, 0, kLayer});
    print.travel({0, 0, 5e-3});
    print.line({0, 0, 2 * kLayer}, {10e-3, 0, 2 * kLayer});
    const bool welds = 0.5 * (nozzle + 298.15) > kGlass;
    ASSERT_EQ(laying.unsupported_stretches().empty(), welds) << nozzle;
    if (welds) continue;
    EXPECT_EQ(laying.unsupported_stretches()[0].adhesion, Adhesion::cold);
    EXPECT_NEAR(laying.unsupported_stretches()[0].interface_temperature, 0.5 * (nozzle + 298.15), 1e-9);
    EXPECT_NEAR(laying.unsupported_stretches()[0].length, 10e-3, 1e-6) << "the first layer lies on the table";
  }
}

TEST(GrowingPart, ABeadThatIsStillWarmWelds) {
  constexpr double kGlass = 378.15, kNozzle = 443.15;
  DepositionOptions options;
  options.glass_transition = kGlass;
  options.substrate_temperature = [](double age, double) { return age < 5 ? kNozzle : 298.15; };
  for (const double wait : {0.0, 10.0}) {
    Laying laying(printer(), nullptr, options);
    Printer print(laying);
    print.temperature = kNozzle;
    print.line({0, 0, kLayer}, {10e-3, 0, kLayer});
    print.wait(wait);
    print.travel({10e-3, 0, 5e-3});
    print.line({10e-3, 0, 2 * kLayer}, {0, 0, 2 * kLayer});
    EXPECT_EQ(laying.unsupported_stretches().empty(), wait < 5);
  }
}

// Lag, retractions, travels and a blob: what went in lies somewhere.
TEST(GrowingPart, VolumeIsConservedOverAPrintWithLagAndRetractions) {
  machine::MachineDescription machine = printer();
  machine.process.extruder_lag = 0.06;
  Laying laying(machine);
  Printer print(laying);
  for (int layer = 1; layer <= 4; ++layer)
    for (int row = 0; row < 6; ++row) {
      const double y = row * 0.45e-3;
      print.line({0, y, layer * kLayer}, {3e-3, y, layer * kLayer});
      if (row % 2 == 0) print.travel({1e-3, y, layer * kLayer + 2e-3});
    }
  const auto summary = laying.summary();
  EXPECT_NEAR(laying.total_volume(), summary.extruded_volume, 1e-9 * summary.extruded_volume);
  EXPECT_NEAR(summary.laid_volume, summary.extruded_volume, 1e-9 * summary.extruded_volume);
  EXPECT_EQ(summary.column_volume, 0);
}

// Over the first lag of a line from rest too little comes out.
TEST(GrowingPart, AfterAStartTheBeadIsThinByTheLag) {
  machine::MachineDescription machine = printer();
  machine.process.extruder_lag = 0.05;
  Laying laying(machine);
  laying.run(1000, [](double t) { return at(t, Vec3(t * 10e-3, 0, kLayer), t * 10e-3 * kFeed); });
  const auto& beads = laying.beads();
  // The bead over the first 0.1 mm, 10 ms: (1 - exp(-0.2)) / 0.2 of it stays in.
  const double share = 1 - (1 - std::exp(-0.2)) / 0.2;
  EXPECT_NEAR(beads[0].volume, share * kArea * beads[0].length, 0.1 * share * kArea * beads[0].length);
  EXPECT_LT(beads[0].width, 0.6 * kWidth);
  EXPECT_NEAR(beads[beads.size() - 2].width, kWidth, 0.01 * kWidth);
}

}  // namespace
}  // namespace understudy::sim
