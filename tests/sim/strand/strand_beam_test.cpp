// The analytic limits of docs/reference.md#limits-of-a-strand for a beam, a string and what lies between.
#include "sim/strand/strand_beam.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr double kDensity = 1240;

BeamString::Section section(double length, int elements, double diameter, double modulus) {
  BeamString::Section s{};
  s.element_length = length / elements;
  s.area = std::numbers::pi / 4 * std::pow(diameter, 2);
  s.second_moment = std::numbers::pi / 64 * std::pow(diameter, 4);
  s.modulus = modulus;
  s.load_across = kDensity * s.area * kGravity;
  return s;
}

BeamString whole(const BeamString::Section& s, int elements, Hold start, Hold end) {
  BeamString strand(s, start, end, static_cast<std::size_t>(elements));
  for (int i = 0; i < elements; ++i) strand.append(0);
  return strand;
}

[[nodiscard]] bool step(BeamString& strand, double creep) {
  return strand.step(std::vector<double>(strand.elements(), creep));
}

/// Rate of a node [m per unit of creep] under unchanging load, after the elastic deflection.
double creep_rate(const BeamString::Section& s, int elements, Hold start, Hold end, std::size_t node) {
  BeamString strand = whole(s, elements, start, end);
  EXPECT_TRUE(step(strand, 0));
  const double before = strand.deflection(node);
  const double creep = 1e-3 / s.modulus;  // so small that the string has no say: (w/d)^2 is below 1e-8
  EXPECT_TRUE(step(strand, creep));
  return (strand.deflection(node) - before) / creep;
}

// 3e-5 is the reference's tolerance; cubic elements are exact at their nodes, so that only rounding is left.
TEST(StrandLimits, ViscousBeamsCreepAtTheClosedFormsRates) {
  const double length = from_mm(5);
  const auto s = section(length, 10, from_mm(0.4), 2.2e9);
  const double load = s.load_across * std::pow(length, 4) / s.second_moment;
  EXPECT_NEAR(creep_rate(s, 10, Hold::clamped, Hold::clamped, 5) / (load / 384), 1, 3e-5);
  EXPECT_NEAR(creep_rate(s, 10, Hold::pinned, Hold::pinned, 5) / (5 * load / 384), 1, 3e-5);
  EXPECT_NEAR(creep_rate(s, 10, Hold::clamped, Hold::free, 10) / (load / 8), 1, 3e-5);
  // Propped cantilever, at half of its length: q L^4/192.
  EXPECT_NEAR(creep_rate(s, 10, Hold::clamped, Hold::pinned, 5) / (load / 192), 1, 3e-5);
}

TEST(StrandLimits, ElasticBeamsBendByTheClosedForms) {
  const double length = from_mm(5);
  const auto s = section(length, 10, from_mm(0.4), 2.2e9);
  const double load = s.load_across * std::pow(length, 4) / (s.modulus * s.second_moment);
  BeamString simple = whole(s, 10, Hold::pinned, Hold::pinned);
  ASSERT_TRUE(step(simple, 0));
  EXPECT_NEAR(simple.deflection(5) / (5 * load / 384), 1, 1e-8);  // docs/reference.md#limits-of-a-strand
  BeamString cantilever = whole(s, 10, Hold::clamped, Hold::free);
  ASSERT_TRUE(step(cantilever, 0));
  EXPECT_NEAR(cantilever.deflection(10) / (load / 8), 1, 1e-8);
}

TEST(StrandLimits, AViscousStringSagsWithTheCubeRootOfTime) {
  // w^3 = 3 rho g L^4 t/(128 eta) from straight, at w of 15 and 20 diameters, where bending holds back by
  // less than (d/w)^2/4.3 = 0.1 %.
  const double length = 0.2, diameter = from_mm(0.4), viscosity = 1e6;
  const auto s = section(length, 20, diameter, 1e13);  // stiff: the elastic stretch is 1e-6 of the creep
  BeamString strand = whole(s, 20, Hold::pinned, Hold::pinned);
  const auto time_of = [&](double w) {
    return std::pow(w, 3) * 128 * viscosity / (3 * kDensity * kGravity * std::pow(length, 4));
  };
  const auto advance = [&](double from, double to, int steps) {
    for (int i = 0; i < steps; ++i) {
      const double a = from * std::pow(to / from, static_cast<double>(i) / steps);
      const double b = from * std::pow(to / from, static_cast<double>(i + 1) / steps);
      ASSERT_TRUE(step(strand, (b - a) / (3 * viscosity)));
    }
  };
  const double first = time_of(15 * diameter), second = time_of(20 * diameter), start = 1e-6 * first;
  ASSERT_TRUE(step(strand, start / (3 * viscosity)));
  advance(start, first, 1500);
  EXPECT_NEAR(strand.deflection(10) / (15 * diameter), 1, 5e-3);  // docs/reference.md#limits-of-a-strand
  advance(first, second, 200);
  EXPECT_NEAR(strand.deflection(10) / (20 * diameter), 1, 5e-3);
}

