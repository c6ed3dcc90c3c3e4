#include "control/program/gcode_options.h"

#include <algorithm>
#include <memory>

#include "control/motion/motion_limits.h"
#include "control/program/rotary_words.h"
#include "core/error.h"
#include "core/units.h"

namespace understudy::control {

toolpath::GcodeOptions gcode_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine) {
  toolpath::GcodeOptions gcode;
  gcode.X_WT_home = machine.X_WB * machine.X_BT_home;
  gcode.rotary = rotary_words(machine);
  gcode.corner_velocity_change = kChordShare * corner_velocity_change(motion_limits(machine));
  const std::string& extruder = dialect.extruder_letter;
  if (extruder.size() > 1) throw InputError("extruder letter '" + extruder + "': one letter, such as E");
  gcode.extruder_letter = extruder.empty() ? machine.dialect.extruder_letter : extruder[0];
  for (int i = 0; i < 3; ++i) gcode.offset_W[i] = from_mm(dialect.place_mm[static_cast<std::size_t>(i)]);
  gcode.b_sign = dialect.b_sign;
  gcode.c_sign = dialect.c_sign;
  gcode.ignored = dialect.ignored;
  gcode.relative_extrusion = dialect.relative_extrusion;
  if (dialect.temperature_c) gcode.ignored_heat = *dialect.temperature_c + kCelsiusZero;
  if (!dialect.macros.empty())
    gcode.macros = std::make_shared<toolpath::GcodeMacros>(toolpath::GcodeMacros::read(dialect.macros));
  if (dialect.coordinates.empty()) return gcode;
  if (!gcode.rotary)
    throw InputError("coordinates '" + dialect.coordinates + "': " + machine.name + " has no rotary words");
  set_coordinates(dialect.coordinates, *gcode.rotary);
  return gcode;
}

void heat_first(const DialectRequest& dialect, const machine::MachineDescription& machine,
                toolpath::Program& program) {
  if (!dialect.temperature_c) return;
  const double temperature = *dialect.temperature_c + kCelsiusZero;
  const auto bead = std::ranges::find(program.steps, toolpath::StepKind::print, &toolpath::Step::kind);
  const auto heats = [&](const toolpath::Step& s) {
    return s.kind == toolpath::StepKind::temperature && s.temperature == temperature;
  };
  if (std::any_of(program.steps.begin(), bead, heats)) return;  // in place of a macro
  toolpath::Step heat;
  heat.kind = toolpath::StepKind::temperature;
  heat.X_WT = machine.X_WB * machine.X_BT_home;
  heat.temperature = temperature;
  heat.wait = true;
  program.steps.insert(program.steps.begin(), heat);
}

}  // namespace understudy::control
