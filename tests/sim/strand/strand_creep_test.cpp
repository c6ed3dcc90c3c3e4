#include "sim/strand/strand_creep.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

using testing::HasSubstr;

machine::Material pla() { return machine::load_material("pla"); }
StrandCreep creep(double start = 483.15) { return {pla(), from_mm(0.48), start, {}}; }

/// [K]: how far two cubics of cooling may be apart, one of the time over the folding x = -ln of the share of
/// the temperature difference, one of x over the time, both through the same nodes h apart. A cubic is off by
/// h^4 / 384 of the fourth derivative: with s = dt/dx and its derivatives divided by s, that is s3 of the
/// first (in x), and of its inverse -s3 + 10 s1 s2 - 15 s1^3.
double cubics_apart(const machine::Material& material, double diameter, double start, double temperature) {
  constexpr double kStep = 8.0 / 64, kStefanBoltzmann = 5.670374419e-8;
  const Surroundings air;
  const double hot = start - air.temperature;
  const auto seconds = [&](double folding) {  // but for the strand's heat capacity
    const double T = air.temperature + hot * std::exp(-folding), Ta = air.temperature;
    return 1 / (convection_coefficient(diameter, T, air) +
                material.emissivity * kStefanBoltzmann * (T * T + Ta * Ta) * (T + Ta));
  };
  constexpr double d = 0.02;
  const double at = -std::log((temperature - air.temperature) / hot);
  double worst = 0;
  for (double x = at - kStep; x <= at + kStep; x += d) {  // the interval, wherever its nodes are
    const double s = seconds(x);
    const double s1 = (seconds(x + d) - seconds(x - d)) / (2 * d) / s;
    const double s2 = (seconds(x + d) - 2 * s + seconds(x - d)) / (d * d) / s;
    const double s3 = (seconds(x + 2 * d) - 2 * seconds(x + d) + 2 * seconds(x - d) - seconds(x - 2 * d)) /
                      (2 * d * d * d) / s;
    worst = std::max(worst, std::abs(s3) + std::abs(-s3 + 10 * s1 * s2 - 15 * s1 * s1 * s1));
  }
  return std::pow(kStep, 4) / 384 * worst * (temperature - air.temperature);
}

TEST(StrandCreep, IsTheIntegralOfTheFluidityOverTheCooling) {
  const CoolingCurve cooling(pla(), from_mm(0.48), 483.15, {});
  const StrandCreep strand = creep();
  // The trapezium rule in steps of 0.1 ms; three Gauss points of the code are good over 10 ms.
  for (double from = 0; from < 0.5; from += 0.05) {
    double integral = 0;
    constexpr int kSteps = 100;
    const double dt = 0.01 / kSteps;
    for (int k = 0; k < kSteps; ++k) {
      const double left = 1 / (3 * machine::viscosity(pla(), cooling.temperature(from + k * dt)));
      const double right = 1 / (3 * machine::viscosity(pla(), cooling.temperature(from + (k + 1) * dt)));
      integral += 0.5 * dt * (left + right);
    }
    EXPECT_NEAR(strand.between(from, from + 0.01) / integral, 1, 1e-5) << from;
  }
}

TEST(StrandCreep, EndsAtTheGlassTransition) {
  const StrandCreep strand = creep();
  const double solid = strand.time_to_solid();
  const double apart = cubics_apart(pla(), from_mm(0.48), 483.15, pla().glass_transition);
  EXPECT_LT(apart, 1e-5);
  EXPECT_NEAR(CoolingCurve(pla(), from_mm(0.48), 483.15, {}).temperature(solid), pla().glass_transition,
              apart);
  EXPECT_EQ(strand.between(solid, solid + 10), 0);
  EXPECT_EQ(strand.between(solid - 1e-3, solid), strand.between(solid - 1e-3, solid + 5));
  EXPECT_EQ(strand.between(1, 1), 0);
}

TEST(StrandCreep, AgesByTemperatureRunFromTheNozzlesToTheGlassTransition) {
  const StrandCreep strand = creep();
  EXPECT_EQ(strand.time_at_share(0), 0);
  EXPECT_EQ(strand.time_at_share(1), strand.time_to_solid());
  const CoolingCurve cooling(pla(), from_mm(0.48), 483.15, {});
  const double middle = 0.5 * (483.15 + pla().glass_transition);
  EXPECT_NEAR(cooling.temperature(strand.time_at_share(0.5)), middle,
              cubics_apart(pla(), from_mm(0.48), 483.15, middle));
}

TEST(StrandCreep, AStrandThatIsNeverHotOrNeverSolidIsRefused) {
  const auto complaint = [](double start, double ambient) -> std::string {
    Surroundings air;
    air.temperature = ambient;
    try {
      StrandCreep(pla(), from_mm(0.48), start, air);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(complaint(483.15, 298.15), "accepted");
  EXPECT_THAT(complaint(320, 298.15),
              HasSubstr("nozzle temperature is 46.9 C, not above the glass transition"));
  EXPECT_THAT(complaint(483.15, 350),
              HasSubstr("ambient temperature is 76.9 C, not below the glass transition"));
}

}  // namespace
}  // namespace understudy::sim
