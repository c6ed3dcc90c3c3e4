#include "machine/cure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"

namespace understudy::machine {
namespace {

constexpr int kSlices = 64;  // of half a section: its area to 1e-4, for the root at its edge
constexpr double kMilliwatt = 1e-3;
constexpr double kMillijoulePerSquareCentimetre = 10;  // [J/m^2]

}  // namespace

// The disc's chord at the distance y from the middle, at irradiance 4 P / (pi d^2), takes sqrt(d^2 - 4 y^2) /
// v to pass over.
double Cure::exposure(double speed) const { return 4 * power / (std::numbers::pi * guide_diameter * speed); }

double Cure::depth(double speed) const {
  return penetration_depth * std::max(0.0, std::log(exposure(speed) / critical_exposure));
}

double Cure::width(double speed) const {
  const double share = critical_exposure / exposure(speed);
  return share < 1 ? guide_diameter * std::sqrt(1 - share * share) : 0;
}

double Cure::area(double speed, double gap) const {
  const double most = exposure(speed), half = 0.5 * width(speed), slice = half / kSlices;
  double area = 0;
  for (int i = 0; i < kSlices; ++i) {
    const double y = (i + 0.5) * slice, chord = std::sqrt(1 - 4 * y * y / (guide_diameter * guide_diameter));
    const double depth = penetration_depth * std::log(most * chord / critical_exposure);
    area += 2 * slice * std::clamp(depth, 0.0, std::max(0.0, gap));
  }
  return area;
}

void read_cure(YamlMap& map, Tool& tool, std::optional<Cure>& cure) {
  Cure read;
  read.guide_diameter =
      map.quantity("light_guide_diameter_mm", {0.01, 20}, "of the light at the guide's end");
  tool.nozzle_diameter = read.guide_diameter;
  tool.flat_diameter = map.quantity("flat_diameter_mm", {0.01, 50}, "of the guide's end, with its ferrule");
  // E counts mm3 of resin: a filament of 1 mm2.
  tool.filament_diameter = 2 / std::sqrt(std::numbers::pi) * kMillimetre;
  read.power =
      kMilliwatt * map.number("light_power_mw", {1e-3, 1e6}, "in mW, that leaves the guide while it draws");
  read.penetration_depth =
      map.quantity("penetration_depth_mm", {0.001, 50}, "depth of resin that takes 63 % of the light");
  read.critical_exposure =
      kMillijoulePerSquareCentimetre *
      map.number("critical_exposure_mj_per_cm2", {1e-3, 1e6}, "in mJ/cm2, from which the resin is solid");
  cure = read;
}

}  // namespace understudy::machine
