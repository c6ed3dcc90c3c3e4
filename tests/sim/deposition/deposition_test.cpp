#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/deposition/bead_section.h"
#include "tests/sim/deposition/laying.h"

namespace understudy::sim {
namespace {

// Conservation of volume in closed form: area = filament area * feed ratio = (w - g) g + pi g^2 / 4.
TEST(Deposition, AStraightLineAtConstantGapHasTheWidthOfItsVolume) {
  constexpr double kLength = 20e-3, kGap = 0.15e-3, kFed = 0.5e-3;
  Laying observer(printer());
  observer.run(1000, [&](double t) { return at(t, Vec3(t * kLength, 0, kGap), t * kFed); });
  const double area = kFilamentArea * kFed / kLength;
  const auto summary = observer.summary();
  EXPECT_NEAR(summary.length, kLength, 1e-12);
  EXPECT_NEAR(summary.extruded_volume, kFilamentArea * kFed, 1e-9 * kFilamentArea * kFed);
  EXPECT_NEAR(summary.deposited_volume, summary.extruded_volume, 1e-9 * summary.extruded_volume);
  EXPECT_NEAR(observer.total_volume(), summary.extruded_volume, 1e-9 * summary.extruded_volume);
  EXPECT_EQ(summary.in_band_fraction, 1);
  EXPECT_NEAR(summary.start_gap, kGap, 1e-15);
  EXPECT_NEAR(summary.gap_mean, kGap, 1e-15);
  for (const LaidBead& bead : observer.beads()) {
    EXPECT_NEAR((bead.width - kGap) * kGap + std::numbers::pi * kGap * kGap / 4, area, 1e-6 * area);
    EXPECT_EQ(bead.adhesion, Adhesion::sticks);
    EXPECT_NEAR(bead.from_W.z(), 0, 1e-15);
    EXPECT_NEAR(bead.to_W.z(), 0, 1e-15);
  }
  EXPECT_TRUE(observer.unsupported_stretches().empty());
}

TEST(Deposition, ElementsOfAStraightLineJoinUpAndAreNoLongerThanTwoMillimetres) {
  Laying observer(printer());
  observer.run(3000, [](double t) { return at(t, Vec3(t * 20e-3, 0, 0.15e-3), t * 1e-3); });
  const auto& beads = observer.beads();
  ASSERT_GE(beads.size(), 10u);
  ASSERT_LE(beads.size(), 11u);
  for (std::size_t i = 0; i + 1 < beads.size(); ++i) {
    EXPECT_LE(beads[i].length, 2e-3 + 20e-3 / 3000 + 1e-12);
    EXPECT_EQ(beads[i].to_W, beads[i + 1].from_W);
  }
  EXPECT_EQ(observer.workpiece().beads().size(), beads.size());
}

// An arc of radius R leaves a chord by its sagitta c^2 / 8R, and a line along the first tenth of a millimetre
// by up to c^2 / 2R: 5 um are used up within 0.32 mm where R is 10 mm.
TEST(Deposition, ElementsOfAnArcStayWithinMicrometresOfIt) {
  constexpr double kRadius = 10e-3;
  Laying observer(printer());
  observer.run(4000, [](double t) {
    return at(t, Vec3(kRadius * std::cos(3 * t), kRadius * std::sin(3 * t), 0.15e-3), t * 1.5e-3);
  });
  ASSERT_GT(observer.beads().size(), 80u);
  for (const LaidBead& bead : observer.beads()) {
    const Vec3 middle = 0.5 * (bead.from_W + bead.to_W);
    EXPECT_LT(kRadius - middle.norm(), 3e-6);
  }
}

TEST(Deposition, AChangeOfFlowBeginsANewElement) {
  Laying observer(printer());
  observer.run(1000, [](double t) {
    return at(t, Vec3(t * 4e-3, 0, 0.15e-3), 0.2e-3 * t + std::max(0.0, t - 0.5) * 0.2e-3);
  });
  double thin = 0, wide = 0;
  for (const LaidBead& bead : observer.beads()) (bead.to_W.x() < 2.01e-3 ? thin : wide) += bead.volume;
  EXPECT_NEAR(wide, 2 * thin, 0.02 * thin);
  EXPECT_NEAR(observer.beads().back().width, bead_width(kFilamentArea * 0.1, 0.15e-3), 1e-6);
}

// Bottle of radius R, tool along its normal, from -20 to +20 degrees: the foot runs R * 40 degrees.
TEST(Deposition, OverACylinderTheBeadLiesOnTheSurface) {
  constexpr double kRadius = 15.5e-3, kGap = 0.15e-3;
  constexpr int kAround = 1440;
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (const double y : {-0.02, 0.02}) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround;
      vertices.emplace_back(kRadius * std::cos(angle), y, 0.05 + kRadius * std::sin(angle));
    }
  }
  for (int i = 0; i < kAround; ++i) {
    const int j = (i + 1) % kAround;
    triangles.push_back({i, i + kAround, j});
    triangles.push_back({j, i + kAround, j + kAround});
  }
  Laying observer(printer(), std::make_shared<geometry::Mesh>(std::move(vertices), std::move(triangles)));
  observer.run(2000, [&](double t) {
    const double angle = from_deg(-20 + 40 * t);
    const Mat3 R = exp_rotation(Vec3(0, angle, 0));
    return at(t, Vec3(0, 0, 0.05) + R * Vec3(0, 0, kRadius + kGap), t * 0.3e-3, 1, R);
  });
  const auto summary = observer.summary();
  // The polygon is inside the circle by up to R (1 - cos(pi/n)) = 0.04 um, its outline shorter by 8e-7.
  const double facet = kRadius * (1 - std::cos(std::numbers::pi / kAround));
  EXPECT_NEAR(summary.length, kRadius * from_deg(40), 2e-6 * summary.length);
  EXPECT_GE(summary.gap_min, kGap - 1e-12);
  EXPECT_LE(summary.gap_max, kGap + facet + 1e-12);
  for (const LaidBead& bead : observer.beads()) {
    EXPECT_NEAR((bead.to_W - Vec3(0, bead.to_W.y(), 0.05)).norm(), kRadius, facet + 1e-12);
  }
}

