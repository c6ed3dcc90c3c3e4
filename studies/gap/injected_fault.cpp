#include "studies/gap/injected_fault.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/assert.h"

namespace understudy::studies {
namespace {

using control::GapStop;
using sim::CameraFaultEvent;
using sim::CameraFaultKind;
using sim::FaultEvent;
using sim::FaultKind;

constexpr double kAxisJumpMax = 0.3e-3;  // [m], of an axis that hardly moves the tip along its axis

CameraFaultEvent draw_camera_fault(CameraFaultKind kind, double time, Random& random) {
  CameraFaultEvent event;
  event.kind = kind;
  event.time = time;
  event.share = random.uniform() < 0.5 ? 1 : random.uniform(0.1, 1);
  switch (kind) {
    case CameraFaultKind::dim:
      event.power = random.uniform(0.01, 0.1);
      break;
    case CameraFaultKind::saturated:
      event.power = random.uniform(3, 8);
      break;
    case CameraFaultKind::ghost:
      event.gap_offset = random.uniform(-60e-6, 60e-6);
      break;
    case CameraFaultKind::cut_beam:
      event.offset_px = random.uniform(-4, 4);
      event.direction = random.uniform(0, 2 * std::numbers::pi);
      break;
    case CameraFaultKind::strip:
      event.offset_px = random.uniform(-20, 4);
      event.direction = random.uniform(0, 2 * std::numbers::pi);
      break;
    case CameraFaultKind::displaced: {
      const double side = random.uniform(-1, 1);  // drawn first, whatever the compiler
      event.offset_px = std::copysign(std::round(random.uniform(2, 20)), side);
      break;
    }
    default:
      break;
  }
  return event;
}

/// [m] of the tip along its own axis for 1 m, or 1 rad, of an axis of the machine.
double axis_effect(const machine::MachineDescription& machine, const Pose& X_WT, int axis) {
  constexpr double kStep = 1e-6;
  const auto mechanism = machine.make_mechanism();
  const auto axes = static_cast<std::size_t>(mechanism->axis_count());
  const Pose X_BT = machine.X_WB.inverse() * X_WT;
  std::vector<double> q(axes);
  const auto solved = mechanism->inverse(X_BT, {}, q);
  UNDERSTUDY_ASSERT(solved == kinematics::SolveStatus::ok, "the sound run has been there");
  q[static_cast<std::size_t>(axis)] += kStep;
  Pose X_BT_moved;
  const auto reached = mechanism->forward(q, X_BT, X_BT_moved);
  UNDERSTUDY_ASSERT(reached == kinematics::SolveStatus::ok, "a micrometre away, too");
  return (X_BT_moved.translation() - X_BT.translation()).dot(tool_axis(X_BT)) / kStep;
}

FaultEvent draw_machine_fault(FaultKind kind, const FaultWindow& window, double time,
                              const machine::MachineDescription& machine, Random& random) {
  FaultEvent event;
  event.kind = kind;
  event.time = time;
  if (kind == FaultKind::power_cut) return event;
  const int axes = machine.make_mechanism()->axis_count();
  event.axis = std::min(axes - 1, static_cast<int>(random.uniform(0, axes)));
  const double jump = random.uniform(-kMachineJump, kMachineJump);
  const double effect = axis_effect(machine, window.X_WT_S, event.axis);
  const double travel = std::clamp(jump / effect, -kAxisJumpMax, kAxisJumpMax);
  const double slow = random.uniform() < 0.5 ? 0 : random.uniform(0.3, 2);
  switch (kind) {
    case FaultKind::loose_joint:
      event.amount = std::abs(travel);  // from one end of the play to the other
      break;
    case FaultKind::thermal_growth:
      event.amount = travel;
      event.duration = slow;
      break;
    case FaultKind::lost_steps: {
      const machine::Drive& drive = machine.drives[static_cast<std::size_t>(event.axis)];
      const double cycle = sim::kElectricalCycle * drive.lead / drive.steps_per_turn;
      event.steps = sim::kElectricalCycle * std::max(1, static_cast<int>(std::abs(travel) / cycle));
      break;
    }
    default:
      event.duration = random.uniform(5e-3, 20e-3);
      break;
  }
  return event;
}

}  // namespace

const std::vector<FaultType>& fault_types() {
  constexpr auto kNothing = std::nullopt;
  const std::vector<GapStop> moved{GapStop::implausible, GapStop::no_progress, GapStop::too_close,
                                   GapStop::too_far};
  const char* const mechanics = "the tip is truly elsewhere; the readings show it, and no picture is wrong";
  static const std::vector<FaultType> types{
      {"none", kNothing, kNothing, {}, "every stop is a false one"},
      {"dark", CameraFaultKind::dark, kNothing, {GapStop::no_dot}, "there is no dot"},
      {"dim", CameraFaultKind::dim, kNothing, {GapStop::no_dot}, "the dot is too faint to be measured"},
      {"saturated", CameraFaultKind::saturated, kNothing, {GapStop::saturated}, "its middle is white"},
      {"frozen",
       CameraFaultKind::frozen,
       kNothing,
       {GapStop::implausible, GapStop::no_progress, GapStop::stale_frame},
       "numbers and times are good: the reading does not follow the tool, or repeats to the last digit"},
      {"stale", CameraFaultKind::stale, kNothing, {GapStop::stale_frame}, "the number repeats"},
      {"lost", CameraFaultKind::lost, kNothing, {GapStop::port_failed}, "the camera delivers nothing"},
      {"ghost",
       CameraFaultKind::ghost,
       kNothing,
       {GapStop::implausible, GapStop::no_progress, GapStop::too_close},
       "a whole dot that does not follow the tool; or it reads less than may be left"},
      {"cut beam",
       CameraFaultKind::cut_beam,
       kNothing,
       {GapStop::partly_hidden, GapStop::no_dot},
       "a part of the dot is missing, or nearly all of it"},
      {"strip",
       CameraFaultKind::strip,
       kNothing,
       {GapStop::partly_hidden, GapStop::no_dot, GapStop::implausible},
       "likewise; what it leaves at both of its sides is no spot"},
      {"displaced",
       CameraFaultKind::displaced,
       kNothing,
       {GapStop::implausible},
       "another region than was asked for"},
      {"loose joint", kNothing, FaultKind::loose_joint, moved, mechanics},
      {"lost steps", kNothing, FaultKind::lost_steps, moved, mechanics},
      {"stall", kNothing, FaultKind::stall, moved, mechanics},
      {"growth", kNothing, FaultKind::thermal_growth, moved, mechanics},
      {"power cut", kNothing, FaultKind::power_cut, {GapStop::port_failed}, "the machine reports it"}};
  return types;
}

InjectedFault draw_fault(const FaultType& type, const FaultWindow& window,
                         const machine::MachineDescription& machine, Random& random) {
  InjectedFault fault;
  fault.time = random.uniform(window.begin, window.end);
  if (type.camera) {
    fault.camera.push_back(draw_camera_fault(*type.camera, fault.time, random));
    fault.words = describe(fault.camera.front());
  }
  if (type.machine) {
    fault.machine.push_back(draw_machine_fault(*type.machine, window, fault.time, machine, random));
    fault.words = describe(fault.machine.front(), machine);
  }
  return fault;
}

}  // namespace understudy::studies
