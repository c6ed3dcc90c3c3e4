#include "sim/strand/strand_creep.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {

StrandCreep::StrandCreep(const machine::Material& material, double diameter, double start_temperature,
                         const Surroundings& surroundings)
    : material_(material),
      cooling_(material, diameter, start_temperature, surroundings),
      time_to_solid_(cooling_.time_until(material.glass_transition)) {
  if (!(start_temperature > material.glass_transition))
    throw InputError(fmt::format(
        "strand: nozzle temperature is {:.1f} C, not above the glass transition of {} at {:.1f} C",
        start_temperature - kCelsiusZero, material.name, material.glass_transition - kCelsiusZero));
  if (!(surroundings.temperature < material.glass_transition))
    throw InputError(fmt::format(
        "strand: ambient temperature is {:.1f} C, not below the glass transition of {} at {:.1f} C",
        surroundings.temperature - kCelsiusZero, material.name, material.glass_transition - kCelsiusZero));
}

double StrandCreep::between(double from, double to) const {
  to = std::min(to, time_to_solid_);
  if (!(to > from)) return 0;
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const auto fluidity = [&](double age) {
    return 1 / (3 * machine::viscosity(material_, cooling_.temperature(age)));
  };
  return half / 9 *
         (5 * fluidity(middle - std::sqrt(0.6) * half) + 8 * fluidity(middle) +
          5 * fluidity(middle + std::sqrt(0.6) * half));
}

double StrandCreep::time_at_share(double share) const {
  if (share >= 1) return time_to_solid_;
  const double start = cooling_.start_temperature();
  return cooling_.time_until(start + share * (material_.glass_transition - start));
}

}  // namespace understudy::sim
