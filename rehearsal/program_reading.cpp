#include "rehearsal/program_reading.h"

#include "core/error.h"
#include "core/units.h"
#include "rehearsal/rotary_words.h"

namespace understudy::rehearsal {
toolpath::GcodeOptions gcode_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine) {
  toolpath::GcodeOptions gcode;
  gcode.X_WT_home = machine.X_WB * machine.X_BT_home;
  gcode.rotary = rotary_words(machine);
  const std::string& extruder = dialect.extruder_letter;
  if (extruder.size() > 1) throw InputError("extruder letter '" + extruder + "': one letter, such as E");
  gcode.extruder_letter = extruder.empty() ? machine.dialect.extruder_letter : extruder[0];
  for (int i = 0; i < 3; ++i) gcode.offset_W[i] = from_mm(dialect.place_mm[static_cast<std::size_t>(i)]);
  gcode.b_sign = dialect.b_sign;
  gcode.c_sign = dialect.c_sign;
  gcode.ignored = dialect.ignored;
  if (dialect.coordinates.empty()) return gcode;
  if (!gcode.rotary)
    throw InputError("coordinates '" + dialect.coordinates + "': " + machine.name + " has no rotary words");
  set_coordinates(dialect.coordinates, *gcode.rotary);
  return gcode;
}

toolpath::Program read_program(const RehearsalRequest& request, const machine::MachineDescription& machine) {
  const toolpath::GcodeOptions options = gcode_options(request.dialect, machine);
  toolpath::Program program = toolpath::read_gcode(request.program, options);
  if (!request.dialect.temperature_c) return program;
  toolpath::Step heat;
  heat.kind = toolpath::StepKind::temperature;
  heat.X_WT = options.X_WT_home;
  heat.temperature = *request.dialect.temperature_c + kCelsiusZero;
  heat.wait = true;
  program.steps.insert(program.steps.begin(), heat);
  return program;
}

}  // namespace understudy::rehearsal