// The gap ramps from 0.05 to 0.25 mm: half of the way is between 0.1 and 0.2 mm, a quarter to either side.
TEST(Deposition, OfARampHalfIsInTheBand) {
  for (const int count : {1, 7, 400}) {
    Laying observer(printer());
    observer.run(count, [](double t) { return at(t, Vec3(t * 20e-3, 0, 0.05e-3 + t * 0.2e-3), t * 1e-3); });
    const auto summary = observer.summary();
    // The band counts a nanometre of rounding to either side: 1e-5 of this ramp.
    EXPECT_NEAR(summary.in_band_fraction, 0.5, 1.1e-5) << count;
    EXPECT_NEAR(summary.below_band_fraction, 0.25, 1e-5) << count;
    EXPECT_NEAR(summary.above_band_fraction, 0.25, 1e-5) << count;
    EXPECT_NEAR(summary.gap_mean, 0.15e-3, 1e-12) << count;
    EXPECT_NEAR(summary.deposited_volume, 0.75 * summary.extruded_volume, 1e-9 * summary.extruded_volume);
    const auto stretches = observer.unsupported_stretches();
    ASSERT_EQ(stretches.size(), 1u) << count;
    EXPECT_NEAR(stretches[0].length, std::hypot(5e-3, 0.05e-3), 1e-9) << "as drawn, up the ramp";
    EXPECT_NEAR(stretches[0].place_W.x(), 15e-3, 1e-9);
    EXPECT_NEAR(stretches[0].time, 0.75, 1e-9);
    EXPECT_NEAR(stretches[0].worst_gap, 0.25e-3, 1e-12);
  }
}

// A hump in the height lifts the tip out of the band on two stretches.
TEST(Deposition, LooseStretchesHavePlaceLengthAndWorstGap) {
  const auto gap = [](double x) { return 0.15e-3 + 0.1e-3 * std::sin(2 * std::numbers::pi * x / 10e-3); };
  Laying observer(printer());
  observer.run(4000, [&](double t) {
    const double x = t * 20e-3;
    return at(t, Vec3(x, 0, gap(x)), t * 1e-3, x < 10e-3 ? 11 : 12);
  });
  // sin > 1/2 between 1/12 and 5/12 of each period; chords of 5 um are off by 1e-7 of the gap. What hangs is
  // as long as the tip's path: its slope's square is k^2 / 2 (1 + cos 2x) with k = 0.02 pi, and the path
  // longer by half of that.
  const double k2 = std::pow(0.02 * std::numbers::pi, 2);
  const double longer = 10e-3 * k2 / 4 * (1.0 / 3 - std::sqrt(3) / (4 * std::numbers::pi));
  const auto stretches = observer.unsupported_stretches();
  ASSERT_EQ(stretches.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const double start = 10e-3 * static_cast<double>(i);
    EXPECT_NEAR(stretches[i].place_W.x(), start + 10e-3 / 12, 1e-7);
    EXPECT_NEAR(stretches[i].length, 10e-3 / 3 + longer, 2e-7);
    EXPECT_NEAR(stretches[i].worst_gap, 0.25e-3, 1e-9);
    EXPECT_EQ(stretches[i].line, i == 0 ? 11 : 12);
  }
}

