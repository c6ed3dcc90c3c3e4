#include "control/motion/rotary_turns.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"

namespace understudy::control {
namespace {

using kinematics::SolveStatus;

std::shared_ptr<const kinematics::Mechanism> turning_mechanism(const machine::MachineDescription& machine) {
  std::shared_ptr<const kinematics::Mechanism> mechanism = machine.make_mechanism();
  if (mechanism->rotary_words().empty())
    throw InputError(fmt::format(
        "{} has no rotary words: its programs state the tool's orientation by W I J K", machine.name));
  return mechanism;
}

}  // namespace

toolpath::Program with_turns(const toolpath::Program& program, const machine::MachineDescription& machine) {
  const auto mechanism = turning_mechanism(machine);
  const auto words = mechanism->rotary_words();
  const Pose X_BW = machine.X_WB.inverse();
  kinematics::AxisVector storage{};
  const std::span<double> axes = std::span(storage).first(static_cast<std::size_t>(mechanism->axis_count()));
  toolpath::Program turned = program;
  bool at_home = true;
  for (toolpath::Step& step : turned.steps) {
    if (step.kind == toolpath::StepKind::home) at_home = true;
    if (!toolpath::moves(step) || step.kind == toolpath::StepKind::home) continue;
    const kinematics::AxisVector before = storage;
    const std::span<const double> previous =
        at_home ? std::span<const double>() : std::span<const double>(before).first(axes.size());
    const SolveStatus status = mechanism->inverse(X_BW * step.X_WT, previous, axes);
    if (status != SolveStatus::ok && status != SolveStatus::singular) {
      const Vec3 p = step.X_WT.translation();
      throw InputError(fmt::format("({:.3f}, {:.3f}, {:.3f}) mm: the turns of {} are not to be found: {}",
                                   to_mm(p.x()), to_mm(p.y()), to_mm(p.z()), machine.name,
                                   to_string(status)));
    }
    at_home = false;
    step.rotary =
        toolpath::RotaryTurns{words[0].reading(axes), words.size() > 1 ? words[1].reading(axes) : 0};
  }
  return turned;
}

toolpath::GcodeStyle rotary_style(const machine::MachineDescription& machine) {
  toolpath::GcodeStyle style;
  const auto mechanism = turning_mechanism(machine);
  for (const kinematics::AxisWord& word : mechanism->rotary_words()) style.turn_letters += word.letter;
  style.turn_units = machine.dialect.turn_units;
  return style;
}

}  // namespace understudy::control
