#include "sim/faults/faults.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::sim {
namespace {

bool ends_by(const FaultEvent& event, double time) { return time >= event.time + event.duration; }

}  // namespace

const char* to_string(FaultKind kind) {
  switch (kind) {
    case FaultKind::lost_steps:
      return "lost_steps";
    case FaultKind::stall:
      return "stall";
    case FaultKind::disconnected:
      return "disconnected";
    case FaultKind::loose_joint:
      return "loose_joint";
    case FaultKind::thermal_growth:
      return "thermal_growth";
    case FaultKind::power_cut:
      return "power_cut";
  }
  return "unknown";
}

std::string describe(const FaultEvent& event, const machine::MachineDescription& machine) {
  const auto mechanism = machine.make_mechanism();
  const std::string at = fmt::format(" at {:.3f} s", event.time);
  if (event.kind == FaultKind::power_cut) return "power cut" + at;
  const std::string axis = " of axis " + mechanism->axis_name(event.axis) + at;
  const bool angle = mechanism->axis_is_angle(event.axis);
  const std::string amount = angle ? fmt::format("{:.2f} arcmin", 60 * to_deg(event.amount))
                                   : fmt::format("{:.1f} um", to_um(event.amount));
  switch (event.kind) {
    case FaultKind::lost_steps:
      return fmt::format("{} lost steps{}", event.steps, axis);
    case FaultKind::stall:
      return fmt::format("stall{} for {:.3f} s", axis, event.duration);
    case FaultKind::disconnected:
      return "disconnected motor" + axis;
    case FaultKind::loose_joint:
      return fmt::format("loose joint{}, {} more play", axis, amount);
    default:
      return fmt::format("growth{} by {} over {:.1f} s", axis, amount, event.duration);
  }
}

void check_faults(const std::vector<FaultEvent>& events, const machine::MachineDescription& machine) {
  const int axes = machine.make_mechanism()->axis_count();
  for (const FaultEvent& event : events) {
    const std::string what = std::string("fault ") + to_string(event.kind);
    if (!(event.time >= 0)) throw InputError(fmt::format("{} at {} s, before 0", what, event.time));
    if (event.kind == FaultKind::power_cut) continue;
    if (event.axis < 0 || event.axis >= axes)
      throw InputError(fmt::format("{} of axis {}: the machine has {}", what, event.axis + 1, axes));
    if (event.kind == FaultKind::lost_steps && (event.steps <= 0 || event.steps % kElectricalCycle != 0))
      throw InputError(
          fmt::format("{}: {} steps, not a positive multiple of {}: a rotor slips by whole cycles", what,
                      event.steps, kElectricalCycle));
    if (event.kind == FaultKind::loose_joint && !machine.has_play(event.axis))
      throw InputError(
          fmt::format("{} of axis {}: the machine has no play there to grow", what, event.axis + 1));
    if (event.kind == FaultKind::loose_joint && !(event.amount > 0))
      throw InputError(fmt::format("{}: play of {} is not above 0", what, event.amount));
    if (!std::isfinite(event.amount))
      throw InputError(fmt::format("{}: amount of {} is not finite", what, event.amount));
    if (!(event.duration >= 0)) throw InputError(fmt::format("{} for {} s, below 0", what, event.duration));
  }
}

FaultyDrives::FaultyDrives(const machine::MachineDescription& machine, std::vector<FaultEvent> events)
    : events_(std::move(events)), axes_(machine.drives.size()) {
  std::stable_sort(events_.begin(), events_.end(),
                   [](const FaultEvent& a, const FaultEvent& b) { return a.time < b.time; });
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const machine::Drive& drive = machine.drives[i];
    if (drive.steps_per_turn > 0) axes_[i].cycle = kElectricalCycle * drive.lead / drive.steps_per_turn;
  }
  stalls_.reserve(events_.size());
  growths_.reserve(events_.size());
}

void FaultyDrives::release(int axis, Plant& plant) {
  Axis& a = axes_[static_cast<std::size_t>(axis)];
  a.condition.released = a.counts_only = true;
  plant.set_condition(axis, a.condition);
}

void FaultyDrives::begin(const FaultEvent& event, const DriveCommand& command, Plant& plant) {
  const auto i = static_cast<std::size_t>(event.axis);
  Axis& axis = axes_[i];
  switch (event.kind) {
    case FaultKind::lost_steps:
    case FaultKind::stall:
      if (!axis.frozen()) axis.frozen_at = command.position[i] - axis.slip;
      axis.counts_only = true;
      if (event.kind == FaultKind::lost_steps) {
        axis.slip_wanted += axis.cycle * event.steps / static_cast<double>(kElectricalCycle);
      } else {
        ++axis.stalls;
        stalls_.push_back(event);
      }
      break;
    case FaultKind::disconnected:
      release(event.axis, plant);
      break;
    case FaultKind::loose_joint:
      axis.condition.play_added += event.amount;
      plant.set_condition(event.axis, axis.condition);
      break;
    case FaultKind::thermal_growth:
      growths_.push_back({event, 0});
      break;
    case FaultKind::power_cut:
      power_cut_ = true;
      break;
  }
}

void FaultyDrives::slip(Axis& axis, double& position, double& velocity) const {
  if (!axis.frozen()) {
    position -= axis.slip;
    return;
  }
  const double behind = position - axis.slip - axis.frozen_at;
  if (axis.stalls == 0 && std::abs(behind) >= axis.slip_wanted) {
    axis.slip += std::copysign(axis.slip_wanted, behind);
    axis.slip_wanted = 0;
    position -= axis.slip;
    return;
  }
  position = axis.frozen_at;
  velocity = 0;
}

void FaultyDrives::apply(double time, DriveCommand& command, Plant& plant) {
  while (next_ < events_.size() && events_[next_].time <= time) begin(events_[next_++], command, plant);
  std::erase_if(stalls_, [&](const FaultEvent& event) {
    const auto i = static_cast<std::size_t>(event.axis);
    if (!ends_by(event, time)) return false;
    // The field has gone on turning: the rotor catches the cycle that is nearest to where it stands.
    Axis& axis = axes_[i];
    if (--axis.stalls == 0)
      axis.slip += std::round((command.position[i] - axis.slip - axis.frozen_at) / axis.cycle) * axis.cycle;
    return true;
  });
  std::erase_if(growths_, [&](Growth& growth) {
    const FaultEvent& event = growth.event;
    Axis& axis = axes_[static_cast<std::size_t>(event.axis)];
    const bool grown = ends_by(event, time);
    const double due = grown ? event.amount : event.amount * (time - event.time) / event.duration;
    axis.condition.growth += due - growth.done;
    growth.done = due;
    plant.set_condition(event.axis, axis.condition);
    return grown;
  });
  for (std::size_t i = 0; i < axes_.size(); ++i) slip(axes_[i], command.position[i], command.velocity[i]);
  if (!power_cut_) return;
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (axes_[i].cycle > 0 && !axes_[i].condition.released) release(static_cast<int>(i), plant);
}

}  // namespace understudy::sim
