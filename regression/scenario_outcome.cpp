#include "regression/scenario_outcome.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/text/printable.h"
#include "core/yaml/yaml_map.h"
#include "core/yaml/yaml_quoted.h"
#include "regression/run_scenario.h"
#include "rehearsal/request/input_digest.h"

namespace understudy::regression {
namespace fs = std::filesystem;
namespace {

constexpr int kVersion = 1;

std::set<std::string> asked_of_machines(const Scenario& scenario) {
  std::set<std::string> asked;
  if (scenario.machines)
    for (const Expectation& e : scenario.machines->expect) asked.insert(e.metric);
  return asked;
}

std::string entry_text(const MetricValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format(", number: {}", *number);
  const std::string& word = std::get<std::string>(value);
  return word.empty() ? "" : ", text: " + yaml_quoted(word);
}

std::string figures_text(const Metrics& metrics, const char* indent) {
  std::string text;
  for (const auto& [name, value] : metrics)
    text += fmt::format("{}- {{metric: {}{}}}\n", indent, yaml_quoted(name), entry_text(value));
  return text;
}

Metrics read_figures(YamlMap& map) {
  Metrics metrics;
  map.list("figures", 0, "of one run", [&](YamlMap& entry, std::size_t) {
    const std::string name = entry.text("metric", "dotted name");
    if (entry.has("number"))
      metrics[name] = entry.number("number", {}, "the value in the metric's unit");
    else
      metrics[name] = entry.has("text") ? entry.text("text", "the word") : "";
  });
  return metrics;
}

void read_outcome(YamlMap& map, RecordedOutcome& read) {
  const int version = map.integer("outcome", 0, 1'000'000, "version of this form: 1");
  if (version != kVersion)
    map.fail("outcome", fmt::format("outcome is version {}, where this program reads {}", version, kVersion));
  if (map.has("inputs_sha256")) read.inputs = map.text("inputs_sha256", "of all inputs");
  ScenarioOutcome& outcome = read.outcome;
  outcome.seconds = map.number("seconds", {0}, "wall time");
  if (map.has("error")) {
    outcome.error = map.text("error", "why there is no result");
    outcome.error_status = map.integer("error_status", 2, 3, "2 bad input, 3 the machine failed");
  }
  map.section("run", "figures of the scenario's own run",
              [&](YamlMap& run) { outcome.run = read_figures(run); });
  if (map.has("machines"))
    map.list("machines", 0, "figures of the series", [&](YamlMap& machine, std::size_t) {
      outcome.machines.push_back(machine.has("figures") ? read_figures(machine) : Metrics{});
    });
}

}  // namespace

ScenarioResult judge(const Scenario& scenario, const ScenarioOutcome& outcome) {
  ScenarioResult result;
  result.name = scenario.name;
  result.file = scenario.file.string();
  result.error = outcome.error;
  result.error_status = outcome.error_status;
  result.seconds = outcome.seconds;
  if (result.error.empty()) result.checks = evaluate(scenario, outcome.run, outcome.machines);
  return result;
}

std::string outcome_inputs(const Scenario& scenario, const std::string& sources_sha256) {
  if (!scenario.command.empty()) return sources_sha256;
  try {
    std::string text = rehearsal::inputs_sha256(request_of(scenario), sources_sha256) + "\n";
    if (scenario.machines)
      text += fmt::format("{}-{}\n", scenario.machines->seed_first, scenario.machines->seed_last);
    for (const std::string& metric : asked_of_machines(scenario)) text += metric + "\n";
    return sha256_hex(text);
  } catch (const InputError&) {
    return {};
  }
}

std::string outcome_text(const Scenario& scenario, const ScenarioOutcome& outcome,
                         const std::string& inputs) {
  std::string text = fmt::format(
      "# What came of {}, for `understudy scenario run --resume` and `--baseline`.\noutcome: {}\nseconds: "
      "{:.3f}\n",
      printable(scenario.file.filename().string()), kVersion, outcome.seconds);
  if (!inputs.empty()) text += fmt::format("inputs_sha256: {}\n", inputs);
  if (!outcome.error.empty())
    text += fmt::format("error: {}\nerror_status: {}\n", yaml_quoted(outcome.error), outcome.error_status);
  text += "run:\n  figures:\n";
  text += figures_text(outcome.run, "    ");
  if (outcome.machines.empty()) return text;
  const std::set<std::string> asked = asked_of_machines(scenario);
  text += "machines:\n";
  for (const Metrics& machine : outcome.machines) {
    Metrics kept = machine;
    std::erase_if(kept, [&](const auto& figure) { return !asked.contains(figure.first); });
    text += kept.empty() ? "  - {}\n" : "  - figures:\n" + figures_text(kept, "      ");
  }
  return text;
}

RecordedOutcome load_outcome(const fs::path& path) {
  RecordedOutcome read;
  YamlMap::read_text(read_file(path), path.string(), [&](YamlMap& map) { read_outcome(map, read); });
  return read;
}

std::vector<MetricChange> changes(const Metrics& before, const Metrics& after) {
  const auto value = [](const Metrics& metrics, const std::string& name) {
    const auto found = metrics.find(name);
    return found == metrics.end() ? std::nullopt : std::optional(found->second);
  };
  Metrics all = before;
  all.insert(after.begin(), after.end());
  std::vector<MetricChange> changed;
  for (const auto& [name, unused] : all) {
    const MetricChange change{name, value(before, name), value(after, name)};
    if (!metric_is_of_the_run(name) && change.before != change.after) changed.push_back(change);
  }
  return changed;
}

std::string text_of(const MetricChange& change) {
  const std::string unit = metric_unit(change.metric);
  return fmt::format("{} was {}, is {}", change.metric, text_of(change.before, unit),
                     text_of(change.after, unit));
}

}  // namespace understudy::regression
