#include "sim/strand/strand.h"

#include <cmath>
#include <functional>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

AirSpan span(double length_mm, double diameter_mm, double speed_mm_per_s, double coefficient) {
  AirSpan s;
  s.length = from_mm(length_mm);
  s.diameter = from_mm(diameter_mm);
  s.speed = from_mm(speed_mm_per_s);
  s.surroundings.coefficient = coefficient;
  return s;
}

struct Row {
  const char* material;
  double diameter_mm, speed_mm_per_s, coefficient;
  double sag_um[3];
};

constexpr double kLengths[3] = {5, 11, 20};  // [mm]

// docs/reference.md#sag: mid-span, clamped at both ends, no overfeed.
constexpr Row kTable[] = {{"pla", 0.48, 1, 20, {70, 190, 206}},    {"pla", 0.48, 1, 60, {2.9, 3.3, 4.8}},
                          {"pla", 0.48, 5, 20, {228, 1130, 2600}}, {"pla", 0.48, 5, 60, {77, 551, 1275}},
                          {"pla", 0.48, 5, 150, {12.5, 29, 32}},   {"abs", 0.45, 5, 20, {59, 500, 1300}},
                          {"abs", 0.45, 5, 60, {13, 50, 60}}};

double middle_um(const Row& row, int column, const StrandOptions& options = {}) {
  const StrandResult result =
      compute_sag(machine::load_material(row.material),
                  span(kLengths[column], row.diameter_mm, row.speed_mm_per_s, row.coefficient), options);
  return to_um(result.sag_middle);
}

std::string cell_name(const Row& row, int column, int elements) {
  std::ostringstream text;
  text << row.material << ", " << row.speed_mm_per_s << " mm/s, h " << row.coefficient << ", "
       << kLengths[column] << " mm, " << elements << " elements";
  return text.str();
}

TEST(Strand, SagIsTheReferencesTable) {
  // 10 % up to 11 mm, 15 % at 20 mm, as asked for. Two cells come near: the reference's grid is about as
  // coarse as 16 to 20 elements (next test).
  for (const Row& row : kTable)
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR(middle_um(row, column) / row.sag_um[column], 1, column == 2 ? 0.15 : 0.10)
          << cell_name(row, column, 40);
}

TEST(Strand, TheReferencesTableHasTheFiguresOfACoarseGrid) {
  // With 20 elements every cell is within 7 %, also those that a finer grid moves away.
  StrandOptions coarse;
  coarse.elements = 20;
  for (const Row& row : kTable)
    for (int column = 0; column < 3; ++column)
      EXPECT_NEAR(middle_um(row, column, coarse) / row.sag_um[column], 1, 0.07) << cell_name(row, column, 20);
}

TEST(SlowStrand, ConvergesWithElementsAndTimeSteps) {
  StrandOptions fine;
  fine.elements = 320;
  fine.cooling_steps = 320;
  for (const Row& row : kTable)
    for (int column = 0; column < 3; ++column) {
      const double truth = middle_um(row, column, fine);
      double before = 0;
      for (const int n : {20, 40, 80}) {
        StrandOptions options;
        options.elements = options.cooling_steps = n;
        const double error = std::abs(middle_um(row, column, options) / truth - 1);
        // The default, 40, is within 4 %; halving both steps at least takes the error down by a third where
        // it is not below 0.5 % already.
        if (n == 40) {
          EXPECT_LT(error, 0.04) << cell_name(row, column, n);
        }
        if (n > 20) {
          EXPECT_LT(error, std::max(0.67 * before, 0.005)) << cell_name(row, column, n);
        }
        before = error;
      }
    }
}

