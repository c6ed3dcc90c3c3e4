#include "rehearsal/program/reachable_program.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "control/motion/constraint_check.h"
#include "rehearsal/findings/findings.h"
#include "toolpath/pass_over.h"

namespace understudy::rehearsal {
namespace {

constexpr int kMostRounds = 5;  // the travels that join what is left may be impossible, too

/// Lines of moves one after the other.
std::vector<std::pair<int, int>> lines_of(const toolpath::Program& program,
                                          const std::vector<std::size_t>& steps) {
  std::vector<std::pair<int, int>> lines;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const int line = program.steps[steps[i]].line;
    if (lines.empty() || line > lines.back().second + 1)
      lines.emplace_back(line, line);
    else
      lines.back().second = std::max(lines.back().second, line);
  }
  return lines;
}

bool touches(const Finding& finding, const std::pair<int, int>& lines) {
  return finding.gcode_line <= lines.second && std::max(finding.gcode_line, finding.last_line) >= lines.first;
}

/// What is possible, or nothing.
std::optional<toolpath::Program> possible(toolpath::Program program, const Pose& X_WT_home,
                                          const machine::MachineDescription& machine,
                                          std::vector<std::size_t> impossible, std::vector<Finding>& timed) {
  for (int round = 0; round < kMostRounds; ++round) {
    toolpath::pass_over(program, X_WT_home, impossible);
    if (std::ranges::none_of(program.steps, toolpath::moves)) return std::nullopt;
    const control::ConstraintReport report = control::check_constraints(program, machine);
    impossible = report.impossible;
    if (!impossible.empty()) continue;
    timed = findings_of(report);
    return program;
  }
  return std::nullopt;
}

/// Of limits that are broken in what is left: when that is.
void take_times(const std::vector<Finding>& timed, std::vector<Finding>& findings) {
  for (Finding& finding : findings)
    for (const Finding& other : timed)
      if (other.kind == finding.kind && other.about == finding.about &&
          other.gcode_line == finding.gcode_line)
        finding.time_s = other.time_s;
}

}  // namespace

Reach check_reach(toolpath::Program& program, const machine::MachineDescription& machine, bool keep) {
  const control::ConstraintReport report = control::check_constraints(program, machine);
  Reach reach{findings_of(report), {}};
  if (report.impossible.empty() || keep) return reach;
  std::vector<Finding> timed;
  auto rest = possible(program, machine.X_WB * machine.X_BT_home, machine, report.impossible, timed);
  if (!rest) return reach;
  reach.passed_over = lines_of(program, report.impossible);
  for (Finding& finding : reach.findings) {
    const bool no_way = finding.kind == "unreachable" || finding.kind == "singularity";
    if (no_way && finding.severity == Severity::error &&
        std::ranges::any_of(reach.passed_over, [&](const auto& lines) { return touches(finding, lines); }))
      finding.message += "; passed over, and the rest simulated";
  }
  take_times(timed, reach.findings);
  program = std::move(*rest);
  return reach;
}

}  // namespace understudy::rehearsal
