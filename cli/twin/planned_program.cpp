#include "cli/twin/planned_program.h"

#include <algorithm>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/command.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "core/version.h"
#include "machine/description.h"
#include "regression/scenario_file.h"
#include "regression/scenario_outcome.h"

namespace understudy::cli {
namespace {
namespace fs = std::filesystem;

/// The program's first line repeats the plan, wherever the scenario is run.
class AsCommandLine {
 public:
  explicit AsCommandLine(const std::vector<std::string>& words) : before_(command_line()) {
    remember_command_line(words);
  }
  ~AsCommandLine() { restore_command_line(before_); }
  AsCommandLine(const AsCommandLine&) = delete;
  AsCommandLine& operator=(const AsCommandLine&) = delete;

 private:
  std::string before_;
};

int run_plan(std::vector<std::string> words) {
  CLI::App app;
  Action action;
  add_plan(app, action);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  app.parse(words);
  check_numbers(app);
  return action();
}

/// Of a file beside the scenario, of a part of that name, or nothing.
std::string digest_of_word(const regression::Scenario& scenario, const std::string& word) {
  std::error_code ignored;
  const std::string file = file_beside(scenario, word);
  const fs::path part = machine::models_folder() / "parts" / (word + ".stl");
  if (file == word && !fs::is_regular_file(part, ignored)) return {};
  std::string text = sha256_hex(read_file(file != word ? fs::path(file) : part)) + "\n";
  // A study of a scenario depends on that one's program and fixture as well.
  if (!scenario.command.empty() && file.ends_with(".yaml") && file != word) {
    const regression::Scenario named = regression::load_scenario(file);
    if (named.command.empty()) text += regression::outcome_inputs(named, sources_sha256(named)) + "\n";
  }
  return text;
}

/// Machines and materials: which of them a study takes, its defaults say.
std::string digest_of_models() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(machine::models_folder()))
    if (entry.is_regular_file() && entry.path().extension() != ".stl") files.push_back(entry.path());
  std::ranges::sort(files);
  std::string text;
  for (const fs::path& file : files) text += sha256_hex(read_file(file)) + "\n";
  return text;
}

}  // namespace

std::string file_beside(const regression::Scenario& scenario, const std::string& word) {
  const fs::path path = scenario.file.parent_path() / word;
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? path.string() : word;
}

std::vector<std::string> planner_options(const std::string& planner) {
  CLI::App app;
  Action action;
  add_plan(app, action);
  std::vector<std::string> planners, options;
  for (const CLI::App* each : app.get_subcommand("plan")->get_subcommands({})) {
    planners.push_back(each->get_name());
    if (each->get_name() != planner) continue;
    for (const CLI::Option* option : each->get_options())
      for (const std::string& name : option->get_lnames()) options.push_back(name);
    std::sort(options.begin(), options.end());
    return options;
  }
  const std::string near = nearest_word(planner, planners);
  throw InputError(fmt::format("plan: '{}' is no planner{}", planner,
                               near.empty() ? "" : fmt::format(", did you mean '{}'?", near)));
}

void write_planned(const regression::Scenario& scenario, const fs::path& output) {
  const auto fail = [&](const std::string& why) {
    throw InputError(fmt::format("{}: plan: {}", scenario.file.string(), why));
  };
  std::vector<std::string> words{"plan"}, shown = words;
  for (const std::string& word : split_command_line(scenario.plan)) {
    if (word.starts_with("-o") || word.starts_with("--output") || word.starts_with("--machine"))
      fail(fmt::format("'{}' is the scenario's to say: leave it out", word));
    if (word.starts_with("--stock"))
      fail(fmt::format("'{}' writes a file: the plan of a scenario writes its program alone, leave it out",
                       word));
    shown.push_back(word);
    words.push_back(file_beside(scenario, word));
  }
  for (auto* each : {&words, &shown})
    each->insert(each->end(), {"--quiet", "--machine", scenario.machine, "-o"});
  words.push_back(output.string());
  shown.push_back(output.filename().string());
  const AsCommandLine as(shown);
  try {
    if (run_plan(words) != kGood) fail("no program came of it");
  } catch (const CLI::ParseError& error) {
    fail(error.what());
  } catch (const InputError& error) {
    fail(error.what());
  }
}

std::string sources_sha256(const regression::Scenario& scenario) {
  const bool command = !scenario.command.empty();
  if (scenario.plan.empty() && !command) return {};
  std::string text = fmt::format("{}\n{}\n", kVersion, command ? scenario.command : scenario.plan);
  try {
    for (const std::string& word : split_command_line(command ? scenario.command : scenario.plan))
      text += digest_of_word(scenario, word);
    if (command) text += digest_of_models();
  } catch (const InputError&) {
    return {};
  }
  return sha256_hex(text);
}

}  // namespace understudy::cli
