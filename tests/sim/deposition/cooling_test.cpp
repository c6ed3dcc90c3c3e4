#include "sim/deposition/cooling.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

machine::Material abs() { return machine::load_material("abs"); }
machine::Material pla() { return machine::load_material("pla"); }

Surroundings fixed(double coefficient) {
  Surroundings s;
  s.coefficient = coefficient;
  return s;
}

Surroundings air(double speed) {
  Surroundings s;
  s.air_speed = speed;
  return s;
}

double time_to_solid(const machine::Material& m, double diameter, const Surroundings& s) {
  return CoolingCurve(m, diameter, m.nozzle_temperature, s).time_until(m.glass_transition);
}

TEST(Cooling, ConvectionAloneIsAnExponential) {
  machine::Material m = abs();
  m.emissivity = 0;
  const double d = from_mm(0.4), h = 60, start = m.nozzle_temperature, ambient = 298.15;
  const CoolingCurve curve(m, d, start, fixed(h));
  // t = rho cp d/(4 h) ln((T0 - Ta)/(T - Ta)), docs/reference.md#cooling. The table is in that logarithm:
  // rounding only.
  const double constant = m.density * m.specific_heat * d / (4 * h);
  const double expected = constant * std::log((start - ambient) / (m.glass_transition - ambient));
  EXPECT_NEAR(curve.time_until(m.glass_transition), expected, 1e-9);
  for (const double t : {0.1, 1.0, 3.0, 20.0, 60.0})
    EXPECT_NEAR(curve.temperature(t), ambient + (start - ambient) * std::exp(-t / constant), 1e-7) << t;
}

TEST(Cooling, FollowsTheEquationWithRadiationAndAirThatChangesWithTemperature) {
  // The equation itself, by Runge-Kutta with steps of a millisecond (its error is below 1e-9 K).
  const machine::Material m = pla();
  const double d = from_mm(0.48), sigma = 5.670374419e-8;
  const Surroundings still = air(0);
  const auto rate = [&](double T) {
    return -4 / (m.density * m.specific_heat * d) *
           (convection_coefficient(d, T, still) * (T - still.temperature) +
            m.emissivity * sigma * (std::pow(T, 4) - std::pow(still.temperature, 4)));
  };
  const CoolingCurve curve(m, d, m.nozzle_temperature, still);
  double T = m.nozzle_temperature;
  const double dt = 1e-3;
  for (int i = 1; i <= 40000; ++i) {
    const double a = rate(T), b = rate(T + dt / 2 * a), c = rate(T + dt / 2 * b), e = rate(T + dt * c);
    T += dt / 6 * (a + 2 * b + 2 * c + e);
    // Cubics over 64 intervals: 1e-5 of the 185 K.
    if (i % 500 == 0) {
      ASSERT_NEAR(curve.temperature(i * dt), T, 2e-3) << i * dt;
    }
  }
}

TEST(Cooling, TimesToTheGlassTransitionAreTheReferences) {
  // docs/reference.md#cooling: h, then seconds at 0.40 and 0.48 mm.
  const double h[6] = {20, 40, 60, 100, 200, 350};
  const double abs_times[6][2] = {{6.7, 8.1}, {4.1, 4.9}, {2.9, 3.5}, {1.85, 2.2}, {.97, 1.16}, {.57, .68}};
  const double pla_times[6][2] = {{13.1, 15.7}, {7.7, 9.2}, {5.4, 6.5}, {3.4, 4.1}, {1.8, 2.1}, {1.04, 1.24}};
  const double diameters[2] = {from_mm(0.40), from_mm(0.48)};
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 2; ++k) {
      // 3 % as asked for; the table's two digits are worth up to 2 % of it.
      EXPECT_NEAR(time_to_solid(abs(), diameters[k], fixed(h[i])) / abs_times[i][k], 1, 0.03)
          << h[i] << " " << k;
      EXPECT_NEAR(time_to_solid(pla(), diameters[k], fixed(h[i])) / pla_times[i][k], 1, 0.03)
          << h[i] << " " << k;
    }
}

