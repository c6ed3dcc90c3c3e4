#include "control/gap/gap_sensor.h"

#include <cmath>

#include <fmt/format.h>

#include "control/gap/confidence.h"
#include "core/units.h"
#include "machine/optics_mounting.h"

namespace understudy::control {

using machine::Status;
using vision::DotStatus;

namespace {

constexpr double kPatience = 2.0;  // [s], for one frame
constexpr int kAsked = 3;          // times, for a frame that is lost or stale, while the tool stands
constexpr int kMarginRadii = 5;    // of the spot, kept free around the predicted dot

}  // namespace

vision::DotOptions dot_options(const machine::MachineDescription& machine) {
  const machine::Microscope& m = machine.microscope;
  return vision::dot_options({machine::picture_scale(machine), machine.laser.waist_diameter,
                              machine.laser.wavelength, m.aperture_sine, m.blur_px, m.full_well});
}

GapSensor::GapSensor(const machine::MachineDescription& machine, const LocalSurface& surface,
                     const GapControllerOptions& options, machine::MachinePort& port)
    : machine_(machine),
      surface_(surface),
      options_(options),
      port_(port),
      dot_options_(dot_options(machine)) {}

GapStop GapSensor::take(const std::optional<Expectation>& expected, GapSample& sample) {
  const Camera& camera = machine_.microscope.camera;
  const Region sensor = camera.sensor();
  const Region region = expected ? region_around(*expected) : sensor;
  GapStop stop = expose_standing(region, sample);
  if (stop != GapStop::none) return stop;
  const bool missed =
      sample.dot.status == DotStatus::no_dot || sample.dot.status == DotStatus::clipped_by_border;
  // A dot outside the region shows on the whole sensor, and its reading then says what went wrong.
  if (missed && region != sensor)
    if (stop = expose_standing(sensor, sample); stop != GapStop::none) return stop;
  if (stop = judge_dot(sample); stop != GapStop::none) return stop;
  if (stop = judge_reading(expected, sample); stop != GapStop::none) return stop;
  sample.used = true;
  return GapStop::none;
}

GapStop GapSensor::expose_standing(const Region& region, GapSample& sample) {
  GapStop stop = GapStop::none;
  for (int asked = 1; asked <= kAsked; ++asked) {
    stop = expose(region, kPatience, sample);
    const bool again = stop == GapStop::stale_frame || stop == GapStop::port_failed;
    if (!again || port_.state().fault != machine::Fault::none) return stop;
  }
  sample.why += fmt::format("; it was asked for {} times", kAsked);
  return stop;
}

Region GapSensor::region_around(const Expectation& expected) const {
  const int margin = static_cast<int>(std::ceil(kMarginRadii * dot_options_.expected_radius_px));
  return region_for_gap(machine_, surface_, expected.gap, expected.bound, expected.bound, margin);
}

GapStop GapSensor::expose_around(const Expectation& expected, double patience, GapSample& sample) {
  return expose(region_around(expected), patience, sample);
}

GapStop GapSensor::read(GapSample& sample) const {
  if (const GapStop stop = judge_dot(sample); stop != GapStop::none) return stop;
  return judge_reading(std::nullopt, sample);
}

GapStop GapSensor::expose(const Region& region, double patience, GapSample& sample) {
  sample.frame = {};
  const double asked_at = port_.now();
  const Status status = port_.capture(region, sample.frame, asked_at + patience);
  if (status != Status::ok) {
    sample.why = fmt::format("no picture from the microscope: {}", to_string(status));
    if (status == Status::faulted) sample.why += fmt::format(" ({})", to_string(port_.state().fault));
    return GapStop::port_failed;
  }
  const machine::Frame& frame = sample.frame;
  sample.time = frame.exposed_at;
  const double age = frame.received_at - frame.exposed_at;
  if (last_number_ == frame.number) {
    sample.why = fmt::format("frame {} was delivered twice", frame.number);
    return GapStop::stale_frame;
  }
  last_number_ = frame.number;
  if (frame.exposed_at < asked_at || !(age <= options_.frame_age_max)) {
    sample.why = fmt::format(
        "frame {} was exposed {:.3f} s before it came, {:.3f} s before it was asked for; allowed "
        "are {:.3f} s and 0 s",
        frame.number, age, asked_at - frame.exposed_at, options_.frame_age_max);
    return GapStop::stale_frame;
  }
  const Image& image = frame.image;
  const auto pixels = static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height);
  if (!(image.region == region) || image.pixels.size() != pixels) {
    sample.why = fmt::format("the camera read {} x {} px at ({}, {}) instead of {} x {} px at ({}, {})",
                             image.region.width, image.region.height, image.region.x, image.region.y,
                             region.width, region.height, region.x, region.y);
    return GapStop::implausible;
  }
  sample.dot = vision::measure_dot(image, dot_options_);
  return GapStop::none;
}

