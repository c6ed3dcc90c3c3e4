#include "rehearsal/findings.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"

namespace understudy::rehearsal {
namespace {

using kinematics::LimitKind;

/// The contract's word for a broken limit: screws that come too near are a collision.
std::string kind_of(LimitKind kind) {
  return kind == LimitKind::screw_distance ? "collision" : to_string(kind);
}

/// A condition number beyond the resolution of double is told as this, not as infinity.
constexpr double kSingular = 1e15;

struct ReportUnit {
  double factor;
  const char* name;
};

ReportUnit report_unit(const std::string& si) {
  if (si == "m") return {1e3, "mm"};
  if (si == "rad") return {1 / kDegree, "deg"};
  if (si == "m/s") return {1e3, "mm/s"};
  if (si == "m/s^2") return {1e3, "mm/s2"};
  if (si == "rad/s") return {1 / kDegree, "deg/s"};
  if (si == "rad/s^2") return {1 / kDegree, "deg/s2"};
  return {1, "1"};
}

Finding contact_finding(const sim::Contact& contact, bool touches, double limit) {
  Finding f;
  f.kind = touches ? "collision" : "near_collision";
  f.severity = touches ? Severity::error : Severity::warning;
  f.gcode_line = contact.line;
  f.time_s = contact.time;
  f.value = to_mm(contact.clearance);
  f.limit = to_mm(limit);
  f.unit = "mm";
  const Vec3 place = contact.place_W * 1e3;
  f.message =
      touches
          ? fmt::format("{} touches {}, {:.3f} mm deep at ({:.2f}, {:.2f}, {:.2f}) mm", contact.body,
                        contact.obstacle, -f.value, place.x(), place.y(), place.z())
          : fmt::format("{} passes {} at {:.3f} mm, nearer than {:.3f} mm, at ({:.2f}, {:.2f}, {:.2f}) mm",
                        contact.body, contact.obstacle, f.value, f.limit, place.x(), place.y(), place.z());
  return f;
}

Finding loose_finding(const sim::DepositionObserver::Loose& loose, double accepted_max) {
  Finding f;
  f.kind = "adhesion";
  f.gcode_line = loose.line;
  f.time_s = loose.time;
  f.limit = to_mm(accepted_max);
  f.unit = "mm";
  const Vec3 place = loose.place_W * 1e3;
  const bool in_air = !std::isfinite(loose.worst_gap);
  f.value = in_air ? to_mm(sim::kGapReach) : to_mm(loose.worst_gap);
  const std::string why = in_air ? fmt::format("nothing lies below the nozzle within {:.0f} mm", f.value)
                                 : fmt::format("gap up to {:.3f} mm, above {:.3f} mm", f.value, f.limit);
  f.message = fmt::format("bead of {:.2f} mm does not stick: {}, from ({:.2f}, {:.2f}, {:.2f}) mm",
                          to_mm(loose.length), why, place.x(), place.y(), place.z());
  return f;
}

Finding gap_finding(Severity severity, int line, double time, double gap, double limit, std::string message) {
  return {"gap", severity, line, time, to_mm(gap), to_mm(limit), "mm", std::move(message)};
}

void add_gap_findings(const TwinRun& run, const machine::MachineDescription& machine,
                      control::GapControl mode, std::vector<Finding>& findings) {
  const auto& limits = machine.gap;
  for (const auto& approach : run.result.approaches) {
    const auto& outcome = approach.outcome;
    if (outcome.stop == control::GapStop::none) continue;
    findings.push_back(
        gap_finding(Severity::error, approach.line, approach.done_at, outcome.gap, limits.accepted_max,
                    fmt::format("gap control stopped ({}): {}", to_string(outcome.stop), outcome.why)));
  }
  if (mode == control::GapControl::start && run.result.completed && run.result.approaches.empty() &&
      run.deposition.length > 0)
    findings.push_back(gap_finding(
        Severity::warning, 0, 0, limits.aim, limits.accepted_max,
        "the program has no approach along the tool axis before it prints: the gap was not controlled"));
  const auto& laid = run.deposition;
  if (laid.length == 0) return;
  const auto lowest = std::min_element(run.trace.begin(), run.trace.end(), [](const auto& a, const auto& b) {
    return (a.extruding ? a.gap : HUGE_VAL) < (b.extruding ? b.gap : HUGE_VAL);
  });
  if (lowest->extruding && lowest->gap < limits.accepted_min)
    findings.push_back(
        gap_finding(Severity::error, lowest->line, lowest->time, lowest->gap, limits.accepted_min,
                    fmt::format("the nozzle runs as low as {:.3f} mm over the surface, below {:.3f} mm",
                                to_mm(lowest->gap), to_mm(limits.accepted_min))));
}

}  // namespace

std::vector<Finding> findings_of(const control::ConstraintReport& report) {
  std::vector<Finding> findings;
  for (const auto& entry : report.findings) {
    const auto& violation = entry.violation;
    const ReportUnit unit = report_unit(violation.unit);
    Finding f;
    f.kind = kind_of(violation.kind);
    // The planner slows down where an axis is too fast: the print takes longer but is safe.
    f.severity = violation.kind == LimitKind::axis_velocity || violation.kind == LimitKind::axis_acceleration
                     ? Severity::warning
                     : Severity::error;
    f.gcode_line = entry.line;
    f.time_s = entry.time;
    f.value = std::min(violation.value * unit.factor, kSingular);
    f.limit = violation.limit * unit.factor;
    f.unit = unit.name;
    f.message = to_string(violation);
    findings.push_back(std::move(f));
  }
  return findings;
}

std::vector<Finding> findings_of(const TwinRun& run, const machine::MachineDescription& machine,
                                 control::GapControl gap_control) {
  std::vector<Finding> findings;
  for (const auto& contact : run.collisions) findings.push_back(contact_finding(contact, true, 0));
  const sim::CollisionOptions options;
  for (const auto& contact : run.near_collisions)
    findings.push_back(contact_finding(contact, false, options.near));
  add_gap_findings(run, machine, gap_control, findings);
  for (const auto& loose : run.loose) findings.push_back(loose_finding(loose, machine.gap.accepted_max));
  const bool explained = std::any_of(run.result.approaches.begin(), run.result.approaches.end(),
                                     [](const auto& a) { return a.outcome.stop != control::GapStop::none; });
  if (!run.result.completed && !explained) {
    Finding f;
    f.kind = "unreachable";
    f.gcode_line = run.result.stop_line;
    f.time_s = run.result.duration;
    f.unit = "1";
    f.message = "the print stopped: " + run.result.stop_reason;
    findings.push_back(std::move(f));
  }
  return findings;
}

void sort_findings(std::vector<Finding>& findings) {
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    if (a.severity != b.severity) return a.severity == Severity::error;
    if (a.gcode_line != b.gcode_line) return a.gcode_line < b.gcode_line;
    return a.time_s < b.time_s;
  });
}

}  // namespace understudy::rehearsal