TEST(StrandLimits, AnElasticStringHangsByTheClosedForm) {
  // w^3 = 3 q L^4/(64 E A); at 15 diameters bending holds back by 0.1 % of w.
  const double length = 1;
  const auto s = section(length, 40, from_mm(0.4), 2.2e9);
  BeamString strand = whole(s, 40, Hold::pinned, Hold::pinned);
  ASSERT_TRUE(step(strand, 0));
  const double expected = std::cbrt(3 * s.load_across * std::pow(length, 4) / (64 * s.modulus * s.area));
  EXPECT_NEAR(strand.deflection(20) / expected, 1, 2e-3);
  // Its tension is the cable's, q L^2/(8 w).
  EXPECT_NEAR(strand.tension() / (s.load_across * length * length / (8 * strand.deflection(20))), 1, 5e-3);
}

TEST(StrandLimits, SlackHangsAsAParabola) {
  // w = L sqrt(3 eps/8) for a string that does not stretch: 306 um at 1 % and 5 mm,
  // docs/reference.md#limits-of-a-strand. So thin that the boundary layers in which it bends are 1e-4 of its
  // length.
  const double length = from_mm(5);
  auto s = section(length, 20, from_mm(0.4), 1e14);
  s.second_moment *= 1e-17;
  for (const double overfeed : {0.001, 0.01, 0.04}) {
    BeamString strand(s, Hold::pinned, Hold::pinned, 20);
    for (int i = 0; i < 20; ++i) strand.append(overfeed * s.element_length);
    ASSERT_TRUE(step(strand, 0));
    EXPECT_NEAR(strand.deflection(10) / (length * std::sqrt(3 * overfeed / 8)), 1, 1e-3) << overfeed;
    EXPECT_NEAR(strand.extra_length() / (overfeed * length), 1, 1e-6) << overfeed;
    if (overfeed == 0.01) {
      EXPECT_NEAR(to_um(strand.deflection(10)), 306, 0.5);
    }
  }
}

TEST(StrandLimits, WeightAlongTheChordIsTheTensionsDifference) {
  // Once a hot strand between two supports has crept, its upper half is pulled and its lower pressed, by half
  // of the weight each.
  const double length = from_mm(10);
  auto s = section(length, 20, from_mm(0.4), 2.2e9);
  s.load_along = -s.load_across;  // upwards from the first support
  s.load_across *= 1e-6;
  BeamString strand = whole(s, 20, Hold::clamped, Hold::clamped);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(step(strand, 1e-6));
  // The iteration stops at 1e-9 of the sag, which leaves 1e-6 of the tension open where there is hardly any
  // sag.
  EXPECT_NEAR(strand.tension() / (s.load_along * length / 2), 1, 1e-6);
}

TEST(StrandLimits, AStepOfAnyLengthAddsUp) {
  // Statically determinate, so that the moment is constant and implicit steps are exact.
  const double length = from_mm(5);
  const auto s = section(length, 8, from_mm(0.4), 2.2e9);
  BeamString once = whole(s, 8, Hold::clamped, Hold::free), often = once;
  ASSERT_TRUE(step(once, 1e-7));
  for (int i = 0; i < 64; ++i) ASSERT_TRUE(step(often, 1e-7 / 64));
  EXPECT_NEAR(often.deflection(8) / once.deflection(8), 1, 1e-9);
}

TEST(StrandLimits, AColumnOfHotStrandFallsAndSaysSo) {
  const double length = from_mm(20);
  auto s = section(length, 20, from_mm(0.4), 2.2e9);
  s.load_along = -s.load_across;
  s.load_across *= 0.1;
  BeamString strand = whole(s, 20, Hold::clamped, Hold::free);
  bool stands = true;
  for (int i = 0; i < 200 && stands; ++i) stands = step(strand, 1e-4);
  EXPECT_FALSE(stands);
  for (std::size_t i = 0; i <= 20; ++i) EXPECT_TRUE(std::isfinite(strand.deflection(i)));
}

}  // namespace
}  // namespace understudy::sim
