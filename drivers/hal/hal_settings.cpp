#include "drivers/hal/hal_settings.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include <fmt/format.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/text/printable.h"
#include "core/units.h"
#include "machine/load_encoders.h"

namespace understudy::drivers {
namespace {

constexpr double kEndless = 1e20;         // HAL's own word for no limit
constexpr std::size_t kColumnsMost = 21;  // of a HAL stream

// Where a machine file is silent: a stepper of 200 full steps in 16 microsteps, a lead of 1 mm or 1 degree.
constexpr double kAssumedScale = 3200;

// The filament's drive, of which machine files tell nothing: a geared feeder of common printers.
constexpr double kFilamentScale = 415;          // [steps/mm]
constexpr double kFilamentVelocity = 60;        // [mm/s]
constexpr double kFilamentAcceleration = 3000;  // [mm/s^2]

// Room above the planner's limits: interpolation between setpoints and gap control may touch them, and what
// HAL clips would leave the path.
constexpr double kRoom = 1.1;
constexpr double kFollowingSteps = 10;  // beside what it is behind in time
// An axis that must stop within no distance overshoots by v^2 / 2a and comes back: (1 + sqrt 2) v / a.
constexpr double kStopAndReturn = 2.5;
constexpr double kLeastBrakeTime = 0.1;  // [s]
constexpr std::size_t kNameMost =
    21;  // "zero.NAME.update-feedback.time" is the longest; HAL's have 47 characters

HalAxis machine_axis(const machine::MachineDescription& machine, int index, double home) {
  const auto mechanism = machine.make_mechanism();
  const machine::Drive& drive = machine.drives[static_cast<std::size_t>(index)];
  HalAxis axis;
  axis.name = mechanism->axis_name(index);
  axis.angle = mechanism->axis_is_angle(index);
  axis.assumed = !(drive.lead > 0) || drive.steps_per_turn <= 0 || drive.microsteps <= 0;
  axis.scale = axis.assumed ? kAssumedScale : 1 / axis.units(drive.step());
  axis.home = axis.units(home);
  const auto range = mechanism->axis_range(index);
  axis.lower = std::isfinite(range.lower) ? axis.units(range.lower) : -kEndless;
  axis.upper = std::isfinite(range.upper) ? axis.units(range.upper) : kEndless;
  axis.velocity = kRoom * axis.units(drive.velocity_max);
  axis.acceleration = kRoom * axis.units(drive.acceleration_max);
  const double at_a_corner = 2 * axis.units(drive.velocity_jump) / machine.cycle_time;
  axis.jump = 2 * axis.acceleration + kRoom * at_a_corner;
  return axis;
}

HalAxis filament_axis(double cycle) {
  HalAxis axis;
  axis.name = "filament";
  axis.assumed = true;
  axis.scale = kFilamentScale;
  axis.lower = -kEndless;
  axis.upper = kEndless;
  axis.velocity = kFilamentVelocity;
  axis.acceleration = kFilamentAcceleration;
  axis.jump = kFilamentVelocity / cycle;  // a feeder takes its speed at once: beads begin so
  return axis;
}

/// As HAL takes them: a blank would end the word.
void name_for_hal(const machine::MachineDescription& machine, std::vector<HalAxis>& axes) {
  std::set<std::string> taken;
  for (HalAxis& axis : axes) {
    if (axis.name.size() > kNameMost)
      throw InputError({machine.file.string()},
                       fmt::format("axis '{}' has a name of {} characters; HAL takes {}: shorten it",
                                   axis.name, axis.name.size(), kNameMost));
    std::replace(axis.name.begin(), axis.name.end(), ' ', '-');
    if (!taken.insert(axis.name).second)
      throw InputError(
          {machine.file.string()},
          fmt::format("two axes, or an axis and the filament, would be '{}' in HAL: rename one", axis.name));
  }
}

void check(const HalOptions& options, double cycle) {
  const double cycle_us = cycle * 1e6;
  if (options.base_period_us < 5 || options.base_period_us > cycle_us)
    throw InputError(
        fmt::format("base period: {} us is outside 5..{:.0f} us", options.base_period_us, cycle_us));
  if (!(options.watchdog >= 2 * cycle && options.watchdog <= 10))
    throw InputError(fmt::format("watchdog: {:.0f} ms is outside {:.0f}..10000 ms", options.watchdog * 1e3,
                                 2 * cycle * 1e3));
  if (!(options.following >= 2 * cycle && options.following <= 10))
    throw InputError(fmt::format("following: {:.0f} ms is outside {:.0f}..10000 ms", options.following * 1e3,
                                 2 * cycle * 1e3));
}

/// Where every axis has one, as the twin's port reads them.
void add_load_encoders(const machine::MachineDescription& machine, HalSettings& settings) {
  if (machine.file.empty()) return;
  const machine::LoadEncoderCounts counts = machine::load_encoder_counts(machine.file.string());
  const std::span axes(settings.axes.data(), settings.machine_axes);
  if (std::ranges::any_of(axes, [&](const HalAxis& a) { return !(counts.of(a.angle) > 0); })) return;
  for (HalAxis& axis : axes) axis.count = axis.units(counts.of(axis.angle));
  settings.load_encoders = true;
  const std::size_t columns = settings.axes.size() + kStateColumns + settings.machine_axes;
  if (columns > kColumnsMost)
    throw InputError(
        {machine.file.string()},
        fmt::format("load_encoders: with one at each of {} axes a sample of HAL has {} columns, at "
                    "most {} can be: leave the section out of the file for HAL",
                    settings.machine_axes, columns, kColumnsMost));
}

std::string fingerprint(const HalSettings& settings) {
  std::string text = fmt::format("{:.9g}\n", settings.cycle);
  for (const HalAxis& a : settings.axes)
    text += fmt::format("{} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", a.name, a.angle, a.scale, a.home,
                        a.lower, a.upper, a.velocity, a.acceleration);
  if (settings.load_encoders)  // further columns of the sample
    for (const HalAxis& a : settings.axes) text += fmt::format("load {:.9g}\n", a.count);
  return sha256_hex(text).substr(0, 16);
}

}  // namespace

double HalAxis::units(double si) const { return angle ? to_deg(si) : to_mm(si); }
double HalAxis::si(double units) const { return angle ? from_deg(units) : from_mm(units); }

HalSettings hal_settings(const machine::MachineDescription& machine, const HalOptions& options) {
  check(options, machine.cycle_time);
  const auto mechanism = machine.make_mechanism();
  kinematics::AxisVector home{};
  const std::span<double> home_axes(home.data(), static_cast<std::size_t>(mechanism->axis_count()));
  if (mechanism->inverse(machine.X_BT_home, home_axes, home_axes) != kinematics::SolveStatus::ok)
    throw InputError(fmt::format("{}: the machine does not reach its own home", machine.file.string()));
  HalSettings settings;
  settings.machine = printable(machine.name);  // on one line: what follows it is run
  settings.cycle = machine.cycle_time;
  settings.options = options;
  settings.brake_time = kLeastBrakeTime;
  for (int i = 0; i < mechanism->axis_count(); ++i) {
    settings.axes.push_back(machine_axis(machine, i, home_axes[static_cast<std::size_t>(i)]));
    const HalAxis& axis = settings.axes.back();
    settings.brake_time = std::max(settings.brake_time, kStopAndReturn * axis.velocity / axis.acceleration);
  }
  settings.machine_axes = settings.axes.size();
  if (machine.tool.prints()) settings.axes.push_back(filament_axis(machine.cycle_time));
  name_for_hal(machine, settings.axes);
  for (HalAxis& axis : settings.axes)
    axis.following = options.following * axis.velocity + kFollowingSteps / axis.scale;
  add_load_encoders(machine, settings);
  settings.fingerprint = fingerprint(settings);
  return settings;
}

std::vector<std::string> too_fast_for_software(const HalSettings& settings) {
  std::vector<std::string> lines;
  const double most = 1e6 / settings.options.base_period_us;
  for (const HalAxis& axis : settings.axes) {
    const double needed = axis.velocity / kRoom * axis.scale;
    if (needed <= most || axis.assumed) continue;
    const char* unit = axis.angle ? "deg" : "mm";
    lines.push_back(
        fmt::format("{}: {:.4g} {}/s need {:.0f} steps/s, and software makes {:.0f} at a base period of {} "
                    "us ({:.3g} {}/s): "
                    "slower programs, fewer microsteps, or a step generator in hardware",
                    axis.name, axis.velocity / kRoom, unit, needed, most, settings.options.base_period_us,
                    most / axis.scale, unit));
  }
  return lines;
}

}  // namespace understudy::drivers
