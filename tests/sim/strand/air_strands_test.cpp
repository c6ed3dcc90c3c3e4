#include "sim/strand/air_strands.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "sim/deposition/bead_temperature.h"
#include "sim/strand/strand.h"
#include "tests/shipped_hexapod.h"

namespace understudy::sim {
namespace {

const machine::Material& pla() {
  static const auto material = machine::load_material("pla");
  return material;
}

constexpr double kSpeed = 5e-3;                        // [m/s]
const double kFree = free_strand_diameter(hexapod());  // [m]

/// A bridge along x, as thick as the nozzle lets it out, held at both ends.
UnsupportedStretch bridge(double length, int line = 1) {
  UnsupportedStretch s;
  s.line = line;
  s.length = length;
  s.volume = length * std::numbers::pi / 4 * kFree * kFree;
  s.width = 0.5e-3;
  s.worst_gap = 5e-3;
  s.nozzle_temperature = 483;
  s.fan = 0;
  s.held_at_start = s.held_at_end = true;
  constexpr int kPoints = 20;
  for (int k = 0; k <= kPoints; ++k) {
    s.path_W.push_back({length * k / kPoints, 0, 10e-3});
    s.laid_at.push_back(3 + length / kSpeed * k / kPoints);
  }
  return s;
}

std::vector<AirStrand> solved(const std::vector<UnsupportedStretch>& stretches) {
  AirStrandSolver solver(hexapod(), pla());
  for (const UnsupportedStretch& s : stretches) solver.add(s);
  return solver.finish();
}

TEST(AirStrands, ABeadReachesItsWidthFromEachEndThatIsHeld) {
  UnsupportedStretch s = bridge(0.9e-3);
  EXPECT_TRUE(spans_a_groove(s));
  s.length = 1.1e-3;
  EXPECT_FALSE(spans_a_groove(s));
  s.length = 0.9e-3;
  s.held_at_end = false;
  EXPECT_FALSE(spans_a_groove(s)) << "from one end half as far";
  s.adhesion = Adhesion::cold;
  s.length = 0.1e-3;
  EXPECT_FALSE(spans_a_groove(s)) << "cold material lies on something";
}

TEST(AirStrands, HangWhereTheyBeginHeldAndNothingIsNear) {
  EXPECT_TRUE(hangs_in_air(bridge(5e-3)));
  UnsupportedStretch loose = bridge(5e-3);
  loose.held_at_start = false;
  EXPECT_FALSE(hangs_in_air(loose));
  UnsupportedStretch low = bridge(5e-3);
  low.worst_gap = 1.9 * kFree;
  EXPECT_FALSE(hangs_in_air(low)) << "no farther than two diameters";
  low.on_printed = true;
  EXPECT_TRUE(hangs_in_air(low)) << "a bridge over a hollow of the print";
  low.held_at_end = false;
  EXPECT_FALSE(hangs_in_air(low));
  EXPECT_FALSE(hangs_in_air(bridge(0.8e-3))) << "a groove";
}

TEST(AirStrands, AStraightOneSagsAsTheBeamOfItsSpan) {
  const std::vector<AirStrand> strands = solved({bridge(11e-3)});
  ASSERT_EQ(strands.size(), 1u);
  AirSpan span;
  span.length = 11e-3;
  span.diameter = kFree;
  span.speed = kSpeed;
  span.nozzle_temperature = 483;
  span.surroundings.temperature = hexapod().process.ambient_temperature;
  const StrandResult beam = compute_sag(pla(), span);
  const AirStrand& strand = strands[0];
  EXPECT_TRUE(strand.straight);
  EXPECT_TRUE(strand.solved);
  EXPECT_NEAR(strand.diameter, kFree, 1e-9);
  EXPECT_NEAR(strand.speed, kSpeed, 1e-9);
  EXPECT_NEAR(strand.overfeed, 0, 1e-9);
  // Length, speed and diameter are rounded to 1 %; the sag goes with up to their fourth power.
  EXPECT_NEAR(strand.sag / beam.sag_max, 1, 0.05);
  EXPECT_NEAR(strand.sag_place_W.x(), beam.sag_max_position, 0.1e-3);
  EXPECT_NEAR(strand.sag_place_W.z(), 10e-3 - strand.sag, 1e-9);
  EXPECT_FALSE(strand.lies);
}

TEST(AirStrands, LieOnWhatIsBelowBeforeTheySagFarther) {
  const AirStrand free = solved({bridge(20e-3)})[0];
  UnsupportedStretch low = bridge(20e-3);
  low.worst_gap = 2.1 * kFree;
  ASSERT_GT(free.sag, low.worst_gap);
  const AirStrand lying = solved({low})[0];
  EXPECT_TRUE(lying.lies);
  EXPECT_EQ(lying.sag, low.worst_gap);
  EXPECT_NEAR(lying.sag_place_W.z(), 10e-3 - low.worst_gap, 1e-9);
}

TEST(AirStrands, AreThinnerWhereTheyAreDrawnAndSlackWhereTheyAreOverfed) {
  UnsupportedStretch drawn = bridge(5e-3), overfed = bridge(5e-3);
  drawn.volume *= 0.81;
  overfed.volume *= 1.05;
  const std::vector<AirStrand> strands = solved({drawn, overfed});
  EXPECT_NEAR(strands[0].diameter, 0.9 * kFree, 1e-9);
  EXPECT_EQ(strands[0].overfeed, 0);
  EXPECT_NEAR(strands[1].diameter, kFree, 1e-9);
  EXPECT_NEAR(strands[1].overfeed, 0.05, 1e-9);
  EXPECT_GT(strands[1].sag, strands[0].sag);
}

TEST(AirStrands, ComeInTheirOrderAndWithTheSameFiguresWhateverElseIsSolved) {
  std::vector<UnsupportedStretch> many;
  for (int line = 1; line <= 12; ++line) many.push_back(bridge((3 + line % 4) * 1e-3, line));
  UnsupportedStretch passed_over = bridge(5e-3, 99);
  passed_over.held_at_start = false;
  many.insert(many.begin() + 5, passed_over);
  const std::vector<AirStrand> strands = solved(many);
  ASSERT_EQ(strands.size(), 12u);
  for (int line = 1; line <= 12; ++line) {
    const AirStrand& strand = strands[static_cast<std::size_t>(line - 1)];
    EXPECT_EQ(strand.line, line);
    EXPECT_EQ(strand.sag, solved({bridge((3 + line % 4) * 1e-3)})[0].sag) << line;
  }
}

TEST(AirStrands, WhatSolvingThrowsComesOutAtTheEnd) {
  machine::MachineDescription hot = hexapod();
  hot.process.ambient_temperature = pla().glass_transition + 20;  // where no strand becomes solid
  AirStrandSolver solver(hot, pla());
  solver.add(bridge(5e-3));
  solver.add(bridge(6e-3));
  EXPECT_THROW(solver.finish(), InputError);
  EXPECT_TRUE(solved({}).empty());
}

}  // namespace
}  // namespace understudy::sim
