// How a thin strand cools in air: convection from a horizontal cylinder and radiation, the strand at one
// temperature across its section (lumped). The lumping is good while biot_number() is below about 0.1-0.2.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "machine/material.h"

namespace understudy::sim {

/// Dry air at 101325 Pa.
struct AirProperties {
  double conductivity;         ///< [W/(m K)]
  double kinematic_viscosity;  ///< [m^2/s]
  double prandtl;
};

/// Sutherland's laws for viscosity and conductivity (White, Viscous Fluid Flow, tables 1-2 and 1-3), ideal
/// gas density, Prandtl number from a specific heat of 1006 J/(kg K). Good to 3 % between 230 and 700 K [K].
AirProperties air_at(double temperature);

/// [W/(m^2 K)]. Churchill and Chu 1975, horizontal cylinder, all Rayleigh numbers; properties at the film
/// temperature.
double natural_convection(double diameter, double surface_temperature, double air_temperature);

/// [W/(m^2 K)]. Churchill and Bernstein 1977, cross-flow at `speed` [m/s]. At speed 0 it stays at the
/// conduction term 0.3 of the correlation.
double forced_convection(double diameter, double surface_temperature, double air_temperature, double speed);

/// What surrounds a strand.
struct Surroundings {
  double temperature = 298.15;        ///< [K], air and everything that the strand radiates to
  double air_speed = 0;               ///< [m/s] across the strand; 0 is still air
  std::optional<double> coefficient;  ///< [W/(m^2 K)]: convection at this value, whatever the air does
};

/// [W/(m^2 K)] of convection: Nu^4 = Nu_natural^4 + Nu_forced^4 (transverse mixed flow about a cylinder,
/// Incropera section 9.9), without radiation.
double convection_coefficient(double diameter, double surface_temperature, const Surroundings& surroundings);

/// Temperature over age of a strand that left the nozzle at `start_temperature`:
/// rho cp d/4 dT/dt = -h (T - Ta) - emissivity sigma (T^4 - Ta^4).
///
/// Built once (tens of microseconds), asked in tens of nanoseconds: the relation is tabulated in
/// ln((T - Ta)/(T0 - Ta)), in which it is nearly straight, and interpolated by cubics (to 1e-5 of T0 - Ta).
class CoolingCurve {
 public:
  /// Throws InputError for a diameter, temperature, air speed or coefficient that is not positive and finite.
  CoolingCurve(const machine::Material& material, double diameter, double start_temperature,
               const Surroundings& surroundings);

  double temperature(double age) const;         ///< [K] at age [s]; the start's for ages below 0
  double time_until(double temperature) const;  ///< [s]; 0 if it starts there or beyond, infinity if never
  double start_temperature() const { return start_; }

 private:
  static constexpr int kIntervals = 64;
  static constexpr double kDepth = 8;  ///< e-foldings covered; an exponential goes on from there

  double start_, ambient_;
  std::array<double, kIntervals + 1> time_{};   ///< [s], at ln((T - Ta)/(T0 - Ta)) = -k kDepth/kIntervals
  std::array<double, kIntervals + 1> slope_{};  ///< [s] per e-folding
};

/// h d/(4 k) with convection and radiation at the surface temperature: how much of the temperature difference
/// stands inside the strand. Infinity for a material whose conductivity is 0 (unknown).
double biot_number(const machine::Material& material, double diameter, double surface_temperature,
                   const Surroundings& surroundings);

}  // namespace understudy::sim
