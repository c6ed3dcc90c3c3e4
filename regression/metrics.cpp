#include "regression/metrics.h"

#include <algorithm>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "core/text/stable_number.h"
#include "rehearsal/figures.h"
#include "rehearsal/findings/verdict.h"

namespace understudy::regression {
namespace {

// A kind of finding and the section of the summary that shows it was looked for; none: checked before any
// motion.
struct Kind {
  const char* word;
  const char* section;
};
constexpr Kind kKinds[] = {{"strut_length", ""},
                           {"joint_angle", ""},
                           {"joint_limit", ""},
                           {"axis_velocity", ""},
                           {"axis_acceleration", ""},
                           {"singularity", ""},
                           {"unreachable", ""},
                           {"collision", "collision"},
                           {"near_collision", "collision"},
                           {"gap", "gap"},
                           {"adhesion", "gap"},
                           {"sag", "sag"},
                           {"flow", "print"},
                           {"accuracy", "accuracy"},
                           {"gouge", "removal"},
                           {"left_over", "removal"},
                           {"registration", "registration"},
                           {"reading", ""},
                           {"program", ""},
                           {"placement", ""}};

// Figures of the contract, by section.
constexpr const char* kFigures[] = {"print.duration_s",
                                    "print.moves",
                                    "print.extruded_mm",
                                    "print.printed_mm",
                                    "print.purged_mm",
                                    "print.missing_mm",
                                    "print.primed_mm",
                                    "print.deposited_mm",
                                    "print.spanning_mm",
                                    "print.travel_mm",
                                    "print.tilt_max_deg",
                                    "print.turned_deg",
                                    "print.fill_factor",
                                    "accuracy.tip_rms_um",
                                    "accuracy.tip_p95_um",
                                    "accuracy.tip_max_um",
                                    "accuracy.orientation_max_mrad",
                                    "accuracy.open_loop_tip_max_um",
                                    "accuracy.tip_tolerance_mm",
                                    "accuracy.orientation_tolerance_deg",
                                    "registration.places",
                                    "registration.left_out",
                                    "registration.duration_s",
                                    "registration.seen",
                                    "registration.reference_x_mm",
                                    "registration.reference_y_mm",
                                    "registration.reference_z_mm",
                                    "registration.shift_x_um",
                                    "registration.shift_y_um",
                                    "registration.shift_z_um",
                                    "registration.shift_sigma_x_um",
                                    "registration.shift_sigma_y_um",
                                    "registration.shift_sigma_z_um",
                                    "registration.turn_x_mrad",
                                    "registration.turn_y_mrad",
                                    "registration.turn_z_mrad",
                                    "registration.turn_sigma_x_mrad",
                                    "registration.turn_sigma_y_mrad",
                                    "registration.turn_sigma_z_mrad",
                                    "registration.chi_square",
                                    "registration.degrees_of_freedom",
                                    "registration.chi_square_limit",
                                    "registration.place_sigma_um",
                                    "registration.normal_sigma_max_um",
                                    "registration.normal_error_rms_um",
                                    "registration.normal_error_max_um",
                                    "gap.commanded_mm",
                                    "gap.open_loop_start_mm",
                                    "gap.start_mm",
                                    "gap.path_min_mm",
                                    "gap.path_mean_mm",
                                    "gap.path_max_mm",
                                    "gap.in_band_fraction",
                                    "gap.frames",
                                    "gap.believed_mean_mm",
                                    "gap.stated_sigma_um",
                                    "gap.stated_path_fraction",
                                    "gap.inside_stated_3_sigma_fraction",
                                    "sag.max_um",
                                    "sag.strands",
                                    "sag.unsupported_mm",
                                    "sag.diameter_min_mm",
                                    "sag.diameter_max_mm",
                                    "collision.min_clearance_mm",
                                    "collision.nozzle_clearance_mm",
                                    "collision.checks",
                                    "collision.pairs",
                                    "surface.ra_um",
                                    "surface.rz_um",
                                    "surface.deviation_p95_um",
                                    "removal.spacing_mm",
                                    "removal.finished_fraction",
                                    "removal.left_over_mean_um",
                                    "removal.left_over_p95_um",
                                    "removal.left_over_max_um",
                                    "removal.planned_left_over_p95_um",
                                    "removal.planned_left_over_max_um",
                                    "removal.gouge_um",
                                    "removal.planned_gouge_um",
                                    "removal.gouge_x_mm",
                                    "removal.gouge_y_mm",
                                    "removal.gouge_z_mm",
                                    "removal.gouge_line",
                                    "removal.volume_mm3",
                                    "engine.timestep_s",
                                    "engine.steps",
                                    "engine.closure_max_um",
                                    "timing.simulated_s",
                                    "timing.wall_s",
                                    "timing.real_time_factor",
                                    "timing.to_first_setpoint_s"};
// What a series of machines knows besides the summaries (run_scenario.h).
constexpr const char* kSeriesFigures[] = {"approach.min_gap_mm"};
constexpr const char* kTexts[] = {"verdict",
                                  "grade",
                                  "registration.refused",
                                  "collision.closest",
                                  "engine.name",
                                  "engine.version",
                                  "provenance.as_built",
                                  "provenance.machine_sha256",
                                  "provenance.program_sha256",
                                  "provenance.inputs_sha256",
                                  "provenance.fixture_sha256"};

/// How many there are of each kind, and the first line that one of the kind names.
void count_findings(const rehearsal::Record& record, const std::set<std::string>& sections,
                    Metrics& metrics) {
  std::map<std::string, double> figures{{"findings.error.count", 0}, {"findings.warning.count", 0}};
  for (const Kind& kind : kKinds)
    if (*kind.section == 0 || sections.contains(kind.section))
      figures[std::string("findings.") + kind.word + ".count"] = 0;
  for (const rehearsal::Finding& finding : record.findings) {
    const bool error = finding.severity == rehearsal::Severity::error;
    ++figures["findings." + finding.kind + ".count"];
    ++figures[error ? "findings.error.count" : "findings.warning.count"];
  }
  for (const rehearsal::Finding& finding : record.findings) {
    if (finding.gcode_line == 0) continue;
    const auto [first, is_new] =
        figures.try_emplace("findings." + finding.kind + ".line", finding.gcode_line);
    if (!is_new) first->second = std::min(first->second, static_cast<double>(finding.gcode_line));
  }
  metrics["findings.count"] = static_cast<double>(record.findings.size());
  for (const auto& [name, figure] : figures) metrics[name] = figure;
}

}  // namespace

Metrics metrics_of(const rehearsal::Record& record) {
  Metrics metrics;
  metrics["verdict"] = record.go ? "go" : "no-go";
  metrics["grade"] = word(rehearsal::grade_of(record));
  metrics["exit_status"] = record.go ? 0.0 : 1.0;
  std::set<std::string> sections;
  std::vector<rehearsal::Figure> figures = rehearsal::figures(record);
  for (const rehearsal::Figure& figure : rehearsal::timing_figures(record)) figures.push_back(figure);
  for (const rehearsal::Figure& figure : figures) {
    sections.insert(figure.section);
    const std::string name = figure.section + "." + figure.name;
    if (const auto* number = std::get_if<double>(&figure.value))
      metrics[name] = stable_number(*number, name.c_str());
    if (const auto* count = std::get_if<std::uint64_t>(&figure.value))
      metrics[name] = static_cast<double>(*count);
    if (const auto* text = std::get_if<std::string>(&figure.value)) metrics[name] = *text;
  }
  count_findings(record, sections, metrics);
  return metrics;
}

Metrics failed_run(int exit_status) { return {{"exit_status", static_cast<double>(exit_status)}}; }

const std::vector<std::string>& metric_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"exit_status", "findings.count", "findings.error.count",
                                 "findings.warning.count"};
    for (const Kind& kind : kKinds)
      for (const char* figure : {".count", ".line"})
        all.push_back(std::string("findings.") + kind.word + figure);
    all.insert(all.end(), std::begin(kFigures), std::end(kFigures));
    all.insert(all.end(), std::begin(kSeriesFigures), std::end(kSeriesFigures));
    all.insert(all.end(), std::begin(kTexts), std::end(kTexts));
    return all;
  }();
  return names;
}

bool metric_is_text(const std::string& metric) {
  return std::find(std::begin(kTexts), std::end(kTexts), metric) != std::end(kTexts);
}

bool metric_is_of_series(const std::string& metric) {
  return std::find(std::begin(kSeriesFigures), std::end(kSeriesFigures), metric) != std::end(kSeriesFigures);
}

std::string metric_unit(const std::string& metric) {
  if (metric_is_text(metric)) return "";
  for (const std::string_view unit : {"mm", "um", "mrad", "deg", "mm3", "s"})
    if (metric.ends_with("_" + std::string(unit))) return std::string(unit);
  return "1";
}

bool metric_is_of_the_run(const std::string& metric) {
  return metric.starts_with("timing.") || metric == "engine.version" ||
         (metric.starts_with("provenance.") && metric != "provenance.as_built");
}

std::string text_with_unit(double value, const std::string& unit) {
  return fmt::format("{:.6g}", value) + (unit == "1" || unit.empty() ? "" : " " + unit);
}

std::string text_of(const std::optional<MetricValue>& value, const std::string& unit) {
  if (!value) return "absent";
  if (const auto* word = std::get_if<std::string>(&*value)) return *word;
  return text_with_unit(std::get<double>(*value), unit);
}

}  // namespace understudy::regression