TEST(Strand, MoreAirLessSagHotterMoreWiderMore) {
  const machine::Material pla = machine::load_material("pla");
  const auto sag = [&](const std::function<void(AirSpan&)>& change) {
    AirSpan s = span(8, 0.48, 5, 60);
    s.surroundings.coefficient.reset();
    s.surroundings.air_speed = 0.5;
    change(s);
    return compute_sag(pla, s).sag_max;
  };
  const double plain = sag([](AirSpan&) {});
  EXPECT_LT(sag([](AirSpan& s) { s.surroundings.air_speed = 1; }), 0.7 * plain);
  EXPECT_GT(sag([](AirSpan& s) { s.surroundings.air_speed = 0; }), 2 * plain);
  EXPECT_GT(sag([](AirSpan& s) { s.nozzle_temperature = kCelsiusZero + 225; }), 1.05 * plain);
  EXPECT_LT(sag([](AirSpan& s) { s.nozzle_temperature = kCelsiusZero + 190; }), 0.95 * plain);
  EXPECT_GT(sag([](AirSpan& s) { s.length *= 1.5; }), 1.2 * plain);
  EXPECT_LT(sag([](AirSpan& s) { s.length /= 2; }), 0.5 * plain);
  EXPECT_GT(sag([](AirSpan& s) { s.end = Hold::pinned; }), plain);
  EXPECT_GT(sag([](AirSpan& s) { s.nozzle = Hold::pinned; }), plain);
  EXPECT_GT(sag([](AirSpan& s) { s.surroundings.temperature += 20; }), plain);
}

TEST(Strand, StrutsOfFiveMillimetresAtOneMillimetreASecondNeedForcedAir) {
  // Ishak 2018: 5 mm struts, 0.48 mm, 1 mm/s, forced air: no sag. docs/reference.md#sag: h 150 solidifies
  // in 2.8 s, within the 5 s of a strut; still air takes 6.5 s (its h of 60).
  const machine::Material pla = machine::load_material("pla");
  const StrandResult forced = compute_sag(pla, span(5, 0.48, 1, 150));
  EXPECT_NEAR(forced.time_to_solid, 2.8, 0.03 * 2.8);
  EXPECT_TRUE(forced.start_solid_before_arrival);
  EXPECT_NEAR(forced.solid_at, 5 + forced.time_to_solid, 1e-12);
  EXPECT_LT(to_um(forced.sag_max), 1);  // a 480th of the strut's diameter
  const StrandResult still = compute_sag(pla, span(5, 0.48, 1, 60));
  EXPECT_NEAR(still.time_to_solid, 6.5, 0.03 * 6.5);
  EXPECT_FALSE(still.start_solid_before_arrival);
  // Natural convection and radiation by the correlations take longer still.
  AirSpan unblown = span(5, 0.48, 1, 60);
  unblown.surroundings.coefficient.reset();
  EXPECT_GT(compute_sag(pla, unblown).time_to_solid, 6.5);
  EXPECT_FALSE(compute_sag(pla, unblown).start_solid_before_arrival);
}

TEST(Strand, OverfeedLengthensAndTheOneBowIsTheReferences) {
  const machine::Material pla = machine::load_material("pla");
  AirSpan s = span(5, 0.48, 5, 150);
  const StrandResult plain = compute_sag(pla, s);
  s.overfeed = 0.01;
  const StrandResult fed = compute_sag(pla, s);
  // 306 um at 1 % and 5 mm; gravity adds some, the elastic part of compression takes some: 3 %.
  EXPECT_NEAR(to_um(fed.sag_one_bow), 306, 0.03 * 306);
  EXPECT_GT(fed.sag_max, 5 * plain.sag_max);
  EXPECT_LT(fed.sag_max, fed.sag_one_bow);
  // What is free to creep thicker does so instead of folding.
  s.slack_kept = false;
  const StrandResult thicker = compute_sag(pla, s);
  EXPECT_LT(thicker.sag_max, 1.1 * plain.sag_max);
  // Drawn thinner, it is tauter.
  s.overfeed = -0.05;
  EXPECT_LT(compute_sag(pla, s).sag_max, plain.sag_max);
}

TEST(Strand, OnlyTheWeightAcrossTheChordBends) {
  // Where tension has no say, sag is proportional to the cosine of the slope; along the plumb line there is
  // none.
  const machine::Material pla = machine::load_material("pla");
  AirSpan s = span(5, 0.48, 5, 150);
  const double level = compute_sag(pla, s).sag_max;
  for (const double slope : {-60.0, 60.0}) {
    s.slope = from_deg(slope);
    EXPECT_NEAR(compute_sag(pla, s).sag_max / level, 0.5, 0.01)
        << slope;  // 1 %: what tension and weight along do
  }
  s.slope = from_deg(90);
  EXPECT_LT(compute_sag(pla, s).sag_max, 1e-9);
}