TEST(Deposition, DoesNotDependOnTheRateOfSnapshots) {
  const auto gap = [](double x) { return 0.15e-3 + 0.1e-3 * std::sin(2 * std::numbers::pi * x / 10e-3); };
  std::vector<DepositionSummary> summaries;
  for (const int count : {200, 1000, 5000}) {  // 0.1 mm, 20 um and 4 um a snapshot
    Laying observer(printer());
    observer.run(count, [&](double t) { return at(t, Vec3(t * 20e-3, 0, gap(t * 20e-3)), t * 1e-3); });
    summaries.push_back(observer.summary());
  }
  for (const DepositionSummary& s : summaries) {
    // A chord h of a sine of period L and amplitude a misses a (pi h / L)^2 / 2 of gap: 0.05 um at 0.1 mm,
    // and thereby 0.05 um / (gap slope at the crossings 0.054) = 1 um of 20 mm at each of eight ends.
    EXPECT_NEAR(s.in_band_fraction, summaries.back().in_band_fraction, 4e-4);
    EXPECT_NEAR(s.deposited_volume, summaries.back().deposited_volume, 4e-4 * s.extruded_volume);
    EXPECT_NEAR(s.gap_mean, summaries.back().gap_mean, 1e-7);
    EXPECT_NEAR(s.extruded_volume, summaries.back().extruded_volume, 1e-12 * s.extruded_volume);
  }
  // Of each period a third is above 0.2 mm, and a third below 0.1 mm.
  EXPECT_NEAR(summaries.back().in_band_fraction, 1.0 / 3, 1e-4);
}

// Retraction, travel and the same length pushed back: nothing is laid until the nozzle is full again.
TEST(Deposition, OnlyNetNewFilamentIsLaid) {
  Laying observer(printer());
  double filament = 0;
  observer.run(100, [&](double t) { return at(t, Vec3(t * 5e-3, 0, 0.15e-3), t * 0.2e-3, 1); });
  filament = 0.2e-3;
  observer.observe(at(1.1, Vec3(5e-3, 0, 0.15e-3), filament - 1e-3, 2));
  observer.observe(at(1.5, Vec3(5e-3, 0, 3e-3), filament - 1e-3, 3));
  observer.observe(at(2.0, Vec3(20e-3, 0, 0.15e-3), filament - 1e-3, 4));
  observer.observe(at(2.1, Vec3(20e-3, 0, 0.15e-3), filament, 5));
  const double before = observer.total_volume();
  EXPECT_NEAR(before, kFilamentArea * filament, 1e-9 * before);
  observer.observe(at(3.0, Vec3(25e-3, 0, 0.15e-3), filament + 0.2e-3, 6));
  const auto summary = observer.summary();
  EXPECT_NEAR(summary.extruded_volume, kFilamentArea * 0.4e-3, 1e-9 * summary.extruded_volume);
  EXPECT_NEAR(observer.total_volume(), summary.extruded_volume, 1e-9 * summary.extruded_volume);
  EXPECT_NEAR(summary.length, 10e-3, 1e-12) << "travel is no path";
  const LaidBead& last = observer.beads().back();
  EXPECT_NEAR(last.from_W.x(), 20e-3, 1e-12) << "no element across the travel";
  EXPECT_EQ(last.line, 6);
}

