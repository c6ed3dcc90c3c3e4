#include "rehearsal/program/program_reading.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "control/program/gcode_options.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/shell_quoted.h"
#include "core/units.h"
#include "rehearsal/findings/start_block.h"
#include "rehearsal/program/readings.h"
#include "rehearsal/program/robot_reading.h"
#include "rehearsal/program/told_filament.h"
#include "toolpath/gcode/rewrite/turned_program.h"
#include "toolpath/inspection/program_summary.h"
#include "toolpath/inspection/slicer_filament.h"

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
                               shell_quoted(request.program), shell_quoted(request.machine)));
}

void read_gcode_into(ReadProgram& read, const std::string& text, const RehearsalRequest& request,
                     const machine::MachineDescription& machine) {
  refuse_robot_options(request);
  toolpath::GcodeOptions options = gcode_options(request.dialect, machine);
  options.passed_over = &read.passed_over;
  read.facts = toolpath::slicer_facts(text);
  read.features = toolpath::FeatureTypes(text);
  read.start_block_end = start_block_end(text, read.features);
  read.beads = toolpath::ToldBeads(text);
  const toolpath::ProgramTurn turn{from_deg(request.dialect.turn_deg), from_deg(request.dialect.spin_deg)};
  toolpath::ExtrusionTally tally;
  options.extrusion = &tally;
  read.program = toolpath::parse_turned_gcode(text, request.program, options, turn);
  if (!machine.tool.prints()) return;
  const double fed = fresh_filament(read.program);
  const auto told = toolpath::told_filament(text);
  auto finding = misread_extrusion(tally, fed, told);
  if (!finding) finding = other_amount(fed, told);
  if (finding) read.extrusion.push_back(*finding);
}

Finding finding_of(const toolpath::PassedOver& passed) {
  const double filament_mm = to_mm(passed.filament);
  std::string message = fmt::format("line {} cannot be read: {}; passed over", passed.line, passed.why);
  if (passed.last_line > passed.line)
    message +=
        fmt::format(", with the moves up to line {}, because {} of line {} {} not known", passed.last_line,
                    fmt::join(passed.unknown, " "), passed.line, passed.unknown.size() == 1 ? "is" : "are");
  if (passed.filament > 0 || !passed.filament_known)
    message += fmt::format(", without {:.3f} mm of filament{}", filament_mm,
                           passed.filament_known ? "" : " and what cannot be read");
  return {"program",
          Severity::error,
          passed.line,
          0,
          filament_mm,
          0,
          "mm",
          std::move(message),
          passed.last_line,
          fmt::format("{} {}", kPassedOver, passed.line)};  // each is told on its own
}

}  // namespace

ReadProgram read_program(const RehearsalRequest& request, const machine::MachineDescription& machine) {
  ReadProgram read;
  const std::string text = read_file(request.program);
  read.of_robot = toolpath::robot_language(request.program, text).has_value();
  try {
    if (read.of_robot)
      read.program =
          toolpath::read_robot_program(request.program, text, robot_options(request.dialect, machine));
    else
      read_gcode_into(read, text, request, machine);
  } catch (const InputError& error) {
    offer_inspection(error, request);
  }
  if (request.dialect.strict && !read.passed_over.empty())
    toolpath::refuse_passed_over(read.program.file, read.passed_over);
  control::heat_first(request.dialect, machine, read.program);
  return read;
}

std::vector<Finding> findings_of(const std::vector<toolpath::PassedOver>& lines) {
  std::vector<Finding> findings;
  findings.reserve(lines.size());
  for (const toolpath::PassedOver& line : lines) findings.push_back(finding_of(line));
  return findings;
}

std::optional<Finding> misread_words(const RehearsalRequest& request, const toolpath::Program& program,
                                     const machine::MachineDescription& machine) {
  toolpath::GcodeOptions options = gcode_options(request.dialect, machine);
  if (!options.rotary || program.steps.empty()) return std::nullopt;
  // What stands before the first move, such as heat, has no turns: the machine is at home.
  const toolpath::RotaryTurns home{options.rotary->b_home, options.rotary->c_home};
  const toolpath::RotaryTurns start = program.steps.front().rotary.value_or(home);
  const auto turned = [&](const toolpath::Step& s) {
    return s.kind == toolpath::StepKind::print && s.rotary &&
           (s.rotary->b != start.b || s.rotary->c != start.c);
  };
  if (std::ranges::none_of(program.steps, turned)) return std::nullopt;
  std::vector<toolpath::PassedOver> told_already;
  options.passed_over = &told_already;
  return misread_words(program, {request.program, read_file(request.program)}, options, request.machine);
}

}  // namespace understudy::rehearsal
