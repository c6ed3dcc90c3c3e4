#include "rehearsal/program_reading.h"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "rehearsal/readings.h"
#include "rehearsal/rotary_words.h"
#include "toolpath/gcode/turned_program.h"

namespace understudy::rehearsal {
namespace {

/// Called where `error` is caught. Of words that mean nothing to this machine: what says more.
[[noreturn]] void offer_inspection(const InputError& error, const RehearsalRequest& request) {
  const std::string what = error.what();
  if (what.find("unknown word") == std::string::npos && what.find("rotary axes") == std::string::npos) throw;
  throw InputError(fmt::format("{}; `understudy inspect {} --machine {}` shows what to do", what,
                               request.program, request.machine));
}

}  // namespace

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
  if (!dialect.macros.empty())
    gcode.macros = std::make_shared<toolpath::GcodeMacros>(toolpath::GcodeMacros::read(dialect.macros));
  if (dialect.coordinates.empty()) return gcode;
  if (!gcode.rotary)
    throw InputError("coordinates '" + dialect.coordinates + "': " + machine.name + " has no rotary words");
  set_coordinates(dialect.coordinates, *gcode.rotary);
  return gcode;
}

toolpath::Program read_program(const RehearsalRequest& request, const machine::MachineDescription& machine) {
  const toolpath::GcodeOptions options = gcode_options(request.dialect, machine);
  const toolpath::ProgramTurn turn{from_deg(request.dialect.turn_deg), from_deg(request.dialect.spin_deg)};
  toolpath::Program program = [&] {
    try {
      return toolpath::read_turned_gcode(request.program, options, turn);
    } catch (const InputError& error) {
      offer_inspection(error, request);
    }
  }();
  if (!request.dialect.temperature_c) return program;
  toolpath::Step heat;
  heat.kind = toolpath::StepKind::temperature;
  heat.X_WT = options.X_WT_home;
  heat.temperature = *request.dialect.temperature_c + kCelsiusZero;
  heat.wait = true;
  program.steps.insert(program.steps.begin(), heat);
  return program;
}

std::optional<Finding> misread_words(const RehearsalRequest& request, const toolpath::Program& program,
                                     const machine::MachineDescription& machine) {
  const auto turned = [&](const toolpath::Step& s) {
    return s.kind == toolpath::StepKind::print && s.rotary &&
           (s.rotary->b != program.steps.front().rotary->b || s.rotary->c != program.steps.front().rotary->c);
  };
  if (std::ranges::none_of(program.steps, turned)) return std::nullopt;
  return misread_words(program, {request.program, read_file(request.program)},
                       gcode_options(request.dialect, machine), request.machine);
}

}  // namespace understudy::rehearsal
