#include "rehearsal/program_reading.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/file/read_file.h"
#include "core/units.h"
#include "rehearsal/readings.h"
#include "rehearsal/rotary_words.h"
#include "toolpath/bead.h"

namespace understudy::rehearsal {
namespace {

/// Called where `error` is caught. Of words that mean nothing to this machine: what says more.
[[noreturn]] void offer_inspection(const InputError& error, const RehearsalRequest& request) {
  const std::string what = error.what();
  const char* kAnswered[] = {"unknown word", "rotary axes", "--signal", "--bead", "--tool-points"};
  if (std::none_of(std::begin(kAnswered), std::end(kAnswered),
                   [&](const char* part) { return what.find(part) != std::string::npos; }))
    throw;
  throw InputError(fmt::format("{}; `understudy inspect {} --machine {}` shows what to do", what,
                               request.program, request.machine));
}

bool asks_for_robot(const RobotProgramRequest& robot) {
  return !robot.signals.empty() || robot.bead_mm[0] > 0 || robot.flow_mm3_per_s || !robot.tool_points.empty();
}

toolpath::Program read_steps(const RehearsalRequest& request, const machine::MachineDescription& machine) {
  const std::string text = read_file(request.program);
  try {
    if (toolpath::robot_language(request.program, text))
      return toolpath::read_robot_program(request.program, text, robot_options(request.dialect, machine));
    if (asks_for_robot(request.dialect.robot))
      throw InputError(
          request.program +
          ": --signal, --bead, --flow and --tool-points are for KRL and RAPID, and this is G-code");
    return toolpath::parse_gcode(text, request.program, gcode_options(request.dialect, machine));
  } catch (const InputError& error) {
    offer_inspection(error, request);
  }
}

Finding about_reading(const std::string& about, int line, const std::string& message) {
  Finding finding;
  finding.kind = "reading";
  finding.severity = Severity::warning;
  finding.gcode_line = line;
  finding.about = about;
  finding.message = message;
  return finding;
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

toolpath::RobotOptions robot_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine) {
  if (!dialect.extruder_letter.empty() || !dialect.macros.empty() || !dialect.coordinates.empty() ||
      dialect.b_sign < 0 || dialect.c_sign < 0)
    throw InputError("--extruder-letter, --macros, --coordinates, --b-sign and --c-sign are for G-code");
  const RobotProgramRequest& robot = dialect.robot;
  if (robot.bead_mm[0] > 0 && robot.flow_mm3_per_s)
    throw InputError("either --bead or --flow says what a signal feeds");
  toolpath::RobotOptions options;
  options.X_WT_home = machine.X_WB * machine.X_BT_home;
  for (int i = 0; i < 3; ++i) options.offset_W[i] = from_mm(dialect.place_mm[static_cast<std::size_t>(i)]);
  options.ignored = dialect.ignored;
  options.tool_points = robot.tool_points;
  options.extruder.outputs = robot.signals;
  if (robot.bead_mm[0] > 0)
    options.extruder.bead_area = toolpath::bead_area(from_mm(robot.bead_mm[0]), from_mm(robot.bead_mm[1]));
  if (robot.flow_mm3_per_s)
    options.extruder.flow_per_unit = *robot.flow_mm3_per_s * kMillimetre * kMillimetre * kMillimetre;
  options.extruder.filament_diameter = machine.tool.filament_diameter;
  return options;
}

std::vector<Finding> robot_program_findings(const RehearsalRequest& request,
                                            const toolpath::Program& program) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(request.program, none) ||
      !toolpath::robot_language(request.program, read_file(request.program)))
    return {};
  std::vector<Finding> findings;
  const auto is = [](toolpath::StepKind kind) {
    return [kind](const toolpath::Step& s) { return s.kind == kind; };
  };
  const auto home = std::ranges::find_if(program.steps, is(toolpath::StepKind::home));
  if (home != program.steps.end()) {
    const auto count = std::ranges::count_if(program.steps, is(toolpath::StepKind::home));
    findings.push_back(about_reading(
        "axis moves", home->line,
        fmt::format(
            "{} move{} by axis values go{} to the home of {}: what the program's own robot does there is not "
            "rehearsed",
            count, count == 1 ? "" : "s", count == 1 ? "es" : "", request.machine)));
  }
  if (std::ranges::none_of(program.steps, is(toolpath::StepKind::print)))
    findings.push_back(
        about_reading("no filament", 0,
                      "no output of the program feeds filament, so that all of it is motion: name one "
                      "by --signal, or print every straight move by --signal always"));
  return findings;
}

toolpath::Program read_program(const RehearsalRequest& request, const machine::MachineDescription& machine) {
  toolpath::Program program = read_steps(request, machine);
  if (!request.dialect.temperature_c) return program;
  toolpath::Step heat;
  heat.kind = toolpath::StepKind::temperature;
  heat.X_WT = machine.X_WB * machine.X_BT_home;
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
