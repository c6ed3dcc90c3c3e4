#include "drivers/loopback.h"

#include "core/error.h"

namespace understudy::drivers {
namespace {

constexpr double kClockStep = 0.5;  // [ms], that of the twin's engines with dynamics

}  // namespace

std::unique_ptr<machine::LoopbackPort> open_loopback(const PortUri& uri,
                                                     const machine::MachineDescription& machine) {
  uri.check_options({"clock_ms"});
  if (!uri.place.empty()) throw InputError(uri.text + ": loopback:// has no place");
  const auto mechanism = machine.make_mechanism();
  machine::LoopbackPort::Options options;
  options.axis_count = mechanism->axis_count();
  options.history = false;
  options.drive_zero = machine.drive_zero();
  options.clock_step = 1e-3 * uri.number("clock_ms", kClockStep, 0.01, 10);
  for (int i = 0; i < options.axis_count; ++i) options.ranges.push_back(mechanism->axis_range(i));
  const auto axes = std::span(options.start).first(static_cast<std::size_t>(options.axis_count));
  const auto solved = mechanism->inverse(machine.X_BT_home, {}, axes);
  if (solved != kinematics::SolveStatus::ok && solved != kinematics::SolveStatus::singular)
    throw InputError(machine.file.string() + ": the home pose cannot be reached: " + to_string(solved));
  return std::make_unique<machine::LoopbackPort>(options);
}

}  // namespace understudy::drivers
