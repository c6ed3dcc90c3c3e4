#include "cli/twin/command_figures.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/command.h"
#include "cli/twin/own_process.h"
#include "cli/twin/planned_program.h"
#include "core/error.h"
#include "core/file/read_file.h"
#include "report/json_figures.h"

namespace understudy::cli {
namespace fs = std::filesystem;
namespace {

/// They write JSON below --out, and neither run another program nor send anything to a machine.
constexpr std::array<std::string_view, 4> kStudies{"workspace", "benchmark", "sweep", "repeatability"};
constexpr std::array<std::string_view, 2> kRefused{"--plugin", "--out"};

}  // namespace

regression::Metrics command_figures(const regression::Scenario& scenario, const fs::path& folder) {
  const auto fail = [&](const std::string& why) {
    throw InputError(Place{scenario.file.string()}, "command: " + why);
  };
  std::vector<std::string> words;
  for (const std::string& word : split_command_line(scenario.command)) {
    for (const std::string_view refused : kRefused)
      if (word.starts_with(refused)) fail(fmt::format("'{}' is not for scenarios: leave it out", word));
    words.push_back(file_beside(scenario, word));
  }
  if (words.empty() || std::ranges::find(kStudies, words.front()) == kStudies.end())
    fail(fmt::format("'{}' is none of the studies {}", words.empty() ? "" : words.front(),
                     fmt::join(kStudies, ", ")));
  words.insert(words.end(), {"--out", folder.string()});
  const ProcessEnd end = run_own_process(words);
  if (end.status == kBadInput) fail(end.text);
  if (end.status > kNo) throw MachineError(fmt::format("{}: command: {}", scenario.file.string(), end.text));
  regression::Metrics metrics{{"exit_status", static_cast<double>(end.status)}};
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".json")
      for (const auto& [name, value] : report::json_figures(read_file(entry.path()), entry.path().string()))
        metrics[entry.path().stem().string() + "." + name] = value;
  return metrics;
}

}  // namespace understudy::cli
