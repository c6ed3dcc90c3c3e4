#include "rehearsal/findings/findings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "core/yaml/file_unit.h"
#include "rehearsal/findings/feature_findings.h"
#include "rehearsal/findings/flow_findings.h"
#include "rehearsal/findings/place_text.h"

namespace understudy::rehearsal {
namespace {

using kinematics::LimitKind;

/// The contract's word for a broken limit: screws that come too near are a collision.
std::string kind_of(LimitKind kind) {
  return kind == LimitKind::screw_distance ? "collision" : to_string(kind);
}

/// A condition number beyond the resolution of double is told as this, not as infinity.
constexpr double kSingular = 1e15;

/// Contacts of the same two bodies on lines that follow each other: the worst of them speaks for all.
struct ContactStretch {
  sim::Contact worst;
  std::string obstacle;
  double begin_time = 0;
  int first_line = 0, last_line = 0;
};

constexpr int kSameStretch = 3;  // lines from one contact to the next

std::vector<ContactStretch> stretches_of(const std::vector<sim::Contact>& contacts) {
  std::vector<ContactStretch> stretches;
  std::map<std::pair<std::string, std::string>, std::size_t> open;
  for (const sim::Contact& contact : contacts) {
    // Beads are many, what was printed is one.
    const std::string obstacle = contact.bead_line > 0 ? "bead" : contact.obstacle;
    const auto [entry, is_new] = open.try_emplace({contact.body, obstacle}, stretches.size());
    if (!is_new) {
      ContactStretch& stretch = stretches[entry->second];
      if (std::abs(contact.line - stretch.last_line) <= kSameStretch) {
        stretch.last_line = contact.line;
        if (contact.clearance < stretch.worst.clearance) stretch.worst = contact;
        continue;
      }
      entry->second = stretches.size();
    }
    stretches.push_back({contact, obstacle, contact.time, contact.line, contact.line});
  }
  return stretches;
}

Finding contact_finding(const ContactStretch& stretch, bool touches, double limit) {
  const sim::Contact& contact = stretch.worst;
  Finding f;
  f.about = contact.body + " and " + stretch.obstacle;
  f.kind = touches ? "collision" : "near_collision";
  f.severity = touches ? Severity::error : Severity::warning;
  f.gcode_line = stretch.first_line;
  f.last_line = stretch.last_line;
  f.bead_line = contact.bead_line;
  f.time_s = stretch.begin_time;
  f.value = to_mm(contact.clearance);
  f.limit = to_mm(limit);
  f.unit = "mm";
  f.message = touches ? fmt::format("{} touches {}, {:.3f} mm deep at {}", contact.body, contact.obstacle,
                                    -f.value, place_text(contact.place_W))
                      : fmt::format("{} passes {} at {:.3f} mm, nearer than {:.3f} mm, at {}", contact.body,
                                    contact.obstacle, f.value, f.limit, place_text(contact.place_W));
  if (stretch.last_line != stretch.first_line) f.message += fmt::format(" on line {}", contact.line);
  return f;
}

/// The end of a line that goes on from something, or comes to it: it droops, and what lies on it is judged by
/// itself. On a part or the table it was to lie, not to span a hollow of the print.
bool is_short_end(const sim::UnsupportedStretch& loose, const machine::Tool& tool) {
  constexpr double kBoresOfPrint = 5, kBoresOfPart = 1;
  return loose.adhesion == sim::Adhesion::unsupported && (loose.held_at_start || loose.held_at_end) &&
         std::isfinite(loose.worst_gap) &&
         loose.length <= (loose.on_printed ? kBoresOfPrint : kBoresOfPart) * tool.nozzle_diameter;
}

Finding loose_finding(const sim::UnsupportedStretch& loose, const TwinSetup& setup) {
  Finding f;
  if (is_short_end(loose, setup.machine.tool)) f.severity = Severity::warning;
  f.kind = "adhesion";
  f.gcode_line = loose.line;
  f.time_s = loose.time;
  f.limit = to_mm(loose.highest_gap);
  f.unit = "mm";
  f.value = std::isfinite(loose.worst_gap) ? to_mm(loose.worst_gap) : to_mm(sim::kGapReach);
  std::string why;
  f.about = kTooHigh;
  if (loose.adhesion == sim::Adhesion::cold) {
    f.about = kCold;
    f.value = loose.interface_temperature - kCelsiusZero;
    f.limit = setup.material.glass_transition - kCelsiusZero;
    f.unit = "C";
    why = fmt::format(
        "its interface with the bead below is at {:.0f} C, below the glass transition at {:.0f} C", f.value,
        f.limit);
  } else if (loose.adhesion == sim::Adhesion::buried) {
    f.about = kTooLow;
    f.limit = 0;
    why = fmt::format("the nozzle is {:.3f} mm below the surface", -f.value);
  } else if (!std::isfinite(loose.worst_gap)) {
    f.about = kNothingBelow;
    why = fmt::format("nothing lies below the nozzle within {:.0f} mm", f.value);
  } else {
    why = fmt::format("gap up to {:.3f} mm, above {:.3f} mm", f.value, f.limit);
  }
  f.message = fmt::format("bead of {:.2f} mm does not stick: {}, from {}", to_mm(loose.length), why,
                          place_text(loose.place_W));
  return f;
}

/// Half of its diameter is the sag at which a strand no longer meets what was planned to lie on it.
Finding sag_finding(const sim::AirStrand& strand, const machine::Tool& tool) {
  constexpr double kShort = 10;  // bores
  Finding f;
  f.kind = "sag";
  f.severity = strand.solved && strand.small ? Severity::warning : Severity::error;
  f.gcode_line = strand.line;
  f.time_s = strand.time;
  f.value = to_mm(strand.sag);
  f.limit = to_mm(strand.diameter / 2);
  f.unit = "mm";
  const std::string what = fmt::format("strand of {:.1f} mm in air, {:.2f} mm thick,", to_mm(strand.length),
                                       to_mm(strand.diameter));
  if (!strand.solved) {
    f.about = "not solved";
    f.message = fmt::format("{} from {}: too long and crooked for its sag to be known", what,
                            place_text(strand.from_W));
    return f;
  }
  if (f.severity == Severity::error && strand.length <= kShort * tool.nozzle_diameter) f.about = kShortStrand;
  if (strand.lies && strand.sag >= sim::kGapReach) {
    f.message = fmt::format("{} falls: nothing lies below it, from {}", what, place_text(strand.from_W));
    return f;
  }
  f.message = fmt::format(
      "{} sags by {}{:.3f} mm at {}{}", what, strand.small || strand.lies ? "" : "more than ", f.value,
      place_text(strand.sag_place_W), strand.held_at_end ? "" : "; nothing holds its end");
  return f;
}

constexpr double kNoLength = 5e-6;  // [m]: a bead so short is a drop, and told as 0.00 mm

/// Held by what follows, and so not lost; but no groove of the print is below.
bool begins_too_high(const sim::UnsupportedStretch& loose) {
  return sim::spans_a_groove(loose) && !loose.held_at_start && !loose.on_printed &&
         std::isfinite(loose.worst_gap);
}

Finding high_start_finding(const sim::UnsupportedStretch& loose, double limit) {
  Finding f{"adhesion", Severity::warning, loose.line, loose.time, to_mm(loose.worst_gap), to_mm(limit), "mm",
            {}};
  f.about = kTooHigh;
  f.message = fmt::format(
      "the first {:.2f} mm of a line lie up to {:.3f} mm over the surface, above {:.3f} mm: only "
      "what follows holds them, from {}",
      to_mm(loose.length), f.value, f.limit, place_text(loose.place_W));
  return f;
}

/// A line that is cured over something near, and does not reach it: it was to lie there, not to span.
bool light_falls_short(const sim::UnsupportedStretch& loose, const TwinSetup& setup) {
  return setup.cure && loose.adhesion == sim::Adhesion::unsupported &&
         loose.worst_gap <= setup.machine.gap.accepted_max;
}

void add_strand_findings(const TwinRun& run, const TwinSetup& setup, std::vector<Finding>& findings) {
  for (const auto& loose : run.loose)
    if (loose.length < kNoLength)
      continue;
    else if (light_falls_short(loose, setup) || (!sim::hangs_in_air(loose) && !sim::spans_a_groove(loose)))
      findings.push_back(loose_finding(loose, setup));
    else if (begins_too_high(loose))
      findings.push_back(high_start_finding(loose, loose.highest_gap));
  for (Finding& finding : flow_findings(run.flow)) findings.push_back(std::move(finding));
  for (Finding& finding : fill_findings(run.fill)) findings.push_back(std::move(finding));
  for (const auto& strand : run.strands)
    if (!strand.solved || strand.sag > strand.diameter / 2)
      findings.push_back(sag_finding(strand, setup.machine.tool));
}

Finding gap_finding(Severity severity, int line, double time, double gap, double limit) {
  return {"gap", severity, line, time, to_mm(gap), to_mm(limit), "mm", {}};
}

/// The gap controller gave up, or did less than it was asked for.
void add_control_findings(const TwinRun& run, const machine::GapLimits& limits, control::GapControl mode,
                          std::vector<Finding>& findings) {
  const auto add = [&](Finding finding, const char* about, std::string message) {
    finding.about = about;
    finding.message = std::move(message);
    findings.push_back(std::move(finding));
  };
  for (const auto& approach : run.result.approaches) {
    const auto& outcome = approach.outcome;
    if (outcome.stop == control::GapStop::none) continue;
    add(gap_finding(Severity::error, approach.line, approach.done_at, outcome.gap, limits.accepted_max),
        kStopped, fmt::format("gap control stopped ({}): {}", to_string(outcome.stop), outcome.why));
  }
  const control::Stop& stop = run.result.stop;
  if (run.result.stopped_on_path())
    add(gap_finding(Severity::error, stop.line, stop.time, run.result.following->gap, limits.accepted_max),
        kStopped, fmt::format("gap control stopped on the path: {}", stop.why));
  if (const auto& unmeasured = run.result.unmeasured_starts; !unmeasured.empty())
    add(gap_finding(Severity::warning, unmeasured.front(), 0, limits.aim, limits.accepted_max), kUnmeasured,
        fmt::format(
            "the dot would not lie on what is printed on at the start of {} bead{}: the offset of the "
            "bead before was carried on",
            unmeasured.size(), unmeasured.size() == 1 ? "" : "s"));
  if (mode != control::GapControl::off && run.result.completed && run.result.approaches.empty() &&
      run.deposition.length > 0)
    add(gap_finding(Severity::warning, 0, 0, limits.aim, limits.accepted_max), kUncontrolled,
        "the program has no approach along the tool axis before it prints: the gap was not controlled");
}

void add_low_gap(const sim::DepositionSummary& laid, std::vector<Finding>& findings) {
  constexpr double kRounding = 0.1e-6;  // [m]: printed surfaces are known to single precision
  const sim::LowestGap& lowest = laid.lowest;
  if (laid.length == 0 || laid.gap_max <= 0 || lowest.gap >= lowest.accepted_min - kRounding) return;
  Finding f = gap_finding(Severity::error, lowest.line, lowest.time, lowest.gap, lowest.accepted_min);
  f.about = kTooLow;
  f.message = fmt::format("the nozzle runs as low as {:.3f} mm over the surface, below {:.3f} mm",
                          to_mm(lowest.gap), to_mm(lowest.accepted_min));
  findings.push_back(std::move(f));
}

}  // namespace

std::vector<Finding> findings_of(const control::ConstraintReport& report) {
  std::vector<Finding> findings;
  for (const auto& entry : report.findings) {
    const auto& violation = entry.violation;
    const FileUnit unit = file_unit(violation.unit);
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
    f.last_line = entry.last_line;
    f.about = violation.part;
    findings.push_back(std::move(f));
  }
  return findings;
}

std::vector<Finding> findings_of(const TwinRun& run, const TwinSetup& setup,
                                 control::GapControl gap_control) {
  const machine::MachineDescription& machine = setup.machine;
  std::vector<Finding> findings;
  for (const auto& stretch : stretches_of(run.collisions))
    findings.push_back(contact_finding(stretch, true, 0));
  const sim::CollisionOptions options;
  for (const auto& stretch : stretches_of(run.near_collisions))
    findings.push_back(contact_finding(stretch, false, options.near));
  add_control_findings(run, machine.gap, gap_control, findings);
  add_low_gap(run.deposition, findings);
  add_strand_findings(run, setup, findings);
  const bool explained = run.result.stop.gap != control::GapStop::none;
  if (run.registration && !run.registration->good()) {
    const auto refusals = registration_findings(*run.registration);
    findings.insert(findings.end(), refusals.begin(), refusals.end());
  } else if (!run.result.completed && !explained) {
    Finding f;
    f.kind = "unreachable";
    f.gcode_line = run.result.stop.line;
    f.time_s = run.result.duration;
    f.unit = "1";
    f.message = "the print stopped: " + run.result.stop.why;
    f.about = kStopped;
    findings.push_back(std::move(f));
  }
  return findings;
}

void tell_how_simulated(std::vector<Finding>& findings) {
  for (Finding& finding : findings) {
    if (finding.kind == "strut_length" || finding.kind == "joint_limit")
      finding.message += "; simulated with the axis held at its limit";
    if (finding.kind == "joint_angle" || finding.kind == "collision")
      finding.message += "; simulated as if it went on";
  }
}

void sort_findings(std::vector<Finding>& findings) {
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    if (a.severity != b.severity) return a.severity == Severity::error;
    if (a.gcode_line != b.gcode_line) return a.gcode_line < b.gcode_line;
    return a.time_s < b.time_s;
  });
}

}  // namespace understudy::rehearsal
