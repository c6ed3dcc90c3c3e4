#include "regression/metrics.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include <nlohmann/json.hpp>

namespace understudy::rehearsal {
namespace {

using Json = nlohmann::json;

// A kind of finding and the section of the summary that shows it was looked for; none: checked before any
// motion.
struct Kind {
  const char* word;
  const char* section;
};
constexpr Kind kKinds[] = {{"strut_length", ""},  {"joint_angle", ""},        {"joint_limit", ""},
                           {"axis_velocity", ""}, {"axis_acceleration", ""},  {"singularity", ""},
                           {"unreachable", ""},   {"collision", "collision"}, {"near_collision", "collision"},
                           {"gap", "gap"},        {"adhesion", "gap"},        {"sag", "sag"},
                           {"flow", "print"}};

// Figures of the contract, by section.
constexpr const char* kFigures[] = {"print.duration_s",
                                    "print.moves",
                                    "print.extruded_mm",
                                    "print.deposited_mm",
                                    "print.travel_mm",
                                    "accuracy.tip_rms_um",
                                    "accuracy.tip_p95_um",
                                    "accuracy.tip_max_um",
                                    "accuracy.orientation_max_mrad",
                                    "accuracy.open_loop_tip_max_um",
                                    "gap.commanded_mm",
                                    "gap.open_loop_start_mm",
                                    "gap.start_mm",
                                    "gap.path_min_mm",
                                    "gap.path_mean_mm",
                                    "gap.path_max_mm",
                                    "gap.in_band_fraction",
                                    "gap.frames",
                                    "sag.max_um",
                                    "sag.strands",
                                    "sag.unsupported_mm",
                                    "collision.min_clearance_mm",
                                    "collision.checks",
                                    "collision.pairs",
                                    "surface.ra_um",
                                    "surface.rz_um",
                                    "surface.deviation_p95_um",
                                    "engine.timestep_s",
                                    "engine.steps",
                                    "engine.real_time_factor",
                                    "engine.closure_max_um"};
// What a series of machines knows besides the summaries (run_scenario.h).
constexpr const char* kSeriesFigures[] = {"approach.min_gap_mm"};
constexpr const char* kTexts[] = {"verdict",
                                  "engine.name",
                                  "engine.version",
                                  "provenance.as_built",
                                  "provenance.machine_sha256",
                                  "provenance.program_sha256"};

void count_findings(const Json& summary, Metrics& metrics) {
  std::map<std::string, double> counts{{"findings.error.count", 0}, {"findings.warning.count", 0}};
  for (const Kind& kind : kKinds)
    if (*kind.section == 0 || summary.contains(kind.section))
      counts[std::string("findings.") + kind.word + ".count"] = 0;
  for (const Json& finding : summary.at("findings")) {
    ++counts["findings." + finding.at("kind").get<std::string>() + ".count"];
    ++counts["findings." + finding.at("severity").get<std::string>() + ".count"];
  }
  metrics["findings.count"] = static_cast<double>(summary.at("findings").size());
  for (const auto& [name, count] : counts) metrics[name] = count;
}

void flatten_section(const std::string& section, const Json& values, Metrics& metrics) {
  for (const auto& [key, value] : values.items()) {
    if (value.is_number()) metrics[section + "." + key] = value.get<double>();
    if (value.is_string()) metrics[section + "." + key] = value.get<std::string>();
  }
}

}  // namespace

Metrics flatten(const std::string& summary_json) {
  try {
    const Json summary = Json::parse(summary_json);
    Metrics metrics;
    const auto verdict = summary.at("verdict").get<std::string>();
    metrics["verdict"] = verdict;
    metrics["exit_status"] = verdict == "go" ? 0.0 : 1.0;
    count_findings(summary, metrics);
    for (const auto& [section, values] : summary.items())
      if (values.is_object()) flatten_section(section, values, metrics);
    return metrics;
  } catch (const Json::exception& error) {
    throw std::logic_error(std::string("this is not a summary of a rehearsal: ") + error.what());
  }
}

Metrics failed_run(int exit_status) { return {{"exit_status", static_cast<double>(exit_status)}}; }

const std::vector<std::string>& metric_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all{"exit_status", "findings.count", "findings.error.count",
                                 "findings.warning.count"};
    for (const Kind& kind : kKinds) all.push_back(std::string("findings.") + kind.word + ".count");
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
  for (const std::string_view unit : {"mm", "um", "mrad", "s"})
    if (metric.ends_with("_" + std::string(unit))) return std::string(unit);
  return "1";
}

}  // namespace understudy::rehearsal
