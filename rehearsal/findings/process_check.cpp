#include "rehearsal/findings/process_check.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/deposition/bead_section.h"

namespace understudy::rehearsal {
namespace {

constexpr double kLongestRetraction = 0.05;  // [m]
constexpr double kShortestPath = 1e-3;       // [m]: on less, what is fed is a blob
constexpr double kLongestPrime = 0.1;        // [m] of filament fed at a standstill or nearly
constexpr const char* kSimulated = "; simulated ";
constexpr int kSameStretch = 3;  // lines from one of its kind to the next

/// Filament that cannot be fed so.
struct Fault {
  std::string message, about;
  double value = 0, limit = 0;  // in `unit`
  std::string unit;
};

class Checker {
 public:
  Checker(const std::string& file, const machine::MachineDescription& machine,
          const machine::Material& material)
      : file_(file),
        machine_(machine),
        material_(material),
        tip_((machine.X_WB * machine.X_BT_home).translation()) {}

  /// What is wrong with the next step; `possible` [m] is the filament that it can feed.
  std::optional<Fault> check(const toolpath::Step& step, double& possible) {
    if (step.kind == toolpath::StepKind::temperature) temperature_ = step.temperature;
    const Vec3 end = step.X_WT.translation();
    const double path = (end - tip_).norm();
    if (toolpath::moves(step)) tip_ = end;
    possible = step.filament;
    if (step.filament == 0) return std::nullopt;
    // What was not drawn back need not be pushed back.
    const double still_in = std::clamp(step.filament, 0.0, not_drawn_);
    not_drawn_ -= still_in;
    possible -= still_in;
    std::optional<Fault> fault = step.filament > 0 ? check_fed(step, path, possible) : check_drawn(possible);
    fed_ += possible;
    most_ = std::max(most_, fed_);
    return fault;
  }

 private:
  std::optional<Fault> check_drawn(double& possible) {
    const double drawn = most_ - fed_ - possible;
    if (drawn <= kLongestRetraction) return std::nullopt;
    const double beyond = std::min(drawn - kLongestRetraction, -possible);
    possible += beyond;
    not_drawn_ += beyond;
    return Fault{fmt::format("{:.2f} mm of filament are drawn back, more than {:.0f} mm", to_mm(drawn),
                             to_mm(kLongestRetraction)),
                 "filament drawn back", to_mm(drawn), to_mm(kLongestRetraction), "mm"};
  }

  std::optional<Fault> check_fed(const toolpath::Step& step, double path, double& possible) const {
    std::optional<Fault> fault = check_temperature(step);
    const double fresh = std::max(0.0, fed_ + possible - most_);
    if (fault) possible = 0;  // nothing of what is solid moves
    if (fault || fresh == 0) return fault;
    fault = check_amount(path, fresh);
    if (fault) possible -= fresh;
    return fault;
  }

  std::optional<Fault> check_temperature(const toolpath::Step& step) const {
    if (temperature_ <= 0)
      throw InputError({file_, step.line, 0},
                       "extrudes before any nozzle temperature is set (M104, M109 or --temperature)");
    if (temperature_ > material_.glass_transition) return std::nullopt;
    const double is = temperature_ - kCelsiusZero, solid = material_.glass_transition - kCelsiusZero;
    return Fault{fmt::format("extrudes at {:.1f} C, where {} is solid: its glass transition is at {:.1f} C",
                             is, material_.name, solid),
                 "filament that is solid", is, solid, "C"};
  }

  std::optional<Fault> check_amount(double path, double fresh) const {
    const double filament = machine_.tool.filament_diameter, bore = machine_.tool.nozzle_diameter;
    const double filament_area = std::numbers::pi / 4 * filament * filament;
    if (path < kShortestPath) {
      if (fresh <= kLongestPrime) return std::nullopt;
      return Fault{fmt::format("feeds {:.1f} mm of filament on {:.3f} mm of path, more than {:.0f} mm",
                               to_mm(fresh), to_mm(path), to_mm(kLongestPrime)),
                   "filament at a standstill", to_mm(fresh), to_mm(kLongestPrime), "mm"};
    }
    const double area = fresh * filament_area / path;
    const double limit = sim::kWidestLine * sim::kWidestLine * bore * bore;
    if (area <= limit) return std::nullopt;
    return Fault{
        fmt::format("feeds {:.3f} mm of filament over {:.3f} mm: a bead of {:.2f} mm2, more than {:.2f} mm2 "
                    "({:g} bores of {:g} mm wide and high)",
                    to_mm(fresh), to_mm(path), area * 1e6, limit * 1e6, sim::kWidestLine, to_mm(bore)),
        "bead", area * 1e6, limit * 1e6, "mm2"};
  }

