#include "rehearsal/program/robot_reading.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "toolpath/bead.h"

namespace understudy::rehearsal {
namespace {

bool asks_for_robot(const RobotProgramRequest& robot) {
  return !robot.signals.empty() || robot.bead_mm[0] > 0 || robot.flow_mm3_per_s || !robot.tool_points.empty();
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

toolpath::RobotOptions robot_options(const DialectRequest& dialect,
                                     const machine::MachineDescription& machine) {
  if (!dialect.extruder_letter.empty() || !dialect.macros.empty() || !dialect.coordinates.empty() ||
      dialect.b_sign < 0 || dialect.c_sign < 0 || dialect.relative_extrusion)
    throw InputError(
        "--extruder-letter, --relative-extrusion, --macros, --coordinates, --b-sign and --c-sign are for "
        "G-code");
  if (dialect.turn_deg != 0 || dialect.spin_deg != 0) throw InputError("--turn and --spin are for G-code");
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

void refuse_robot_options(const RehearsalRequest& request) {
  if (asks_for_robot(request.dialect.robot))
    throw InputError(
        request.program +
        ": --signal, --bead, --flow and --tool-points are for KRL and RAPID, and this is G-code");
}

std::vector<Finding> robot_program_findings(const toolpath::Program& program, const std::string& machine) {
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
            count, count == 1 ? "" : "s", count == 1 ? "es" : "", machine)));
  }
  if (std::ranges::none_of(program.steps, is(toolpath::StepKind::print)))
    findings.push_back(
        about_reading("no filament", 0,
                      "no output of the program feeds filament, so that all of it is motion: name one "
                      "by --signal, or print every straight move by --signal always"));
  return findings;
}

}  // namespace understudy::rehearsal