GapStop GapSensor::judge_dot(GapSample& sample) const {
  const vision::DotMeasurement& dot = sample.dot;
  switch (dot.status) {
    case DotStatus::ok:
      return GapStop::none;
    case DotStatus::no_dot:
      sample.why =
          fmt::format("no dot: the brightest spot stands out by {:.0f} grey levels, {:.0f} are needed",
                      dot.contrast, dot_options_.contrast_min);
      return GapStop::no_dot;
    case DotStatus::saturated:
      sample.why =
          fmt::format("the dot is saturated: {:.0f} % of its pixels are white, at most {:.0f} % may be",
                      100 * dot.saturated_fraction, 100 * dot_options_.saturated_fraction_max);
      return GapStop::saturated;
    case DotStatus::clipped_by_border:
      sample.why = fmt::format("the dot at ({:.1f}, {:.1f}) px is cut by the picture's border",
                               dot.position_px.x(), dot.position_px.y());
      return GapStop::implausible;
    case DotStatus::not_a_spot:
      break;
  }
  sample.why = fmt::format(
      "what shines at ({:.1f}, {:.1f}) px with a radius of {:.1f} px is not the dot, whose radius is "
      "about {:.1f} px",
      dot.position_px.x(), dot.position_px.y(), dot.radius_px, dot_options_.expected_radius_px);
  return GapStop::implausible;
}

GapStop GapSensor::judge_reading(const std::optional<Expectation>& expected, GapSample& sample) const {
  const Vec2& at = sample.dot.position_px;
  GapReading& reading = sample.reading;
  if (!read_gap(machine_, surface_, sample.dot, reading)) {
    sample.why = fmt::format("no gap explains a dot at ({:.1f}, {:.1f}) px", at.x(), at.y());
    return GapStop::implausible;
  }
  if (reading.residual_px > options_.residual_max_px) {
    sample.why = fmt::format(
        "the dot at ({:.1f}, {:.1f}) px is {:.1f} px off the line on which it moves, at most {:.1f} px "
        "are plausible",
        at.x(), at.y(), reading.residual_px, options_.residual_max_px);
    return GapStop::implausible;
  }
  if (!whole(reading, sample.dot)) {
    sample.why = fmt::format(
        "the dot at ({:.1f}, {:.1f}) px is {:.0f} % as wide as the beam draws it here, 1 sigma {:.0f} %: "
        "something hides a part of it",
        at.x(), at.y(), 100 * std::sqrt(std::max(0.0, reading.narrowest)), 50 * sample.dot.spread_sigma);
    return GapStop::partly_hidden;
  }
  if (!expected) return GapStop::none;
  const double bound = expected->bound + kPlausibleSigmas * reading.sigma;
  if (!(std::abs(reading.gap - expected->gap) <= bound)) {
    sample.why = fmt::format("the gap reads {:.3f} mm where the motion leaves {:.3f} mm, within {:.3f} mm",
                             to_mm(reading.gap), to_mm(expected->gap), to_mm(bound));
    return GapStop::implausible;
  }
  return GapStop::none;
}

}  // namespace understudy::control