  const std::string& file_;
  const machine::MachineDescription& machine_;
  const machine::Material& material_;
  Vec3 tip_;
  double temperature_ = 0;     // [K]
  double fed_ = 0, most_ = 0;  // [m], as far as it can be
  double not_drawn_ = 0;       // [m], that the program believes to be drawn back
};

Finding finding_of(const Fault& fault, int line) {
  Finding f;
  f.kind = "program";
  f.gcode_line = f.last_line = line;
  f.value = fault.value;
  f.limit = fault.limit;
  f.unit = fault.unit;
  f.about = fault.about;
  f.message = fault.message + kSimulated +
              (fault.about == "filament drawn back" ? "with as much as can be" : "without this filament");
  return f;
}

/// Faults of a kind on lines that follow each other are one finding: the first speaks for all.
void add(Finding finding, std::vector<Finding>& findings) {
  const auto same = std::find_if(findings.rbegin(), findings.rend(),
                                 [&](const Finding& f) { return f.about == finding.about; });
  if (same != findings.rend() && finding.gcode_line - same->last_line <= kSameStretch)
    same->last_line = finding.last_line;
  else
    findings.push_back(std::move(finding));
}

void feed_only(double possible, toolpath::Step& step, bool still) {
  step.filament = possible;
  if (possible <= 0 && step.kind == toolpath::StepKind::print) step.kind = toolpath::StepKind::move;
  if (possible == 0 && still && step.duration > 0) {
    step.kind = toolpath::StepKind::dwell;
    step.feed = 0;
  }
}

[[noreturn]] void refuse(const std::string& file, const std::vector<Finding>& findings) {
  constexpr std::size_t kTold = 20;
  const auto plain = [](const Finding& f) { return f.message.substr(0, f.message.find(kSimulated)); };
  std::string text = plain(findings.front());
  for (std::size_t i = 1; i < std::min(findings.size(), kTold); ++i)
    text += fmt::format("; line {}: {}", findings[i].gcode_line, plain(findings[i]));
  if (findings.size() > kTold) text += fmt::format("; and {} more", findings.size() - kTold);
  throw InputError({file, findings.front().gcode_line, 0}, text);
}

}  // namespace

std::vector<Finding> mend_process(toolpath::Program& program, const machine::MachineDescription& machine,
                                  const machine::Material& material) {
  std::vector<Finding> findings;
  if (!machine.tool.prints()) return findings;
  Checker checker(program.file, machine, material);
  Vec3 tip_W = (machine.X_WB * machine.X_BT_home).translation();
  bool prints = false;
  for (toolpath::Step& step : program.steps) {
    double possible = 0;
    const bool still = (step.X_WT.translation() - tip_W).norm() == 0;
    if (toolpath::moves(step)) tip_W = step.X_WT.translation();
    if (const auto fault = checker.check(step, possible)) add(finding_of(*fault, step.line), findings);
    if (possible != step.filament) feed_only(possible, step, still);
    prints = prints || step.kind == toolpath::StepKind::print;
  }
  if (findings.size() > kMostFaults || (!findings.empty() && !prints)) refuse(program.file, findings);
  return findings;
}

void check_process(const toolpath::Program& program, const machine::MachineDescription& machine,
                   const machine::Material& material) {
  toolpath::Program mended = program;
  const std::vector<Finding> findings = mend_process(mended, machine, material);
  if (!findings.empty()) refuse(program.file, findings);
}

std::vector<Finding> temperature_findings(const toolpath::Program& program,
                                          const machine::Material& material) {
  Finding cold, hot;
  for (Finding* f : {&cold, &hot}) {
    f->kind = "flow";
    f->unit = "C";
  }
  cold.severity = Severity::error;
  cold.about = kNozzleCold;
  cold.limit = cold.value = material.nozzle_temperature_min - kCelsiusZero;
  hot.severity = Severity::warning;
  hot.about = kNozzleHot;
  hot.limit = hot.value = material.nozzle_temperature_max - kCelsiusZero;
  const auto widen = [](Finding& f, int line, double celsius) {
    if (f.gcode_line == 0) f.gcode_line = line;
    f.last_line = line;
    if (std::abs(celsius - f.limit) > std::abs(f.value - f.limit)) f.value = celsius;
  };
  double celsius = -kCelsiusZero;
  for (const toolpath::Step& step : program.steps) {
    if (step.kind == toolpath::StepKind::temperature) celsius = step.temperature - kCelsiusZero;
    if (step.filament <= 0 || celsius <= 0) continue;
    if (celsius < cold.limit) widen(cold, step.line, celsius);
    if (celsius > hot.limit) widen(hot, step.line, celsius);
  }
  std::vector<Finding> findings;
  for (Finding* f : {&cold, &hot}) {
    if (f->gcode_line == 0) continue;
    f->message =
        fmt::format("filament is fed at {:.0f} C, {} {} is printed: {:.0f} C", f->value,
                    f == &cold ? "below the lowest temperature at which" : "above the highest at which",
                    material.name, f->limit);
    findings.push_back(*f);
  }
  return findings;
}

}  // namespace understudy::rehearsal