TEST(Deposition, AnUnretractionOnTheMoveStartsWhereTheNozzleIsFull) {
  Laying observer(printer());
  observer.observe(at(0, Vec3(0, 0, 0.15e-3), 0));
  observer.observe(at(1, Vec3(0, 0, 0.15e-3), -1e-3));
  observer.observe(at(2, Vec3(10e-3, 0, 0.15e-3), 1e-3));  // the first half refills
  ASSERT_EQ(observer.beads().size(), 1u);
  EXPECT_NEAR(observer.beads()[0].from_W.x(), 5e-3, 1e-12);
  EXPECT_NEAR(observer.beads()[0].volume, kFilamentArea * 1e-3, 1e-18);
}

TEST(Deposition, FilamentFedAtAStandstillGoesIntoTheElementThatFollows) {
  Laying observer(printer());
  observer.observe(at(0, Vec3(0, 0, 0.15e-3), 0));
  observer.observe(at(1, Vec3(0, 0, 0.15e-3), 1e-4));
  observer.run(100, [](double t) { return at(1 + t, Vec3(t * 1e-3, 0, 0.15e-3), 1e-4 + t * 1e-4); });
  const auto& beads = observer.beads();
  ASSERT_GE(beads.size(), 2u);
  EXPECT_NEAR(beads[0].volume, kFilamentArea * (1e-4 + 1e-5), 0.02 * beads[0].volume);
  EXPECT_NEAR(observer.total_volume(), kFilamentArea * 2e-4, 1e-9 * observer.total_volume());
}

// After a travel a slicer feeds what the nozzle had lost while it comes down to the layer: 1.2 mm^3 over 2
// mm. It hangs from the nozzle, and is pressed out where the line begins.
TEST(Deposition, FilamentFedOnTheWayDownLiesWhereTheLineBegins) {
  Laying observer(printer());
  constexpr double kGap = 0.15e-3, kHung = 0.5e-3, kLine = 10e-3, kFed = 0.03;
  observer.run(200, [&](double t) { return at(t, Vec3(0, 0, kGap + (1 - t) * 2e-3), t * kHung); });
  observer.run(200, [&](double t) { return at(1 + t, Vec3(t * kLine, 0, kGap), kHung + t * kLine * kFed); });
  EXPECT_TRUE(observer.unsupported_stretches().empty());
  EXPECT_NEAR(observer.summary().start_gap, kGap, 1e-12);
  EXPECT_NEAR(observer.summary().length, kLine, 1e-9);
  EXPECT_NEAR(observer.total_volume(), kFilamentArea * (kHung + kLine * kFed), 1e-9 * kFilamentArea * kHung);
  const LaidBead& disc = observer.beads().front();
  EXPECT_NEAR(disc.from_W.norm(), 0, 1e-12);
  // Drawn out by the 0.1 mm L in which the line begins: L w + pi w^2 / 4 is the footprint, so w is less by 2
  // L / pi. The line's own 0.6 % of the volume is in it.
  const double round = std::sqrt(4 * kFilamentArea * kHung / (std::numbers::pi * kGap));
  EXPECT_NEAR(disc.width, round - 2 / std::numbers::pi * 0.1e-3, 0.02e-3);
  for (const LaidBead& bead : observer.beads()) EXPECT_LE(bead.height, kGap * (1 + 1e-9));
}

// However far it came down before without feeding.
TEST(Deposition, ALongWayDownBeforeTheFeedChangesNothing) {
  Laying observer(printer());
  constexpr double kGap = 0.15e-3, kHung = 0.5e-3, kWay = 32e-3, kFeeding = 2e-3;
  observer.run(3200, [&](double t) {
    const double left = (1 - t) * kWay;
    return at(t, Vec3(0, 0, kGap + left), std::max(0.0, 1 - left / kFeeding) * kHung);
  });
  EXPECT_TRUE(observer.unsupported_stretches().empty());
  EXPECT_NEAR(observer.summary().start_gap, kGap, 1e-12);
}

// Without a line at its end the drop stays where the nozzle stopped; and it is part of what has not been laid
// until then.
TEST(Deposition, ADropFromTheWayDownStaysWhereTheNozzleStopped) {
  Laying observer(printer());
  constexpr double kGap = 0.15e-3, kHung = 0.5e-3;
  observer.run(200, [&](double t) { return at(t, Vec3(0, 0, kGap + (1 - t) * 2e-3), t * kHung); });
  EXPECT_NEAR(observer.observer().summary().column_volume, kFilamentArea * kHung,
              1e-9 * kFilamentArea * kHung);
  observer.observe(at(1.1, Vec3(20e-3, 0, kGap), kHung));
  const auto& beads = observer.beads();
  ASSERT_EQ(beads.size(), 1u);
  EXPECT_EQ(beads[0].adhesion, Adhesion::sticks);
  EXPECT_NEAR(beads[0].to_W.norm(), 0, 1e-12);
  EXPECT_NEAR(observer.summary().standstill_volume, kFilamentArea * kHung, 1e-9 * kFilamentArea * kHung);
}

