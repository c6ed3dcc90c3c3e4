#include "sim/strand/strand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/strand/strand_creep.h"

namespace understudy::sim {
namespace {

constexpr int kElementsMost = 160;
constexpr int kElementsOfHotLength = 12;

void check_range(double value, double low, double high, const char* name, const char* unit) {
  if (!(value >= low && value <= high))
    throw InputError(
        fmt::format("strand: {} is {}{}, outside {} to {}{}", name, value, unit, low, high, unit));
}

void check(const AirSpan& span, const StrandOptions& options) {
  check_range(to_mm(span.length), 0.01, 1000, "span", " mm");
  check_range(to_mm(span.diameter), 0.01, 10, "diameter", " mm");
  check_range(to_mm(span.speed), 0.001, 10000, "nozzle speed", " mm/s");
  check_range(to_deg(span.slope), -90, 90, "slope", " deg");
  check_range(span.overfeed, -0.1, 0.1, "overfeed", "");
  check_range(options.elements, 4, 1000, "number of elements", "");
  check_range(options.cooling_steps, 4, 10000, "number of cooling steps", "");
  if (span.start == Hold::free) throw InputError("strand: its start is free, must be clamped or pinned");
  if (span.nozzle == Hold::free)
    throw InputError("strand: its end at the nozzle is free, must be clamped or pinned");
  if (span.end == Hold::free && span.start == Hold::pinned)
    throw InputError("strand: its end is free and its start pinned, so that nothing holds it");
}

BeamString::Section section_of(const machine::Material& material, const AirSpan& span,
                               double element_length) {
  const double d2 = span.diameter * span.diameter;
  BeamString::Section section{};
  section.element_length = element_length;
  section.area = std::numbers::pi / 4 * d2;
  section.second_moment = std::numbers::pi / 64 * d2 * d2;
  section.modulus = material.youngs_modulus;
  const double weight = material.density * section.area * kGravity;
  section.load_across = weight * std::cos(span.slope);
  section.load_along = -weight * std::sin(span.slope);
  section.keeps_length = span.slack_kept && span.overfeed > 0;
  return section;
}

std::size_t element_count(const AirSpan& span, double hot_length, const StrandOptions& options) {
  const double wanted = kElementsOfHotLength * span.length / hot_length * options.elements / 40.0;
  const double most = std::max<double>(kElementsMost, options.elements);
  return static_cast<std::size_t>(std::clamp(std::ceil(wanted), static_cast<double>(options.elements), most));
}

/// The nozzle lays element by element: an element is there from the moment at which the nozzle passes its
/// middle, so that the span is right on average. False when it falls.
bool lay(BeamString& strand, const StrandCreep& creep, const AirSpan& span, double element_length,
         std::size_t elements, const StrandOptions& options) {
  const double period = element_length / span.speed;
  const auto parts = static_cast<std::size_t>(
      2 * std::ceil(std::max(1.0, period * options.cooling_steps / creep.time_to_solid() / 2)));
  const double dt = period / static_cast<double>(parts);
  std::vector<double> by_age(elements * parts);
  for (std::size_t k = 0; k < by_age.size(); ++k)
    by_age[k] = creep.between(static_cast<double>(k) * dt, static_cast<double>(k + 1) * dt);
  std::vector<double> now;
  for (std::size_t count = 1; count <= elements; ++count) {
    strand.append(span.overfeed * element_length);
    now.resize(count);
    for (std::size_t part = 0; part < (count < elements ? parts : parts / 2); ++part) {
      for (std::size_t i = 0; i < count; ++i) now[i] = by_age[(count - 1 - i) * parts + part];
      if (!strand.step(now)) return false;
    }
  }
  return true;
}

/// From arrival until the last section is solid, in equal steps of its temperature. False when it falls.
bool harden(BeamString& strand, const StrandCreep& creep, const AirSpan& span, double element_length,
            const StrandOptions& options) {
  const std::size_t elements = strand.elements();
  std::vector<double> now(elements);
  const double period = element_length / span.speed;
  double time = 0;
  for (int k = 1; k <= options.cooling_steps; ++k) {
    const double next = creep.time_at_share(static_cast<double>(k) / options.cooling_steps);
    for (std::size_t i = 0; i < elements; ++i) {
      const double age = (static_cast<double>(elements - i) - 0.5) * period;
      now[i] = creep.between(age + time, age + next);
    }
    if (!strand.step(now)) return false;
    time = next;
  }
  return true;
}

double farthest(const BeamString& strand) {
  double far = 0;
  for (std::size_t i = 0; i <= strand.elements(); ++i)
    if (std::abs(strand.deflection(i)) > std::abs(far)) far = strand.deflection(i);
  return far;
}

void read_shape(const BeamString& strand, double element_length, StrandResult& result) {
  const std::size_t n = strand.elements();
  for (std::size_t i = 0; i <= n; ++i) {
    result.position.push_back(static_cast<double>(i) * element_length);
    result.sag.push_back(strand.deflection(i));
    result.slope_max = std::max(result.slope_max, std::abs(strand.slope(i)));
    if (std::abs(strand.deflection(i)) <= std::abs(result.sag_max)) continue;
    result.sag_max = strand.deflection(i);
    result.sag_max_position = result.position.back();
  }
  const std::size_t m = n / 2;
  result.sag_middle = n % 2 == 0 ? strand.deflection(m)
                                 : 0.5 * (strand.deflection(m) + strand.deflection(m + 1)) +
                                       element_length / 8 * (strand.slope(m) - strand.slope(m + 1));
  const double length = static_cast<double>(n) * element_length;
  result.length_gain = strand.extra_length() / length;
  result.sag_one_bow = length * std::sqrt(3 * result.length_gain / 8);
}

}  // namespace

StrandResult compute_sag(const machine::Material& material, const AirSpan& span,
                         const StrandOptions& options) {
  check(span, options);
  const double start = span.nozzle_temperature > 0 ? span.nozzle_temperature : material.nozzle_temperature;
  machine::check_nozzle_temperature(material, start);
  const StrandCreep creep(material, span.diameter, start, span.surroundings);

  StrandResult result;
  result.time_to_solid = creep.time_to_solid();
  result.solid_at = span.length / span.speed + result.time_to_solid;
  result.hot_length = span.speed * result.time_to_solid;
  result.start_solid_before_arrival = result.time_to_solid <= span.length / span.speed;
  result.biot = biot_number(material, span.diameter, start, span.surroundings);

  const std::size_t elements = element_count(span, result.hot_length, options);
  const double element_length = span.length / static_cast<double>(elements);
  BeamString strand(section_of(material, span, element_length), span.start, span.nozzle, elements);
  result.falls = !lay(strand, creep, span, element_length, elements, options);
  result.sag_at_arrival = farthest(strand);
  strand.hold_end(span.end);
  result.falls = result.falls || !harden(strand, creep, span, element_length, options);
  read_shape(strand, element_length, result);
  return result;
}

}  // namespace understudy::sim