TEST(Cooling, StillAirAndWindHaveTheReferencesCoefficients) {
  // docs/reference.md#cooling, for a 0.48 mm strand: "about 45" in still air, 165 at 1 m/s, 340 at 5 m/s.
  // Natural convection changes with the strand's temperature (42 to 56), so the figure is compared at the
  // glass transition and widely; forced convection hardly does, and 3 % covers another table of air's
  // properties.
  const double d = from_mm(0.48);
  for (const machine::Material& m : {abs(), pla()}) {
    EXPECT_NEAR(convection_coefficient(d, m.glass_transition, air(0)), 45, 0.1 * 45) << m.name;
    for (const double T : {m.glass_transition, m.nozzle_temperature}) {
      EXPECT_NEAR(forced_convection(d, T, 298.15, 1), 165, 0.03 * 165) << m.name;
      EXPECT_NEAR(forced_convection(d, T, 298.15, 5), 340, 0.03 * 340) << m.name;
    }
  }
}

TEST(Cooling, AirIsThatOfPublishedTables) {
  // Incropera, table A.4, air at atmospheric pressure: conductivity, kinematic viscosity, Prandtl number.
  const double rows[][4] = {{300, 26.3e-3, 15.89e-6, 0.707},
                            {350, 30.0e-3, 20.92e-6, 0.700},
                            {400, 33.8e-3, 26.41e-6, 0.690},
                            {500, 40.7e-3, 38.79e-6, 0.684}};
  for (const auto& row : rows) {
    const AirProperties properties = air_at(row[0]);
    // 3 %: what Sutherland's laws promise, and a specific heat that is taken as constant.
    EXPECT_NEAR(properties.conductivity / row[1], 1, 0.03) << row[0];
    EXPECT_NEAR(properties.kinematic_viscosity / row[2], 1, 0.03) << row[0];
    EXPECT_NEAR(properties.prandtl / row[3], 1, 0.03) << row[0];
  }
}

TEST(Cooling, MoreWindCoolsMoreAndJoinsStillAirWithoutAStep) {
  const double d = from_mm(0.4), T = 450;
  double before = convection_coefficient(d, T, air(0));
  EXPECT_NEAR(convection_coefficient(d, T, air(1e-9)), before, 0.01 * before);
  for (const double speed : {0.05, 0.1, 0.3, 1.0, 3.0, 10.0}) {
    const double now = convection_coefficient(d, T, air(speed));
    EXPECT_GT(now, before) << speed;
    EXPECT_GE(now, forced_convection(d, T, 298.15, speed));
    before = now;
  }
}

TEST(Cooling, TemperatureAndTimeAreInverse) {
  const CoolingCurve curve(abs(), from_mm(0.4), abs().nozzle_temperature, air(0.7));
  for (double T = 299; T < abs().nozzle_temperature; T += 7)
    EXPECT_NEAR(curve.temperature(curve.time_until(T)), T, 2e-3) << T;  // two interpolations of one relation
  EXPECT_EQ(curve.temperature(-1), abs().nozzle_temperature);
  EXPECT_EQ(curve.time_until(600), 0);
  EXPECT_EQ(curve.time_until(298.15), std::numeric_limits<double>::infinity());
  EXPECT_EQ(curve.time_until(200), std::numeric_limits<double>::infinity());
  EXPECT_NEAR(curve.temperature(1e6), 298.15, 1e-9);
}

TEST(Cooling, AColdStrandWarmsInAnOven) {
  Surroundings oven = fixed(50);
  oven.temperature = 500;
  const CoolingCurve curve(abs(), from_mm(0.4), 300, oven);
  EXPECT_GT(curve.temperature(1), 300);
  EXPECT_LT(curve.temperature(1), curve.temperature(2));
  EXPECT_NEAR(curve.temperature(curve.time_until(400)), 400, 2e-3);
}

TEST(Cooling, RefusesWhatIsNoStrandOrNoAir) {
  const auto message = [](double d, double T, const Surroundings& s) -> std::string {
    try {
      CoolingCurve(abs(), d, T, s);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  using testing::HasSubstr;
  EXPECT_THAT(message(0, 500, air(0)), HasSubstr("diameter is 0 m"));
  EXPECT_THAT(message(NAN, 500, air(0)), HasSubstr("diameter"));
  EXPECT_THAT(message(4e-4, -3, air(0)), HasSubstr("start temperature is -3 K"));
  EXPECT_THAT(message(4e-4, 500, air(-1)), HasSubstr("air speed is -1 m/s"));
  EXPECT_THAT(message(4e-4, 500, fixed(0)), HasSubstr("coefficient is 0"));
  Surroundings nowhere;
  nowhere.temperature = INFINITY;
  EXPECT_THAT(message(4e-4, 500, nowhere), HasSubstr("ambient temperature"));
}

}  // namespace
}  // namespace understudy::sim
