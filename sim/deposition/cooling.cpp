#include "sim/deposition/cooling.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

constexpr double kStefanBoltzmann = 5.670374419e-8;  // [W/(m^2 K^4)]

double radiation_coefficient(double emissivity, double surface, double ambient) {
  return emissivity * kStefanBoltzmann * (surface * surface + ambient * ambient) * (surface + ambient);
}

void require_positive(double value, const char* name, const char* unit) {
  if (!(value > 0) || !std::isfinite(value))
    throw InputError(fmt::format("cooling: {} is {}{}, must be above 0 and finite", name, value, unit));
}

}  // namespace

AirProperties air_at(double temperature) {
  constexpr double kZero = 273, kPressure = 101325, kGas = 287.05, kSpecificHeat = 1006;
  const double ratio = std::pow(temperature / kZero, 1.5);
  const double viscosity = 1.716e-5 * ratio * (kZero + 111) / (temperature + 111);
  const double conductivity = 0.0241 * ratio * (kZero + 194) / (temperature + 194);
  const double density = kPressure / (kGas * temperature);
  return {conductivity, viscosity / density, kSpecificHeat * viscosity / conductivity};
}

double natural_convection(double diameter, double surface_temperature, double air_temperature) {
  const double film = 0.5 * (surface_temperature + air_temperature);
  const AirProperties air = air_at(film);
  const double rayleigh = kGravity / film * std::abs(surface_temperature - air_temperature) *
                          std::pow(diameter, 3) * air.prandtl / std::pow(air.kinematic_viscosity, 2);
  const double root = 0.60 + 0.387 * std::pow(rayleigh, 1.0 / 6) /
                                 std::pow(1 + std::pow(0.559 / air.prandtl, 9.0 / 16), 8.0 / 27);
  return root * root * air.conductivity / diameter;
}

double forced_convection(double diameter, double surface_temperature, double air_temperature, double speed) {
  const AirProperties air = air_at(0.5 * (surface_temperature + air_temperature));
  const double reynolds = speed * diameter / air.kinematic_viscosity;
  const double nusselt = 0.3 + 0.62 * std::sqrt(reynolds) * std::cbrt(air.prandtl) /
                                   std::pow(1 + std::pow(0.4 / air.prandtl, 2.0 / 3), 0.25) *
                                   std::pow(1 + std::pow(reynolds / 282000, 0.625), 0.8);
  return nusselt * air.conductivity / diameter;
}

double convection_coefficient(double diameter, double surface_temperature, const Surroundings& surroundings) {
  if (surroundings.coefficient) return *surroundings.coefficient;
  const double natural = natural_convection(diameter, surface_temperature, surroundings.temperature);
  if (surroundings.air_speed <= 0) return natural;
  const double forced =
      forced_convection(diameter, surface_temperature, surroundings.temperature, surroundings.air_speed);
  return std::pow(std::pow(natural, 4) + std::pow(forced, 4), 0.25);
}

CoolingCurve::CoolingCurve(const machine::Material& material, double diameter, double start_temperature,
                           const Surroundings& surroundings)
    : start_(start_temperature), ambient_(surroundings.temperature) {
  require_positive(diameter, "strand diameter", " m");
  require_positive(start_temperature, "start temperature", " K");
  require_positive(ambient_, "ambient temperature", " K");
  if (surroundings.coefficient)
    require_positive(*surroundings.coefficient, "heat transfer coefficient", " W/m2K");
  if (!(surroundings.air_speed >= 0) || !std::isfinite(surroundings.air_speed))
    throw InputError(fmt::format("cooling: air speed is {} m/s, must be 0 or more", surroundings.air_speed));

  const double capacity = material.density * material.specific_heat * diameter / 4;  // [J/(m^2 K)]
  const auto seconds_per_folding = [&](double folding) {
    const double surface = ambient_ + (start_ - ambient_) * std::exp(-folding);
    return capacity / (convection_coefficient(diameter, surface, surroundings) +
                       radiation_coefficient(material.emissivity, surface, ambient_));
  };
  constexpr double kStep = kDepth / kIntervals;
  const double gauss = std::sqrt(0.6) * kStep / 2;
  for (int k = 0; k <= kIntervals; ++k) {
    const auto at = static_cast<std::size_t>(k);
    slope_[at] = seconds_per_folding(k * kStep);
    if (k == 0) continue;
    const double middle = (k - 0.5) * kStep;
    time_[at] =
        time_[at - 1] + kStep / 18 *
                            (5 * seconds_per_folding(middle - gauss) + 8 * seconds_per_folding(middle) +
                             5 * seconds_per_folding(middle + gauss));
  }
}

namespace {

/// Cubic with values and slopes at both ends of [0, width], at x.
double hermite(double x, double width, double y0, double y1, double slope0, double slope1) {
  const double s = x / width, r = 1 - s;
  return y0 * r * r * (1 + 2 * s) + y1 * s * s * (1 + 2 * r) + width * s * r * (slope0 * r - slope1 * s);
}

}  // namespace

double CoolingCurve::temperature(double age) const {
  if (!(age > 0)) return start_;
  double folding = 0;
  if (age >= time_.back()) {
    folding = kDepth + (age - time_.back()) / slope_.back();
  } else {
    const auto next = std::upper_bound(time_.begin(), time_.end(), age);
    const auto k = static_cast<std::size_t>(next - time_.begin()) - 1;
    constexpr double kStep = kDepth / kIntervals;
    folding = hermite(age - time_[k], time_[k + 1] - time_[k], static_cast<double>(k) * kStep,
                      static_cast<double>(k + 1) * kStep, 1 / slope_[k], 1 / slope_[k + 1]);
  }
  return ambient_ + (start_ - ambient_) * std::exp(-folding);
}

double CoolingCurve::time_until(double temperature) const {
  const double share = (temperature - ambient_) / (start_ - ambient_);
  if (std::isnan(share) || share >= 1) return 0;
  if (share <= 0) return std::numeric_limits<double>::infinity();
  const double folding = -std::log(share);
  if (folding >= kDepth) return time_.back() + (folding - kDepth) * slope_.back();
  constexpr double kStep = kDepth / kIntervals;
  const auto k = static_cast<std::size_t>(folding / kStep);
  return hermite(folding - static_cast<double>(k) * kStep, kStep, time_[k], time_[k + 1], slope_[k],
                 slope_[k + 1]);
}

double biot_number(const machine::Material& material, double diameter, double surface_temperature,
                   const Surroundings& surroundings) {
  if (!(material.conductivity > 0)) return std::numeric_limits<double>::infinity();
  const double coefficient =
      convection_coefficient(diameter, surface_temperature, surroundings) +
      radiation_coefficient(material.emissivity, surface_temperature, surroundings.temperature);
  return coefficient * diameter / (4 * material.conductivity);
}

}  // namespace understudy::sim