// Ten bores, 4 mm, are more than slicers lift a nozzle: a strut that is drawn downwards is in the nozzle's
// way.
TEST(Deposition, AStrutThatIsDrawnDownwardsIsLaidOnTheWay) {
  Laying observer(printer());
  constexpr double kFed = 1e-3, kWay = 20e-3, kHang = 4e-3;
  observer.run(2000, [](double t) { return at(t, Vec3(0, 0, 0.15e-3 + (1 - t) * kWay), t * kFed); });
  const auto stretches = observer.unsupported_stretches();
  ASSERT_FALSE(stretches.empty());
  double length = 0;
  for (const auto& stretch : stretches) length += stretch.length;
  // The band begins 0.05 mm above the end; the drop takes the first element, a tenth of a millimetre.
  EXPECT_NEAR(length, kWay - kHang - 0.05e-3, 0.15e-3);
  EXPECT_NEAR(observer.total_volume(), kFilamentArea * kFed, 1e-9 * kFilamentArea * kFed);
}

// Over the edge of a plate, 10 mm above the table, the gap jumps: the strand hangs, and no bead runs down.
TEST(Deposition, OverAnEdgeTheStrandIsLooseAndNotTallerThanItsPath) {
  std::vector<Vec3> vertices{Vec3(-0.02, -0.02, 0.01), Vec3(0.01, -0.02, 0.01), Vec3(0.01, 0.02, 0.01),
                             Vec3(-0.02, 0.02, 0.01)};
  Laying observer(printer(), std::make_shared<geometry::Mesh>(
                                 std::move(vertices), std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
  observer.run(999, [](double t) { return at(t, Vec3(t * 20e-3, 0.3e-3, 10.15e-3), t * 1e-3); });
  const auto summary = observer.summary();
  EXPECT_NEAR(summary.length, 20e-3, 1e-9);
  EXPECT_NEAR(summary.in_band_fraction, 0.5, 1e-3) << "the edge is seen within one snapshot's 20 um";
  const auto stretches = observer.unsupported_stretches();
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_NEAR(stretches[0].length, 10e-3, 20e-6);
  EXPECT_NEAR(stretches[0].worst_gap, 10.15e-3, 1e-9);
}

TEST(Deposition, NothingBelowIsLooseWithItsVolumeKept) {
  Laying observer(printer());
  observer.run(50, [](double t) { return at(t, Vec3(t * 5e-3, 0, 0.08), t * 1e-3); });
  const auto summary = observer.summary();
  EXPECT_EQ(summary.deposited_volume, 0);
  EXPECT_EQ(summary.in_band_fraction, 0);
  EXPECT_EQ(summary.above_band_fraction, 1);
  EXPECT_NEAR(observer.total_volume(), kFilamentArea * 1e-3, 1e-9 * kFilamentArea * 1e-3);
  ASSERT_EQ(observer.unsupported_stretches().size(), 1u);
  EXPECT_TRUE(std::isinf(observer.unsupported_stretches()[0].worst_gap));
  EXPECT_TRUE(std::isfinite(observer.beads()[0].width));
  EXPECT_TRUE(observer.beads()[0].to_W.allFinite());
}

TEST(Deposition, ANozzleInsideTheSurfaceLaysNothingThatSticks) {
  Laying observer(printer());
  observer.run(100, [](double t) { return at(t, Vec3(t * 10e-3, 0, (t - 0.5) * 0.1e-3), t * 1e-3); });
  const auto stretches = observer.unsupported_stretches();
  ASSERT_EQ(stretches.size(), 1u);
  EXPECT_NEAR(stretches[0].length, 5e-3, 1e-6);
  EXPECT_NEAR(stretches[0].worst_gap, -0.05e-3, 1e-12);
  EXPECT_EQ(observer.summary().in_band_fraction, 0);
}

}  // namespace
}  // namespace understudy::sim
