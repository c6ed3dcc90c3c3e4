#include "sim/deposition/bead_builder.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/sim/deposition/laying.h"

namespace understudy::sim {
namespace {

// Round a tight curve the elements are shorter than they are wide; the line has the section's width all
// along.
TEST(BeadBuilder, AShortPieceOfALineIsAsWideAsTheLine) {
  Laying observer(printer());
  constexpr double kRadius = 0.4e-3, kGap = 0.15e-3, kFed = 0.03;  // filament over path
  observer.run(400, [&](double t) {
    const double angle = t * 2e-3 / kRadius;
    return at(t, Vec3(kRadius * std::cos(angle), kRadius * std::sin(angle), kGap), kFed * t * 2e-3);
  });
  const double width = kFilamentArea * kFed / kGap + (1 - std::numbers::pi / 4) * kGap;
  const auto& beads = observer.beads();
  ASSERT_GE(beads.size(), 6u);
  for (std::size_t i = 0; i + 1 < beads.size(); ++i) {
    EXPECT_LT(beads[i].length, width);
    EXPECT_NEAR(beads[i].width, width, 0.01 * width) << i;  // chords are shorter than the arc by less
  }
}

// A slow drive goes in steps: the tip trembles along its way, three times as far as it gets, and the line is
// no thinner for it.
TEST(BeadBuilder, ATremblingTipDrawsNothingOut) {
  Laying observer(printer());
  constexpr double kWay = 4e-3, kGap = 0.15e-3, kFed = 0.03;
  observer.run(4000, [&](double t) {
    const double tremble = 3e-6 * std::sin(2 * std::numbers::pi * 1000 * t);
    return at(t, Vec3(t * kWay + tremble, 0, kGap), kFed * t * kWay);
  });
  const double width = kFilamentArea * kFed / kGap + (1 - std::numbers::pi / 4) * kGap;
  double length = 0;
  for (const LaidBead& bead : observer.beads()) {
    length += bead.path;
    // An element is a tenth of a millimetre or longer, its ends 3 um to and fro; the last is what is left.
    if (&bead != &observer.beads().back()) {
      EXPECT_NEAR(bead.width, width, 0.06 * width);
    }
  }
  EXPECT_NEAR(length, kWay, 0.01 * kWay);
}

TEST(BeadBuilder, ABlobStaysWhereTheTipLeavesIt) {
  Laying observer(printer());
  observer.observe(at(0, Vec3(0, 0, 0.15e-3), 0));
  observer.observe(at(1, Vec3(0, 0, 0.15e-3), 1e-4));
  observer.observe(at(2, Vec3(10e-3, 0, 0.15e-3), 1e-4));
  observer.run(10, [](double t) { return at(2 + t, Vec3(10e-3 + t * 1e-3, 0, 0.15e-3), 1e-4 + t * 1e-4); });
  const LaidBead& blob = observer.beads().front();
  EXPECT_EQ(blob.length, 0);
  EXPECT_NEAR(observer.summary().standstill_volume, kFilamentArea * 1e-4, 1e-15);
  EXPECT_NEAR(blob.to_W.x(), 0, 1e-15);
  EXPECT_NEAR(std::numbers::pi / 4 * blob.width * blob.width * 0.15e-3, kFilamentArea * 1e-4, 1e-15);
  EXPECT_NEAR(observer.summary().length, 1e-3, 1e-12);
}

// A strut begins on what carries it: the first of it comes out slowly (the extruder's lag) while the tip, not
// quite straight, leaves. 2e-4 mm^3 in a gap of 0.175 mm are a disc of 38 um; a line of a micrometre with
// that volume would be 1.1 mm wide.
TEST(BeadBuilder, ATipThatRisesLeavesADiscOfItsVolumeAndNoWideLine) {
  Laying observer(printer());
  constexpr double kFirst = 2e-4 * 1e-9, kGap = 0.175e-3;
  observer.observe(at(0, Vec3(0, 0, 0.15e-3), 0));
  observer.observe(at(0.01, Vec3(1e-6, 0, 0.2e-3), kFirst / kFilamentArea));
  for (int i = 1; i <= 100; ++i)
    observer.observe(at(0.01 + 0.01 * i, Vec3(1e-6, 0, 0.2e-3 + i * 0.02e-3),
                        (kFirst + i * 0.02e-3 * 0.18e-6) / kFilamentArea));
  const LaidBead& first = observer.beads().front();
  EXPECT_EQ(first.adhesion, Adhesion::sticks);
  EXPECT_NEAR(first.width, std::sqrt(4 * kFirst / (std::numbers::pi * kGap)), 1e-6);
}

// It may begin pressed into the strand that carries it, and rise through the band after that: a strut of
// 0.48 mm from 0.03 mm over another one, leaning by 5 degrees. A disc of what comes out up to the band's end,
// 0.2 mm of it in the gap of a bead, is less than 0.6 mm wide.
TEST(BeadBuilder, AStrutThatRisesFromAStrandStaysThin) {
  Laying observer(printer());
  const double area = std::numbers::pi / 4 * 0.48e-3 * 0.48e-3, fed = area / kFilamentArea;
  constexpr double kTop = 5e-3, kUp = 2e-3, kFirst = 10e-3;
  observer.run(1000, [&](double t) { return at(t, Vec3((t - 0.5) * kFirst, 0, kTop), t * kFirst * fed); });
  observer.observe(at(1.1, Vec3(5e-3, 0, 10e-3), kFirst * fed));
  observer.observe(at(1.2, Vec3(0, 0, kTop + 0.03e-3), kFirst * fed));
  observer.run(1000, [&](double t) {
    return at(1.2 + t, Vec3(0, t * kUp * std::tan(5 * kDegree), kTop + 0.03e-3 + t * kUp),
              (kFirst + t * kUp) * fed);
  });
  int pressed = 0;
  for (const LaidBead& bead : observer.beads()) {
    if (bead.start_time < 1.2 || bead.adhesion == Adhesion::unsupported) continue;
    ++pressed;
    EXPECT_LT(bead.height, 0.6e-3);
    EXPECT_LT(bead.width, 0.6e-3);
  }
  EXPECT_GE(pressed, 2);
}

}  // namespace
}  // namespace understudy::sim
