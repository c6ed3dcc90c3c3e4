#include "sim/strand/strand_creep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

using testing::HasSubstr;

// [K]: the cooling curve's table is good to 1e-5 of the 185 K from nozzle to air.
constexpr double kTable = 4e-3;

machine::Material pla() { return machine::load_material("pla"); }
StrandCreep creep(double start = 483.15) { return {pla(), from_mm(0.48), start, {}}; }

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
  EXPECT_NEAR(CoolingCurve(pla(), from_mm(0.48), 483.15, {}).temperature(solid), pla().glass_transition,
              1e-5);  // [K], as its table of temperatures is interpolated
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
  EXPECT_NEAR(cooling.temperature(strand.time_at_share(0.5)), middle, kTable);
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
