// Conversions between the SI units of the code and the units of files, command line and reports.
#pragma once

#include <numbers>

namespace understudy {

constexpr double kMillimetre = 1e-3;                  // [m]
constexpr double kMicrometre = 1e-6;                  // [m]
constexpr double kDegree = std::numbers::pi / 180.0;  // [rad]
constexpr double kInch = 25.4e-3;                     // [m]
constexpr double kMillimetrePerMinute = 1e-3 / 60.0;  // [m/s]
constexpr double kCelsiusZero = 273.15;               // [K]
constexpr double kGravity = 9.80665;                  // [m/s^2]

constexpr double from_mm(double v) { return v * kMillimetre; }
constexpr double to_mm(double v) { return v * 1e3; }
constexpr double to_um(double v) { return v * 1e6; }
constexpr double from_deg(double v) { return v * kDegree; }
constexpr double to_deg(double v) { return v / kDegree; }
constexpr double to_mrad(double v) { return v * 1e3; }

}  // namespace understudy
