#include "report/study/calibration_benchmark_report.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calibration/plugin/child_process.h"
#include "core/text/stable_number.h"
#include "core/units.h"
#include "core/version.h"
#include "report/json_text.h"

namespace understudy::report {
namespace {

using namespace studies;
using Json = nlohmann::ordered_json;

/// null where there is none.
Json number(double value, const char* what) {
  return std::isfinite(value) ? Json(stable_number(value, what)) : Json();
}
Json micrometres(double metres, const char* what) { return number(to_um(metres), what); }

Json stated_value(const StatedScore& score) {
  Json value;
  value["median_um"] = micrometres(score.median, "median");
  value["worst_um"] = micrometres(score.worst, "worst");
  value["worst_machine_median_um"] = micrometres(score.median_worst, "worst machine's median");
  value["error_over_stated"] = number(score.ratio, "error over stated");
  value["chi_square"] = number(score.chi_square, "chi-square");
  value["coverage_95"] = number(score.coverage, "coverage");
  return value;
}

Json score_value(const CalibrationBenchmark& benchmark, std::size_t entrant, const EntrantScore& score) {
  Json value;
  value["entrant"] = benchmark.entrants[entrant].name;
  value["runs"] = score.runs;
  value["failures"] = score.failures;
  if (score.failures > 0) value["reasons"] = score.reasons;
  value["median_um"] = micrometres(score.median, "median");
  value["p95_um"] = micrometres(score.p95, "p95");
  value["rms_um"] = micrometres(score.rms, "rms");
  value["efficiency"] = number(score.efficiency, "efficiency");
  value["relative"] = number(score.relative, "relative");
  if (benchmark.request.engine.empty()) return value;
  value["in_frame"] = stated_value(score.in_frame);
  value["registered"] = stated_value(score.registered);
  if (score.misfit > 0) value["residuals_over_noise"] = number(score.misfit, "residuals over noise");
  return value;
}

Json condition_key(const CalibrationBenchmark& benchmark, const Condition& condition) {
  Json value;
  value["poses"] = condition.poses;
  value["disturbance"] = to_string(condition.disturbance);
  if (benchmark.request.from == MeasuredFrom::pixels) return value;
  value["noise_um"] = micrometres(condition.noise.position, "noise");
  value["noise_mrad"] = number(1e3 * condition.noise.rotation, "noise");
  return value;
}

Json condition_value(const CalibrationBenchmark& benchmark, const ConditionScore& scored) {
  Json value = condition_key(benchmark, scored.condition);
  value["uncalibrated_um"] = micrometres(scored.uncalibrated, "uncalibrated");
  if (scored.bound > 0) value["bound_um"] = micrometres(scored.bound, "bound");
  if (benchmark.request.from == MeasuredFrom::pixels) {
    value["lost_poses"] = scored.lost_poses;
    value["beyond_layers_mm"] = number(to_mm(scored.beyond), "beyond");
  }
  value["results"] = Json::array();
  for (std::size_t e = 0; e < scored.scores.size(); ++e)
    value["results"].push_back(score_value(benchmark, e, scored.scores[e]));
  value["best"] = benchmark.entrants[scored.best].name;
  value["machine_medians_um"] = Json::array();
  for (const double m : scored.machine_medians)
    value["machine_medians_um"].push_back(micrometres(m, "machine median"));
  return value;
}

Json timing_value(const CalibrationBenchmark& benchmark) {
  Json list = Json::array();
  for (const ConditionScore& scored : benchmark.conditions) {
    Json value = condition_key(benchmark, scored.condition);
    for (std::size_t e = 0; e < scored.scores.size(); ++e)
      value["median_ms"][benchmark.entrants[e].name] = number(1e3 * scored.scores[e].seconds, "time");
    list.push_back(value);
  }
  return list;
}

Json stand_value(const StandOptions& stand) {
  Json value;
  value["method"] = vision::to_string(stand.method);
  value["boards_offset_mm"] = stable_number(to_mm(stand.boards.offset), "boards");
  value["boards_rotation_mrad"] = stable_number(1e3 * stand.boards.rotation, "boards");
  value["boards_print_permille"] = stable_number(1e3 * stand.boards.print_scale, "boards");
  value["boards_flatness_um"] = stable_number(to_um(stand.boards.flatness), "boards");
  return value;
}

/// "33.8 (80.1)" or what happened instead.
std::string cell_text(const EntrantScore& score) {
  if (score.failures == score.runs) return "failed";
  std::string text = fmt::format("{:.1f} ({:.1f})", to_um(score.median), to_um(score.p95));
  if (score.failures > 0) text += fmt::format(" {}!", score.failures);
  return text;
}

std::string stated_row(const std::string& name, const StatedScore& score) {
  const auto cell = [](double value, const char* form) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(form), value) : std::string("-");
  };
  return fmt::format("  {:<28} {:>8} {:>8} {:>14} {:>14} {:>11} {:>9}\n", name,
                     cell(to_um(score.median), "{:.1f}"), cell(to_um(score.worst), "{:.1f}"),
                     cell(to_um(score.median_worst), "{:.1f}"), cell(score.ratio, "{:.2f}"),
                     cell(score.chi_square, "{:.2f}"), cell(1e2 * score.coverage, "{:.1f} %"));
}