TEST(Strand, WithoutAFarSupportItSagsUntilItIsSolid) {
  const machine::Material pla = machine::load_material("pla");
  AirSpan s = span(5, 0.48, 5, 150);
  const StrandResult held = compute_sag(pla, s);
  s.end = Hold::free;
  const StrandResult loose = compute_sag(pla, s);
  EXPECT_EQ(loose.sag_at_arrival, held.sag_at_arrival);
  EXPECT_GT(loose.sag_max, 5 * held.sag_max);
  EXPECT_NEAR(loose.sag_max_position, s.length, 1e-12);
  EXPECT_FALSE(loose.falls);
  // In still air it is a thread of honey.
  s.surroundings.coefficient = 20;
  const StrandResult falls = compute_sag(pla, s);
  EXPECT_TRUE(falls.falls);
  EXPECT_TRUE(std::isfinite(falls.sag_max));
}

TEST(Strand, AColdStrandIsAnElasticBeam) {
  // So slow that the hot length is a few hundredths of the span: what is left is the weight of the growing
  // elastic beam, less than its whole weight at once, 5 q L^4/(384 E I).
  const machine::Material abs = machine::load_material("abs");
  const AirSpan s = span(20, 0.4, 0.1, 350);
  const double d = s.diameter, weight = abs.density * M_PI / 4 * d * d * kGravity;
  const double simple =
      5 * weight * std::pow(s.length, 4) / (384 * abs.youngs_modulus * M_PI / 64 * std::pow(d, 4));
  const StrandResult r = compute_sag(abs, s);
  EXPECT_GT(r.sag_max, 0.1 * simple);
  EXPECT_LT(r.sag_max, simple);
}

TEST(Strand, RefusesWhatIsNoStrand) {
  const auto message = [](const std::function<void(AirSpan&)>& change) -> std::string {
    AirSpan s = span(5, 0.48, 5, 60);
    change(s);
    try {
      compute_sag(machine::load_material("pla"), s);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  using testing::HasSubstr;
  EXPECT_EQ(message([](AirSpan&) {}), "accepted");
  EXPECT_THAT(message([](AirSpan& s) { s.length = 0; }), HasSubstr("span is 0 mm, outside 0.01 to 1000 mm"));
  EXPECT_THAT(message([](AirSpan& s) { s.diameter = -1; }), HasSubstr("diameter is -1000 mm"));
  EXPECT_THAT(message([](AirSpan& s) { s.speed = NAN; }), HasSubstr("nozzle speed is nan"));
  EXPECT_THAT(message([](AirSpan& s) { s.overfeed = 0.5; }),
              HasSubstr("overfeed is 0.5, outside -0.1 to 0.1"));
  EXPECT_THAT(message([](AirSpan& s) { s.slope = 2; }), HasSubstr("slope"));
  EXPECT_THAT(message([](AirSpan& s) { s.start = Hold::free; }), HasSubstr("its start is free"));
  EXPECT_THAT(message([](AirSpan& s) { s.nozzle = Hold::free; }), HasSubstr("at the nozzle is free"));
  EXPECT_THAT(message([](AirSpan& s) { s.start = Hold::pinned, s.end = Hold::free; }),
              HasSubstr("nothing holds it"));
  EXPECT_THAT(
      message([](AirSpan& s) { s.nozzle_temperature = kCelsiusZero + 50; }),
      HasSubstr("nozzle temperature is 50.0 C, outside 180.0 to 240.0 C of material pla and not above"));
  EXPECT_THAT(message([](AirSpan& s) { s.surroundings.temperature = kCelsiusZero + 70; }),
              HasSubstr("ambient temperature is 70.0 C, not below the glass transition of pla at 60.0 C"));
}

}  // namespace
}  // namespace understudy::sim
