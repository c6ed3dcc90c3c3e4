#include "control/preflight.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "control/motion/constraint_check.h"
#include "control/standing_pose.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::control {
namespace {

constexpr double kPatience = 2.0;  // [s], for a frame and for outputs

using kinematics::Mechanism;

std::string in_units(const Mechanism& mechanism, int axis, double value) {
  return mechanism.axis_is_angle(axis) ? fmt::format("{:.3f} deg", to_deg(value))
                                       : fmt::format("{:.3f} mm", to_mm(value));
}

PreflightCheck check_axes(const Mechanism& mechanism, const machine::MachinePort& port) {
  const int described = mechanism.axis_count(), found = port.axis_count();
  if (described == found) return {"axes", true, fmt::format("{}, as described", found)};
  return {
      "axes", false,
      fmt::format("the controller has {}, the machine file {}: another machine or port", found, described)};
}

PreflightCheck check_fault(const machine::AxisState& state) {
  if (state.fault == machine::Fault::none) return {"fault", true, "none"};
  return {"fault", false, fmt::format("{}: clear it at the machine first", to_string(state.fault))};
}

/// Where the axes are, each within its range, and by how much the farthest one is beside home.
PreflightCheck check_position(const machine::MachineDescription& machine, const Mechanism& mechanism,
                              const machine::MachinePort& port, bool at_home) {
  const machine::AxisState state = port.state();
  kinematics::AxisVector home{};
  const auto axes = std::span(home).first(static_cast<std::size_t>(mechanism.axis_count()));
  const auto solved = mechanism.inverse(machine.X_BT_home, {}, axes);
  if (solved != kinematics::SolveStatus::ok && solved != kinematics::SolveStatus::singular)
    return {"position", false, "home cannot be reached"};
  int farthest = 0;
  for (int i = 0; i < mechanism.axis_count(); ++i) {
    const auto axis = static_cast<std::size_t>(i), worst = static_cast<std::size_t>(farthest);
    const double reads = state.position[axis];
    const kinematics::AxisRange range = mechanism.axis_range(i);
    if (!(reads >= range.lower - kHomeTolerance && reads <= range.upper + kHomeTolerance))
      return {"position", false,
              fmt::format("axis {} reads {}, out of its range {} to {}: home the machine",
                          mechanism.axis_name(i), in_units(mechanism, i, reads),
                          in_units(mechanism, i, range.lower), in_units(mechanism, i, range.upper))};
    if (std::abs(reads - home[axis]) > std::abs(state.position[worst] - home[worst])) farthest = i;
  }
  const auto worst = static_cast<std::size_t>(farthest);
  const double off = state.position[worst] - home[worst];
  const std::string where = fmt::format("axis {} reads {}, {} from home", mechanism.axis_name(farthest),
                                        in_units(mechanism, farthest, state.position[worst]),
                                        in_units(mechanism, farthest, std::abs(off)));
  if (at_home && std::abs(off) > kHomeTolerance)
    return {"position", false, where + ": home the machine, or move it there"};
  try {
    static_cast<void>(standing_pose(machine, port));
  } catch (const MachineError& error) {
    return {"position", false, error.what()};
  }
  return {"position", true, where};
}

PreflightCheck check_limits(const toolpath::Program& program, const machine::MachineDescription& machine) {
  const ConstraintReport report = check_constraints(program, machine);
  const auto broken = std::ranges::find_if(
      report.findings, [](const ConstraintFinding& finding) { return finding.reduced_feed == 0; });
  if (broken == report.findings.end())
    return {"limits", true, fmt::format("held for {:.1f} s of motion", report.duration)};
  return {"limits", false, fmt::format("line {}: {}", broken->line, to_string(broken->violation))};
}

PreflightCheck check_camera(const machine::MachineDescription& machine, machine::MachinePort& port) {
  machine::Frame frame;
  const Region all = machine.microscope.camera.sensor();
  const machine::Status answer = port.capture(all, frame, port.now() + kPatience);
  if (answer != machine::Status::ok)
    return {"camera", false, fmt::format("{}: gap control needs its pictures", to_string(answer))};
  if (frame.image.width() != all.width || frame.image.height() != all.height)
    return {"camera", false,
            fmt::format("its pictures are {} x {} px, the machine file says {} x {}", frame.image.width(),
                        frame.image.height(), all.width, all.height)};
  return {"camera", true,
          fmt::format("{} x {} px, {:.0f} ms old when it came", all.width, all.height,
                      1e3 * (frame.received_at - frame.exposed_at))};
}

PreflightCheck check_outputs(machine::MachinePort& port) {
  const machine::Status answer = port.set_outputs({}, port.now() + kPatience);
  if (answer == machine::Status::ok) return {"outputs", true, "heater and fan are off and answer"};
  return {"outputs", false, fmt::format("heater and fan do not obey: {}", to_string(answer))};
}

}  // namespace

std::vector<PreflightCheck> preflight(const toolpath::Program& program,
                                      const machine::MachineDescription& machine, machine::MachinePort& port,
                                      GapControl gap_control, bool at_home) {
  const auto mechanism = machine.make_mechanism();
  std::vector<PreflightCheck> checks{check_axes(*mechanism, port), check_fault(port.state())};
  if (checks.front().good) checks.push_back(check_position(machine, *mechanism, port, at_home));
  checks.push_back(check_limits(program, machine));
  if (gap_control != GapControl::off) checks.push_back(check_camera(machine, port));
  checks.push_back(check_outputs(port));
  return checks;
}

}  // namespace understudy::control