/// On the plant: errors in frame W as the boards have it, and where the work is registered on the machine.
std::string stated_tables(const CalibrationBenchmark& benchmark) {
  std::string text;
  for (const ConditionScore& c : benchmark.conditions)
    for (const auto& [name, which] : {std::pair{"in W as the boards have it", &EntrantScore::in_frame},
                                      std::pair{"registered at 20 other poses", &EntrantScore::registered}}) {
      text += fmt::format("\n{}, {} [um]\n  {:<28} {:>8} {:>8} {:>14} {:>14} {:>11} {:>9}\n",
                          to_string(c.condition, benchmark.request.from), name, "", "median", "worst",
                          "worst machine", "error/stated", "chi-square", "in 95 %");
      for (std::size_t e = 0; e < c.scores.size(); ++e)
        text += stated_row(calibration::brief(benchmark.entrants[e].name, 25), c.scores[e].*which);
    }
  for (const ConditionScore& c : benchmark.conditions)
    for (std::size_t e = 0; e < c.scores.size(); ++e)
      if (c.scores[e].misfit > 0)
        text += fmt::format("{}, {}: residuals are {:.2f} of their stated noise\n",
                            to_string(c.condition, benchmark.request.from), benchmark.entrants[e].name,
                            c.scores[e].misfit);
  return text;
}

}  // namespace

std::string benchmark_json(const CalibrationBenchmark& benchmark) {
  const CalibrationBenchmarkRequest& request = benchmark.request;
  Json json;
  json["schema"] = "understudy.calibration-benchmark/1";
  json["machine"] = benchmark.machine_name;
  json["from"] = request.from == MeasuredFrom::pixels ? "pixels" : "poses";
  if (request.from == MeasuredFrom::pixels) json["cameras"] = stand_value(request.stand);
  if (!request.engine.empty()) json["engine"] = request.engine;
  json["trials"] = request.trials;
  json["seed"] = request.seed;
  json["pose_choice"] = request.choice == PoseChoice::random ? "random" : "d_optimal";
  json["entrants"] = Json::array();
  for (const Method& entrant : benchmark.entrants)
    json["entrants"].push_back({{"name", entrant.name}, {"kind", entrant.plugin ? "plugin" : "builtin"}});
  json["ranking"] = Json::array();
  for (const Standing& standing : benchmark.ranking)
    json["ranking"].push_back({{"entrant", benchmark.entrants[standing.entrant].name},
                               {"score", number(standing.score, "score")},
                               {"runs", standing.runs},
                               {"failures", standing.failures}});
  json["conditions"] = Json::array();
  for (const ConditionScore& scored : benchmark.conditions)
    json["conditions"].push_back(condition_value(benchmark, scored));
  json["timing"] = timing_value(benchmark);
  json["provenance"]["version"] = kVersion;
  json["provenance"]["machine_sha256"] = benchmark.machine_sha256;
  json["provenance"]["command"] = request.command;
  return to_text(json, 2) + "\n";
}

std::string benchmark_table(const CalibrationBenchmark& benchmark) {
  std::string text =
      fmt::format("{}, {} built machines, tip error at poses held out [um]: median (p95), N! failed\n",
                  benchmark.machine_name, benchmark.request.trials);
  std::size_t width = 9;
  for (const ConditionScore& c : benchmark.conditions)
    width = std::max(width, to_string(c.condition, benchmark.request.from).size());
  std::vector<std::size_t> columns;
  text += fmt::format("{:<{}} {:>8} {:>7}", "condition", width, "as built", "bound");
  for (const Method& entrant : benchmark.entrants) {
    columns.push_back(std::max<std::size_t>(17, std::min<std::size_t>(entrant.name.size(), 28)));
    text += fmt::format("  {:>{}}", calibration::brief(entrant.name, 25), columns.back());
  }
  text += "\n";
  for (const ConditionScore& c : benchmark.conditions) {
    text += fmt::format("{:<{}} {:>8.0f} {:>7}", to_string(c.condition, benchmark.request.from), width,
                        to_um(c.uncalibrated), c.bound > 0 ? fmt::format("{:.1f}", to_um(c.bound)) : "");
    for (std::size_t e = 0; e < c.scores.size(); ++e)
      text += fmt::format("  {:>{}}", cell_text(c.scores[e]), columns[e]);
    text += "\n";
  }
  if (!benchmark.request.engine.empty()) text += stated_tables(benchmark);
  text +=
      "\nranking: median tip error over the best one's, geometric mean over conditions; a failure counts as "
      "no calibration\n";
  for (const Standing& s : benchmark.ranking)
    text += fmt::format("{:8.3f}  {} ({} of {} failed)\n", s.score, benchmark.entrants[s.entrant].name,
                        s.failures, s.runs);
  for (std::size_t e = 0; e < benchmark.entrants.size(); ++e) {
    std::map<std::string, int> reasons;
    for (const ConditionScore& c : benchmark.conditions)
      for (const auto& [reason, count] : c.scores[e].reasons) reasons[reason] += count;
    for (const auto& [reason, count] : reasons)
      text += fmt::format("{}: {} x {}\n", benchmark.entrants[e].name, count, reason);
  }
  return text;
}

}  // namespace understudy::report
