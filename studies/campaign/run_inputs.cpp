#include "studies/campaign/run_inputs.h"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/digest.h"
#include "core/file/file_cache.h"
#include "core/file/is_file.h"
#include "core/file/read_file.h"
#include "core/version.h"
#include "core/yaml/changed_file.h"
#include "machine/description.h"
#include "machine/material.h"
#include "regression/run_scenario.h"
#include "regression/scenario_file.h"
#include "rehearsal/rehearse.h"
#include "rehearsal/request/input_digest.h"
#include "sim/as_built/as_built.h"

namespace understudy::studies {
namespace fs = std::filesystem;
namespace {

const std::vector<std::string> kTargets{"machine", "material", "as_built", "scenario", "plan"};

/// "machine" and "gap.aim_mm" of "machine.gap.aim_mm".
std::pair<std::string, std::string> target_of(const CampaignParameter& parameter) {
  const std::size_t dot = parameter.key.find('.');
  const std::string target = parameter.key.substr(0, dot);
  if (std::find(kTargets.begin(), kTargets.end(), target) == kTargets.end()) {
    const std::string near = nearest_word(target, kTargets);
    throw InputError(
        parameter.place,
        fmt::format("key '{}' begins with none of {}{}", parameter.key, fmt::join(kTargets, ", "),
                    near.empty() ? fmt::format("; did you mean 'machine.{}'?", parameter.key)
                                 : fmt::format("; did you mean '{}'?", near)));
  }
  if (dot == std::string::npos || dot + 1 == parameter.key.size())
    throw InputError(parameter.place,
                     fmt::format("key '{}' says of what, but not which value", parameter.key));
  return {target, parameter.key.substr(dot + 1)};
}

/// The words of a plan with `--option value` in place of what they say of it.
std::string with_option(const std::string& plan, const std::string& option, const std::string& value) {
  std::istringstream in(plan);
  std::vector<std::string> words;
  bool found = false;
  for (std::string word; in >> word;) {
    if (word.starts_with("--" + option + "=")) {
      words.push_back("--" + option + "=" + value);
      found = true;
    } else if (word == "--" + option) {
      words.push_back(word);
      in >> word;
      words.push_back(value);
      found = true;
    } else {
      words.push_back(word);
    }
  }
  if (!found) words.insert(words.end(), {"--" + option, value});
  return fmt::format("{}", fmt::join(words, " "));
}

std::string first_word(const std::string& text) { return text.substr(0, text.find(' ')); }

/// "FILE.yaml: unknown key ..." of a word's file, as its parameter's place tells it better.
[[noreturn]] void at_parameter(const CampaignParameter& parameter, const std::string& value,
                               const InputError& error) {
  throw InputError(parameter.place, fmt::format("{}: {}: {}", parameter.key, value, error.what()));
}

}  // namespace

RunInputs::RunInputs(const Campaign& campaign, CampaignTools tools)
    : campaign_(campaign), tools_(std::move(tools)) {
  for (const std::string& word : campaign.scenarios) {
    regression::Scenario scenario = regression::load_scenario(word);
    if (!scenario.command.empty())
      throw InputError(Place{campaign.file.string(), 0, 0},
                       fmt::format("scenario {} has a command, which is not rehearsed", word));
    if (std::find(names_.begin(), names_.end(), scenario.name) != names_.end())
      throw InputError(Place{campaign.file.string(), 0, 0},
                       fmt::format("two scenarios are named '{}': rename one", scenario.name));
    names_.push_back(std::move(scenario.name));
  }
  open_loop_ = std::any_of(campaign.metrics.begin(), campaign.metrics.end(), [](const std::string& metric) {
    return metric.find("open_loop") != std::string::npos;
  });
}

/// Values of the scenario's own file come first: they may name machine and material.
regression::Scenario RunInputs::scenario_of(const CampaignRun& run) const {
  std::string word = campaign_.scenarios[run.scenario];
  for (std::size_t p = 0; p < run.values.size(); ++p)
    if (const auto [target, key] = target_of(campaign_.parameters[p]); target == "scenario")
      word = with_change(word, key, run.values[p]);
  regression::Scenario scenario = regression::load_scenario(word);
  for (std::size_t p = 0; p < run.values.size(); ++p)
    change(campaign_.parameters[p], run.values[p], scenario);
  return scenario;
}

void RunInputs::change(const CampaignParameter& parameter, const std::string& value,
                       regression::Scenario& scenario) const {
  const auto [target, key] = target_of(parameter);
  const auto refuse = [&](const std::string& why) {
    throw InputError(parameter.place, fmt::format("{}: scenario '{}' {}", parameter.key, scenario.name, why));
  };
  if (target == "machine") scenario.machine = with_change(scenario.machine, key, value);
  if (target == "material") {
    if (scenario.material.empty())
      scenario.material = machine::load_machine(scenario.machine).process.material;
    if (scenario.material.empty()) refuse("has no material: its machine prints nothing");
    scenario.material = with_change(scenario.material, key, value);
  }
  if (target == "as_built") {
    if (!is_file(changed_file(scenario.as_built).file))
      refuse(fmt::format("is as-built '{}', which is no file whose values could vary", scenario.as_built));
    scenario.as_built = with_change(scenario.as_built, key, value);
  }
  if (target != "plan") return;
  if (scenario.plan.empty()) refuse("has no plan: its program is a file");
  const std::string planner = first_word(scenario.plan);
  const std::vector<std::string> options = tools_.planner_options(planner);
  if (std::find(options.begin(), options.end(), key) == options.end()) {
    const std::string near = nearest_word(key, options);
    refuse(fmt::format("is planned by '{}', which has no option --{}{}", planner, key,
                       near.empty() ? fmt::format("; it has {}", fmt::join(options, ", "))
                                    : fmt::format(", did you mean 'plan.{}'?", near)));
  }
  scenario.plan = with_option(scenario.plan, key, value);
}

fs::path RunInputs::planned(const regression::Scenario& scenario) {
  const std::string made_from = scenario.machine + "\n" + tools_.plan_sha256(scenario);
  const auto known = planned_.find(made_from);
  if (known != planned_.end()) return known->second;
  // The same name in every process: it is told in records.
  if (!scratch_) scratch_.emplace("campaign");
  const fs::path made = scratch_->path() / std::to_string(planned_.size()) / regression::kPlannedProgram;
  fs::create_directories(made.parent_path());
  tools_.plan(scenario, made);
  return planned_[made_from] = made;
}

rehearsal::RehearsalRequest RunInputs::request(const CampaignRun& run) {
  regression::Scenario scenario = scenario_of(run);
  if (!scenario.plan.empty()) scenario.program = planned(scenario);
  rehearsal::RehearsalRequest request = regression::request_of(scenario);
  request.seed = run.seed;
  request.compare_without_gap_control = open_loop_;
  request.command =
      fmt::format("understudy campaign {} --only {}", campaign_.file.filename().string(), run.index);
  return request;
}

std::string RunInputs::command(std::uint64_t index) const {
  return fmt::format("understudy campaign {} --only {} --out run-{}", campaign_.file.string(), index, index);
}

/// All that the request reads of the parameter's file, short of a rehearsal.
void RunInputs::check_point(const CampaignRun& run, const CampaignParameter& parameter) {
  const std::string value =
      run.values.empty() ? ""
                         : run.values[static_cast<std::size_t>(&parameter - campaign_.parameters.data())];
  try {
    const regression::Scenario scenario = scenario_of(run);
    const machine::MachineDescription machine = machine::load_machine(scenario.machine);
    if (!scenario.material.empty()) machine::load_material(scenario.material);
    if (is_file(changed_file(scenario.as_built).file))
      sim::make_as_built(machine, scenario.as_built, sim::TruthSeeds(run.seed));
    if (target_of(parameter).first == "plan") planned(scenario);
  } catch (const InputError& error) {
    if (error.place().file == parameter.place.file) throw;
    at_parameter(parameter, value, error);
  }
}

void RunInputs::check() {
  const RunPlan plan(campaign_);
  for (std::size_t s = 0; s < campaign_.scenarios.size(); ++s)
    for (std::size_t p = 0; p < campaign_.parameters.size(); ++p)
      for (const bool last : {false, true}) {
        CampaignRun run;
        run.scenario = s;
        run.seed = campaign_.seed_first;
        for (std::size_t other = 0; other < campaign_.parameters.size(); ++other) {
          const CampaignParameter& parameter = campaign_.parameters[other];
          const bool at_end = last && other == p;
          if (parameter.values.empty())
            run.values.push_back(value_text(at_end ? parameter.to : parameter.from));
          else
            run.values.push_back(at_end ? parameter.values.back() : parameter.values.front());
        }
        check_point(run, campaign_.parameters[p]);
      }
}

std::string RunInputs::inputs_sha256() {
  std::string text = fmt::format("{}\n{}\n{} {} {}\n", kVersion, sha256_hex(read_file(campaign_.file)),
                                 campaign_.seed_first, campaign_.seed_last, to_string(campaign_.plan));
  for (const std::string& word : campaign_.scenarios) {
    const regression::Scenario scenario = regression::load_scenario(word);
    text += cached_sha256(scenario.file) + "\n";
    rehearsal::RehearsalRequest request = regression::request_of(scenario);
    text +=
        rehearsal::inputs_sha256(request, scenario.plan.empty() ? "" : tools_.plan_sha256(scenario)) + "\n";
  }
  return sha256_hex(text);
}

RunRow RunInputs::rehearse(const CampaignRun& run) {
  const auto begin = std::chrono::steady_clock::now();
  RunRow row;
  row.index = run.index;
  row.seed = run.seed;
  row.scenario = names_[run.scenario];
  row.values = run.values;
  row.command = command(run.index);
  const auto no_answer = [&row](RunEnd end, const std::exception& error) {
    row.end = end;
    row.error = error.what();
  };
  try {
    rehearsal::RehearsalRequest asked = request(run);
    asked.keep_scene = false;  // of pictures: no part of the summary
    const rehearsal::Record record = rehearsal::rehearse(asked);
    row.end = record.go ? RunEnd::go : RunEnd::no_go;
    const regression::Metrics metrics = regression::metrics_of(record);
    for (const std::string& name : row_metrics())
      if (const auto found = metrics.find(name); found != metrics.end()) row.metrics.insert(*found);
    row.summary_sha256 = sha256_hex(tools_.summary_json(record));
  } catch (const InputError& error) {
    no_answer(RunEnd::refused, error);
  } catch (const MachineError& error) {
    no_answer(RunEnd::failed, error);
  }
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return row;
}

}  // namespace understudy::studies
